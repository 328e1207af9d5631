//! Parameters of `hybrid`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "hybrid",
    about: "silhouette shadow volumes bound the shadows: closed forms outside, steps between",
    citation: "Wyman & Ramsey, Interactive Volumetric Shadows in Participating Media with Single-Scattering, IEEE Interactive Ray Tracing 2008",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    lights_on_gpu_only: &[],
    backends: Backends::Gpu,
    reads: Reads {
        glass: true,
        textures: true,
        occluders: true,
        points: false,
    },
    shadows_surfaces: false,
    is_reference: false,
};

/// Parameters of `hybrid`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Steps over a whole ray (1 to 65536).
    pub steps: u32,
    /// The contents of the image.
    pub show: Show,
}

/// The contents of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The in-scattered light.
    Light,
    /// The marched stretch: its start (red), end (green) and length (blue) \[m].
    Bounds,
}

const SHOWS: &[(&str, Show)] = &[("light", Show::Light), ("bounds", Show::Bounds)];

impl Params {
    const DEFAULT: Self = Self {
        steps: 512,
        show: Show::Light,
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
        param!(whole steps, 1..=65536, "steps over a whole ray"),
        param!(choice show, SHOWS,
            "the light, or front and back distances of the shadow volumes",
            "\"light\" or \"bounds\""),
    ]];
}
