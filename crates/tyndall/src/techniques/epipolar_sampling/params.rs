//! Parameters of `epipolar`, and its entry in the table.

use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "epipolar",
    about: "epipolar sampling with 1-D min/max trees: few rays marched along epipolar lines, the rest interpolated",
    citation: "Engelhardt & Dachsbacher, Epipolar Sampling for Shadows and Crepuscular Rays in Participating Media with Single Scattering, I3D 2010; Yusov, IVB Atmospheric Light Scattering, 2012",
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

/// Parameters of `epipolar`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Epipolar slices (0 to 4096); 0: half of width plus height.
    pub slices: u32,
    /// Samples a slice (0 or 2 to 4096); 0: half of the longer side.
    pub samples: u32,
    /// Samples from one that is marched to the next, where no depths differ (a power of two, 1 to 128).
    pub initial_step: u32,
    /// Factor by which the texture that samples are unwarped to is smaller on each side (1, 2 or 4).
    pub downscale: u32,
    /// Relative difference between neighbours past which one does not stand for the other (> 0, to 1).
    pub threshold: f64,
    /// Quantity that `threshold` compares.
    pub criterion: Criterion,
    /// Algorithm that marches.
    pub tree: Tree,
    /// Content of the image.
    pub show: Show,
}

/// Quantity that must not differ too much between samples that stand for each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// View depth.
    Depth,
    /// Light that would be scattered if nothing blocked it.
    InScatter,
}

/// Algorithms that march rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tree {
    /// With 1-D min/max trees (the article's algorithm 2).
    MinMax,
    /// Column by column (algorithm 1).
    None,
}

/// Content of the image: the light or a debug view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// In-scattered light.
    Light,
    /// Samples: white where marched, blue where interpolated.
    Samples,
    /// Samples that are marched because of a break.
    DepthBreaks,
    /// Pixels that had no fitting sources, red.
    Corrected,
    /// The interpolated quantity, before the phase function.
    InScatter,
}

const CRITERIA: &[(&str, Criterion)] = &[
    ("depth", Criterion::Depth),
    ("in-scatter", Criterion::InScatter),
];
const TREES: &[(&str, Tree)] = &[("min-max", Tree::MinMax), ("none", Tree::None)];
const SHOWN: &[(&str, Show)] = &[
    ("light", Show::Light),
    ("samples", Show::Samples),
    ("depth-breaks", Show::DepthBreaks),
    ("corrected", Show::Corrected),
    ("in-scatter", Show::InScatter),
];

impl Params {
    const DEFAULT: Self = Self {
        slices: 512,
        samples: 256,
        initial_step: 16,
        downscale: 1,
        threshold: 0.03,
        criterion: Criterion::Depth,
        tree: Tree::MinMax,
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
        param!(whole slices, 0..=4096, "epipolar slices; 0: half of width plus height"),
        param!(whole samples, 0..=4096,
            "samples a slice; 0: half of the picture's longer side",
            "0, or a whole number from 2 to 4096", |n| *n != 1),
        param!(whole initial_step, 1..=128,
            "samples from one that is marched to the next, where no depths differ",
            "a power of two from 1 to 128", |n| n.is_power_of_two()),
        param!(whole downscale, 1..=4,
            "how many times smaller the picture is on each side that samples are unwarped to",
            "1, 2 or 4", |n| n.is_power_of_two()),
        param!(real threshold, 0.0001..=1,
            "relative difference between neighbours past which one does not stand for the other"),
        param!(choice criterion, CRITERIA,
            "what must differ for a break between samples: their depths, or their unshadowed light",
            "\"depth\" or \"in-scatter\""),
        param!(choice tree, TREES,
            "march with 1-D min/max trees, or column by column",
            "\"min-max\" or \"none\""),
        param!(choice show, SHOWN,
            "the light, or in its place a view of how it was computed",
            "\"light\", \"samples\", \"depth-breaks\", \"corrected\" or \"in-scatter\""),
    ]];
}
