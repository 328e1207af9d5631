//! Parameters of `light-volume`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "light-volume",
    about: "the shadow map as a closed mesh, drawn additively with signed airlight",
    citation: "Billeter, Sintorn & Assarsson, Real Time Volumetric Shadows using Polygonal Light Volumes, HPG 2010",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    lights_on_gpu_only: &[],
    backends: Backends::Gpu,
    reads: Reads {
        glass: true,
        textures: false,
        occluders: false,
        points: false,
    },
    shadows_surfaces: false,
    is_reference: false,
};

/// Parameters of `light-volume`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Cells of the mesh are merged where that moves its surface by no more than this, along the light, in widths of a
    /// texel there (0 to 100); 0 draws every texel.
    pub tolerance: f64,
}

impl Params {
    const DEFAULT: Self = Self { tolerance: 0.5 };
}

impl Default for Params {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Parameters for Params {
    const INFO: TechniqueInfo = INFO;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[param!(real tolerance, 0..=100,
            "how far merging cells may move the surface [widths of a texel]; 0 merges none")]];
}
