//! Parameters of `incremental`, and its entry in the table.

use crate::epipolar::Resolution;
use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, Sliced, Slicing, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "incremental",
    about: "partial sums per epipolar slice, view rays in order of their angle",
    citation: "Baran, Chen, Ragan-Kelley, Durand & Lehtinen, A Hierarchical Volumetric Shadow Algorithm for Single Scattering, SIGGRAPH Asia 2010",
    lights: &[LightKind::Directional, LightKind::Point],
    lights_on_gpu_only: &[],
    backends: Backends::Cpu,
    reads: Reads {
        glass: true,
        textures: false,
        occluders: false,
        points: false,
    },
    shadows_surfaces: false,
    is_reference: false,
};

/// Parameters of `incremental`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Products in the low-rank sum (1 to 16).
    pub rank: u32,
    /// Slices and samples.
    pub resolution: Resolution,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            rank: 4,
            resolution: Resolution {
                epipole_radius: 6.0,
                ..Resolution::default()
            },
        }
    }
}

impl Sliced for Params {
    const SLICES: &'static str = "epipolar slices; 0: every ray within half a pixel of one, and no fewer than the map's texels a side";
    const SAMPLES: &'static str = "light rays a slice; 0: the shadow map's texels a side";

    fn resolution(&self) -> &Resolution {
        &self.resolution
    }

    fn resolution_mut(&mut self) -> &mut Resolution {
        &mut self.resolution
    }
}

impl Parameters for Params {
    const INFO: TechniqueInfo = INFO;
    const PARAMS: &'static [&'static [Param<Self>]] = &[
        &[param!(whole rank, 1..=16, "products in the low-rank sum")],
        Slicing::<Self>::PARAMS,
    ];
}
