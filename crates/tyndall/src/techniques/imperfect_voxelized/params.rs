//! Parameters of `ivsv`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "ivsv",
    about: "imperfect voxelized shadow volumes: an area light as hundreds of coarse grids, all made at once",
    citation: "Wyman & Dai, Imperfect Voxelized Shadow Volumes, HPG 2013; maps: Ritschel et al., Imperfect Shadow Maps, SIGGRAPH Asia 2008",
    lights: &[LightKind::Rect],
    lights_on_gpu_only: &[],
    backends: Backends::Gpu,
    reads: Reads {
        glass: false,
        textures: true,
        occluders: false,
        points: true,
    },
    shadows_surfaces: true,
    is_reference: false,
};

/// Shares of the samples that pixels gather.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gather {
    /// Every pixel all samples.
    #[default]
    Full,
    /// Every pixel a ninth of the samples; those of 3 x 3 pixels are put together where their depths are alike.
    Interleaved,
    /// One pixel of 2 x 2 all samples; the others are interpolated where depths are alike.
    Quarter,
}

const GATHERS: &[(&str, Gather)] = &[
    ("full", Gather::Full),
    ("interleaved", Gather::Interleaved),
    ("quarter", Gather::Quarter),
];

/// Weight of a voxel in the light of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weighting {
    /// Its share of the light that the ray would get without shadows.
    #[default]
    Airlight,
    /// Equal for all.
    Uniform,
}

const WEIGHTINGS: &[(&str, Weighting)] = &[
    ("airlight", Weighting::Airlight),
    ("uniform", Weighting::Uniform),
];

/// Parameters of `ivsv`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Slices, view rays and light rays of a sample's grid, each (64, 128 or 256).
    pub resolution: u32,
    /// Points of the cloud that a sample's map is made of (0 to 2^20); 0: as many as it has texels; fewer where the
    /// cloud has fewer.
    pub points: u32,
    /// Share of the samples that a pixel gathers.
    pub gather: Gather,
    /// Weight of a voxel.
    pub weighting: Weighting,
    /// All samples at once, as many as the device binds; or each in passes of its own.
    pub batched: bool,
    /// Radius about a sample's axis within which distances are compared \[pixels] (0 to 100).
    pub epipole_radius: f64,
}

impl Params {
    const DEFAULT: Self = Self {
        resolution: 128,
        points: 0,
        gather: Gather::Full,
        weighting: Weighting::Airlight,
        batched: true,
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
        param!(whole resolution, 64..=256, "slices, view rays and light rays of a sample's grid, each",
            "64, 128 or 256", |n| n.is_power_of_two()),
        param!(whole points, 0..=1048576,
            "points of the scene's surfaces that a sample's map is made of; 0: as many as it has texels"),
        param!(choice gather, GATHERS,
            "every pixel all samples, a ninth of them, or one pixel of four all",
            "\"full\", \"interleaved\" or \"quarter\""),
        param!(choice weighting, WEIGHTINGS,
            "what a voxel counts for: its share of the unshadowed light, or as much as any",
            "\"airlight\" or \"uniform\""),
        param!(flag batched, "all samples at once; false: each in passes of its own"),
        param!(real epipole_radius, 0..=100,
            "rays this near to a sample's axis compare distances [pixels]"),
    ]];
}
