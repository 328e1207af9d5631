//! `ivsv`: imperfect voxelized shadow volumes, soft shadows of a rectangular light (Wyman and Dai 2013).

#[cfg(feature = "gpu")]
pub(crate) mod gpu;

use super::{
    Backends, LightKind, Technique, TechniqueInfo, Value,
    params::{Param, Parameters, word},
};

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "ivsv",
    about: "imperfect voxelized shadow volumes: an area light as hundreds of coarse grids, all made at once",
    citation: "Wyman & Dai, Imperfect Voxelized Shadow Volumes, HPG 2013; maps: Ritschel et al., Imperfect Shadow Maps, SIGGRAPH Asia 2008",
    lights: &[LightKind::Rect],
    backends: Backends::Gpu,
    default: || Technique::ImperfectVoxelized(Params::DEFAULT),
};

/// Which pixels gather which samples.
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

/// What a voxel counts for in the light of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weighting {
    /// Its share of the light that the ray would get without shadows.
    #[default]
    Airlight = 0,
    /// The same for all.
    Uniform = 1,
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
    /// Points of the cloud that a sample's map is made of (1 to 2^20); fewer where the cloud has fewer.
    pub points: u32,
    /// Which pixels gather which samples.
    pub gather: Gather,
    /// What a voxel counts for.
    pub weighting: Weighting,
    /// All samples at once, as many as the device binds; or each in passes of its own.
    pub batched: bool,
    /// Radius about a sample's axis within which distances are compared [pixels] (0 to 100).
    pub epipole_radius: f64,
}

impl Params {
    const DEFAULT: Self = Self {
        resolution: 128,
        points: 8192,
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
    const TECHNIQUE: &'static str = INFO.name;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[
        Param {
            key: "resolution",
            about: "slices, view rays and light rays of a sample's grid, each",
            range: "64, 128 or 256",
            get: |p| Value::Integer(p.resolution.into()),
            set: |p, v| {
                p.resolution = v.integer(64..=256).filter(|n| n.is_power_of_two())?;
                Some(())
            },
        },
        Param {
            key: "points",
            about: "points of the scene's surfaces that a sample's map is made of",
            range: "a whole number from 1 to 1048576",
            get: |p| Value::Integer(p.points.into()),
            set: |p, v| {
                p.points = v.integer(1..=1 << 20)?;
                Some(())
            },
        },
        Param {
            key: "gather",
            about: "every pixel all samples, a ninth of them, or one pixel of four all",
            range: "\"full\", \"interleaved\" or \"quarter\"",
            get: |p| word(&p.gather, GATHERS),
            set: |p, v| {
                p.gather = v.choice(GATHERS)?;
                Some(())
            },
        },
        Param {
            key: "weighting",
            about: "what a voxel counts for: its share of the unshadowed light, or as much as any",
            range: "\"airlight\" or \"uniform\"",
            get: |p| word(&p.weighting, WEIGHTINGS),
            set: |p, v| {
                p.weighting = v.choice(WEIGHTINGS)?;
                Some(())
            },
        },
        Param {
            key: "batched",
            about: "all samples at once; false: each in passes of its own",
            range: "true or false",
            get: |p| Value::Bool(p.batched),
            set: |p, v| {
                let Value::Bool(batched) = *v else {
                    return None;
                };
                p.batched = batched;
                Some(())
            },
        },
        Param {
            key: "epipole_radius",
            about: "rays this near to a sample's axis compare distances [pixels]",
            range: "a number from 0 to 100",
            get: |p| Value::Real(p.epipole_radius),
            set: |p, v| {
                p.epipole_radius = v.real(0.0..=100.0)?;
                Some(())
            },
        },
    ]];
}
