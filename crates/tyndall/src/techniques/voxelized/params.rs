//! Parameters of `vsv`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "vsv",
    about: "voxelized shadow volumes: bits over epipolar space, a view ray's visibility in one row",
    citation: "Wyman, Voxelized Shadow Volumes, HPG 2011; Wyman & Dai, Imperfect Voxelized Shadow Volumes, HPG 2013",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    lights_on_gpu_only: &[],
    backends: Backends::Gpu,
    reads: Reads {
        glass: true,
        textures: true,
        occluders: false,
        points: false,
    },
    shadows_surfaces: false,
    is_reference: false,
};

/// Parameters of `vsv`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Slices, view rays and light rays, each (a power of two from 64 to 1024).
    pub resolution: u32,
    /// Radius about the axis within which distances are compared \[pixels] (0 to 100).
    pub epipole_radius: f64,
}

impl Params {
    const DEFAULT: Self = Self {
        resolution: 512,
        epipole_radius: 0.5,
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
        param!(whole resolution, 64..=1024, "slices, view rays and light rays, each",
            "64, 128, 256, 512 or 1024", |n| n.is_power_of_two()),
        param!(real epipole_radius, 0..=100,
            "rays this near to the axis compare distances [pixels]"),
    ]];
}
