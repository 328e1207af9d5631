//! `light-volume`: polygonal light volumes (Billeter, Sintorn, Assarsson 2010).

#[cfg(feature = "gpu")]
mod extent;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(feature = "gpu")]
mod tessellation;
#[cfg(all(test, feature = "gpu"))]
mod twin;

use super::{
    Backends, LightKind, Technique, TechniqueInfo, Value,
    params::{Param, Parameters},
};

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "light-volume",
    about: "the shadow map as a closed mesh, drawn additively with signed airlight",
    citation: "Billeter, Sintorn & Assarsson, Real Time Volumetric Shadows using Polygonal Light Volumes, HPG 2010",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    backends: Backends::Gpu,
    default: || Technique::LightVolume(Params::DEFAULT),
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
    const TECHNIQUE: &'static str = INFO.name;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[Param {
        key: "tolerance",
        about: "how far merging cells may move the surface [widths of a texel]; 0 merges none",
        range: "a number from 0 to 100",
        get: |p| Value::Real(p.tolerance),
        set: |p, v| {
            p.tolerance = v.real(0.0..=100.0)?;
            Some(())
        },
    }]];
}
