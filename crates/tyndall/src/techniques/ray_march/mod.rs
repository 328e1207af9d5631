//! `ray-march`: brute force, the baseline of every paper.
//!
//! The ray is cut into N steps; the middle of each is looked up in the shadow map, and the lit ones add
//! `exp(-sigma_t s) sigma_s rho(theta) L_in(s) ds` (Chen 2011, eq. 1, as a Riemann sum).
//!
//! - **equal** steps: the error falls like 1/N, for it sits in the steps that a shadow border cuts through.
//! - **equiangular** (Kulla & Fajardo 2012): steps of equal angle at a local light, `s = t_p + h tan(xi)`, so that
//!   `ds / d^2 = d xi / h` and the peak beside the light is sampled as finely as it is high. For directional light,
//!   which has no peak, it is the same as equal.
//!
//! Steps run over the part of the ray that the light can reach at all: a spot's cone is clipped first.
//!
//! A rectangular light is taken as samples (Halton's points), each with N steps and a map of its own: a hemispherical
//! one that is made of the light's point cloud, see `shadow/imperfect/`. On the GPU only.
//!
//! Cost: N shadow-map texels a ray, fetched in the order of the ray, no memory besides the output. It does every
//! light and medium, pictures and coloured glass (which rectangular lights do not see). Of a rectangular light, N texels a
//! sample and ray: 256 samples of 64 steps are as much work as 16384 steps of a lamp.
//!
//! Where it fails: shadows thinner than a step are hit or missed by chance, which shows as bands. Doubling N halves them.
//! Mesa's lavapipe ends a shader's loops after 65535 turns of all of them together and says nothing: there a local light
//! is too dark with more than some 20,000 steps. Samples of a rectangular light are spread over dispatches before that.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;

use super::{
    Backends, LightKind, Technique, TechniqueInfo,
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "ray-march",
    about: "brute force: N steps a ray, each looked up in the shadow map",
    citation: "equi-angular steps: Kulla & Fajardo, Importance Sampling Techniques for Path Tracing in Participating Media, EGSR 2012",
    lights: &[
        LightKind::Directional,
        LightKind::Point,
        LightKind::Spot,
        LightKind::Rect,
    ],
    backends: Backends::Both,
    default: || Technique::RayMarch(Params::DEFAULT),
};

/// Parameters of `ray-march`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Steps a ray (1 to 65536).
    pub steps: u32,
    /// How they are spaced.
    pub spacing: Spacing,
    /// Of a rectangular light: points of the cloud that each sample's map is made of (1 to 2^20); fewer where the cloud
    /// has fewer.
    pub points: u32,
}

/// How steps are spaced along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Equal lengths.
    Equal,
    /// Equal angles at a local light.
    Equiangular,
}

const SPACINGS: &[(&str, Spacing)] = &[
    ("equal", Spacing::Equal),
    ("equiangular", Spacing::Equiangular),
];

impl Params {
    const DEFAULT: Self = Self {
        steps: 512,
        spacing: Spacing::Equal,
        points: 65_536,
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
        param!(whole steps, 1..=65536, "steps a ray"),
        param!(choice spacing, SPACINGS,
            "equal lengths, or equal angles at a local light",
            "\"equal\" or \"equiangular\""),
        param!(whole points, 1..=1048576,
            "of a rectangular light: points of the scene's surfaces that a sample's map is made of"),
    ]];
}
