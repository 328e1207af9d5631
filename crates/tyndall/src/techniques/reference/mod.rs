//! `reference`: the oracle, in f64 on the CPU.
//!
//! Visibility is not sampled. Either the scene itself says which stretches of the ray each of its triangles shades
//! (`traced`: the plane through the ray and the light, cut with every triangle; Max 1986 finds lit segments so), or the
//! ray is walked texel by texel through the shadow map (`shadow-map`: the limit of marching with ever more steps).
//! Between the ends of these stretches the integrand is smooth, and is integrated there: in closed form for untextured
//! directional light, else by adaptive Gauss-Kronrod quadrature (Piessens et al. 1983, QUADPACK's 7-15 pair), in the
//! angle at the light where there is one, so that the peak beside it is flat.
//!
//! - `tolerance`: largest relative error of a stretch's quadrature.
//!
//! Cost: seconds a picture. Rectangular lights are sums over their samples. Lights are traced whether or not they
//! have a shadow map.

pub(crate) mod cpu;

use super::{
    Backends, LightKind, Technique, TechniqueInfo,
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "reference",
    about: "the oracle: exact visibility and f64 quadrature to a stated tolerance",
    citation: "lit segments: Max, Atmospheric Illumination and Shadows, SIGGRAPH 1986; quadrature: Piessens et al., QUADPACK, 1983",
    lights: &[
        LightKind::Directional,
        LightKind::Point,
        LightKind::Spot,
        LightKind::Rect,
    ],
    backends: Backends::Cpu,
    default: || Technique::Reference(Params::DEFAULT),
};

/// Parameters of `reference`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Largest relative error of the quadrature of a lit stretch (1e-9 to 0.1).
    pub tolerance: f64,
    /// Where visibility comes from.
    pub visibility: Visibility,
}

/// Where the reference takes visibility from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// From the scene's triangles.
    Traced,
    /// From the shadow map, texel by texel.
    ShadowMap,
}

const VISIBILITIES: &[(&str, Visibility)] = &[
    ("traced", Visibility::Traced),
    ("shadow-map", Visibility::ShadowMap),
];

impl Params {
    const DEFAULT: Self = Self {
        tolerance: 1e-3,
        visibility: Visibility::Traced,
    };
}

impl Default for Params {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Parameters for Params {
    const TECHNIQUE: &'static str = INFO.name;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[
        param!(real tolerance, 1e-9..=0.1, "largest relative error of the quadrature of a lit stretch"),
        param!(choice visibility, VISIBILITIES,
            "from the scene's triangles, or from the shadow map texel by texel",
            "\"traced\" or \"shadow-map\""),
    ]];
}
