//! Parameters of `ray-march`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "ray-march",
    about: "brute force: N steps a ray, each looked up in the shadow map",
    citation: "equi-angular steps: Kulla & Fajardo, Importance Sampling Techniques for Path Tracing in Participating Media, EGSR 2012",
    lights: &[
        LightKind::Directional,
        LightKind::Point,
        LightKind::Spot,
        LightKind::Rect,
    ],
    lights_on_gpu_only: &[LightKind::Rect],
    backends: Backends::Both,
    reads: Reads {
        glass: true,
        textures: true,
        occluders: false,
        points: true,
    },
    shadows_surfaces: false,
    is_reference: false,
};

/// Parameters of `ray-march`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Steps a ray (1 to 65536).
    pub steps: u32,
    /// Their spacing.
    pub spacing: Spacing,
    /// Points of the cloud that the map of each sample of a rectangular light is made of (1 to 2^20); fewer where the
    /// cloud has fewer.
    pub points: u32,
}

/// Spacing of steps along a ray.
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
    const INFO: TechniqueInfo = INFO;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[
        param!(whole steps, 1..=65536, "steps a ray"),
        param!(choice spacing, SPACINGS,
            "equal lengths, or equal angles at a local light",
            "\"equal\" or \"equiangular\""),
        param!(whole points, 1..=1048576,
            "of a rectangular light: points of the scene's surfaces that a sample's map is made of"),
    ]];
}
