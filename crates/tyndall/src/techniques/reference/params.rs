//! Parameters of `reference`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "reference",
    about: "the oracle: exact visibility and f64 quadrature to a stated tolerance",
    citation: "lit segments: Max, Atmospheric Illumination and Shadows, SIGGRAPH 1986; quadrature: Piessens et al., QUADPACK, 1983",
    lights: &[
        LightKind::Directional,
        LightKind::Point,
        LightKind::Spot,
        LightKind::Rect,
    ],
    lights_on_gpu_only: &[],
    backends: Backends::Cpu,
    reads: Reads {
        glass: true,
        textures: true,
        occluders: false,
        points: false,
    },
    shadows_surfaces: false,
    is_reference: true,
};

/// Parameters of `reference`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Largest relative error of the quadrature of a lit stretch (1e-9 to 0.1).
    pub tolerance: f64,
    /// Source of visibility.
    pub visibility: Visibility,
}

/// Sources of visibility.
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
    const INFO: TechniqueInfo = INFO;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[
        param!(real tolerance, 1e-9..=0.1, "largest relative error of the quadrature of a lit stretch"),
        param!(choice visibility, VISIBILITIES,
            "from the scene's triangles, or from the shadow map texel by texel",
            "\"traced\" or \"shadow-map\""),
    ]];
}
