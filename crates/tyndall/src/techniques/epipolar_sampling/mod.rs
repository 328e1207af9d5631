//! `epipolar`: epipolar sampling with 1-D min/max trees (Engelhardt & Dachsbacher 2010; Yusov 2012).
//!
//! Shafts run along the lines of the picture that meet at the light's place on it, the epipole. Along a line the light
//! varies slowly but where depths break. So rays are marched at a few samples of each line, more where depths break, and
//! the rest is interpolated. All rays of a line lie in one plane with the light, and see one row of the shadow map; a tree
//! of (min, max) over the row finds their lit stretches in few steps.
//!
//! The article's stages: slice end points; linear depth and coordinate texture (the depth of every sample); refinement and
//! marking (which samples are marched); slice directions and min/max tree; ray marching; interpolation; unwarping to a
//! picture `downscale` times smaller, by a filter that is bilinear as far as depths are alike; correction of the pixels that
//! have no such samples; upscaling and a second correction where the picture is smaller; the phase function. Each is a pass,
//! but for linear depth, which is had from the depth buffer wherever it is needed, and for those named in one breath. At full
//! resolution unwarping and the phase function are one pass too, and corrected pixels are drawn once more, as points; not so
//! where pixels are kept from frame to frame, since there the last pass alone draws.
//!
//! What differs from the article:
//!
//! - What is interpolated is the mean visibility: the light that is seen as a share of what would be seen if nothing blocked
//!   it, `L = v(pixel) L_unshadowed(pixel)`. The article takes the phase function of the sun out of the interpolation; this
//!   takes out the dependence on depth, the peak beside a local light and a spot's cone, too. Light that nothing blocks is
//!   exact. Relative error on 1280 x 960 pixels of terrain: 5e-4.
//! - In its slice a ray is a straight line over columns of the shadow map, in the coordinates (t, z) that perspective keeps
//!   straight; one that crosses a texel's depth is lit in part. So rays near the epipole, that cross few columns, need no
//!   other treatment. Of a column both texels count that the slice's trace crosses, as far as it does: with one texel a
//!   column shadows end up to half a texel beside their place, and a church's error does not fall below 0.022 however fine
//!   the slices are (0.0024 with both). A cube map is resampled on the fly to two charts of 90 degrees a slice, half a
//!   column a texel.
//! - Nodes are compared with the same numbers as columns, and lit columns that adjoin make one stretch, integrated in closed
//!   form: with trees and without (`tree`) results are equal bit by bit.
//! - Slices are spread over the part of the border that lines end on, not all of it; lines begin a twentieth of a pixel
//!   beside an epipole on the picture, and go a pixel beyond its rim.
//! - A corrected pixel is marched in its two slices' trees instead of step by step, and weighted like an interpolated one.
//!
//! `initial_step` and `threshold` trade time for error: the same terrain with 4 and 0.01 has an error of 2e-4 for a
//! few milliseconds more. Pictures and coloured glass are looked up column by column of every lit stretch.
//!
//! What was tried, 1280 x 960 pixels on a software driver:
//!
//! - Samples integrated by the trees of technique `min-max`, over the rectified shadow map, in place of algorithm 2, which
//!   Chen et al. suggest. The trees cost more than they save: terrain with a 4096^2 map 260 ms for trees and marching, a
//!   church 590, against 66 and 142; with a 1024^2 map 65 and 130, against 24 and 48. Errors are those of interpolation
//!   either way: church 0.0227, through a rose window 0.0535 against 0.0540.
//! - Values and depths of samples in one picture in place of two buffers: unwarping takes half as long.
//! - Unwarping and phase function in one pass, the picture between them left out: 0.6 of the time of both and of linear depth,
//!   0.7 to 0.8 of the whole frame. Half of what is left is the filter, half the light of a pixel.
//! - Correction within that pass, in a loop that only pixels without sources go through: 1.9 times as long, for drivers that
//!   run through a loop once before they ask whether any pixel does. As a list it takes a fiftieth of the frame.
//! - Refinement and marking in one pass: three quarters of the time of both.
//!
//! Cost: slices x map side texels for the trees, some nodes a marched sample, and a few texels a pixel: most of the time
//! goes into the stages over pixels.
//!
//! Where it fails: shadows finer than the slices are apart are blurred across them, and ends of shafts between two marched
//! samples are blurred along them: breaks are looked for in depths, not in shadows. It shows where little else is seen, as
//! from below a ground whose shadow map lets light through between its texels. Pictures of thin leaves have a depth break at
//! most samples: all are marched.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;

use super::{
    Backends, LightKind, Technique, TechniqueInfo,
    params::{Param, Parameters, param},
};
#[cfg(feature = "gpu")]
use crate::{
    effect::LightInputs,
    error::PrepareError,
    frame::{Light, ShadowProjection},
    gpu::limits,
};

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "epipolar",
    about: "epipolar sampling with 1-D min/max trees: few rays marched along epipolar lines, the rest interpolated",
    citation: "Engelhardt & Dachsbacher, Epipolar Sampling for Shadows and Crepuscular Rays in Participating Media with Single Scattering, I3D 2010; Yusov, IVB Atmospheric Light Scattering, 2012",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    backends: Backends::Gpu,
    default: || Technique::Epipolar(Params::DEFAULT),
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
    /// How many times smaller the picture is on each side that samples are unwarped to (1, 2 or 4).
    pub downscale: u32,
    /// Relative difference between neighbours past which one does not stand for the other (> 0, to 1).
    pub threshold: f64,
    /// What that is a difference of.
    pub criterion: Criterion,
    /// Which algorithm marches.
    pub tree: Tree,
    /// What the picture shows.
    pub show: Show,
}

/// What must not differ too much between samples that stand for each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// View depth.
    Depth,
    /// What would be scattered if nothing blocked the light.
    InScatter,
}

/// How rays are marched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tree {
    /// With 1-D min/max trees (the article's algorithm 2).
    MinMax,
    /// Column by column (algorithm 1).
    None,
}

/// What the picture shows.
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
    /// What is interpolated, before the phase function.
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
    const TECHNIQUE: &'static str = INFO.name;
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

/// How large everything is for one light.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sizes {
    slices: u32,
    samples: u32,
    /// Charts a slice: two where the shadow map is a cube.
    charts: u32,
    /// Leaves of a tree.
    columns: u32,
    /// Levels of a tree above its leaves; 0: no trees.
    levels: u32,
    /// Width and height of what samples are unwarped to [pixels].
    coarse: [u32; 2],
    size: [u32; 2],
}

/// Bytes of each buffer.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bytes {
    lines: u64,
    traces: u64,
    depth: u64,
    sources: u64,
    nodes: u64,
    values: u64,
    coarse_list: u64,
    list: u64,
}

#[cfg(feature = "gpu")]
impl Sizes {
    fn new(params: &Params, size: [u32; 2], light: &Light, inputs: &LightInputs<'_>) -> Self {
        let or = |n: u32, rule: u32| if n == 0 { rule } else { n };
        let map = inputs.shadow_map.map(|map| map.texture().size());
        let side = map.map_or(1, |map| map.width.max(map.height));
        let columns = side.next_power_of_two();
        let has_tree = params.tree == Tree::MinMax && map.is_some();
        Self {
            slices: or(params.slices, size[0].midpoint(size[1])).clamp(1, 4096),
            samples: or(params.samples, size[0].max(size[1]) / 2).clamp(2, 4096),
            charts: match light.shadow {
                Some(ShadowProjection::Cube { .. }) => 2,
                _ => 1,
            },
            columns,
            levels: if has_tree {
                columns.ilog2().min(MOST_LEVELS)
            } else {
                0
            },
            coarse: size.map(|n| n.div_ceil(params.downscale)),
            size,
        }
    }

    fn bytes(&self) -> Bytes {
        let slices = u64::from(self.slices);
        let samples = slices * u64::from(self.samples);
        let area = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
        let nodes = slices * u64::from(self.charts) * u64::from(self.columns);
        Bytes {
            lines: 16 * slices,
            traces: 32 * slices,
            depth: 4 * samples,
            sources: 4 * samples,
            nodes: if self.levels > 0 { 8 * nodes } else { 8 },
            values: 16 * samples,
            coarse_list: 4 * area(self.coarse),
            list: 4 * area(self.size),
        }
    }
}

#[cfg(feature = "gpu")]
impl Params {
    /// Refuses what does not fit into the device's storage bindings.
    pub(crate) fn check_gpu(
        &self,
        limits: &wgpu::Limits,
        size: [u32; 2],
        index: usize,
        light: &Light,
        inputs: &LightInputs<'_>,
    ) -> Result<(), PrepareError> {
        let bytes = Sizes::new(self, size, light, inputs).bytes();
        limits::check_storage(
            limits,
            &format!("technique `{}` (lights[{index}])", INFO.name),
            &[
                ("min/max trees", bytes.nodes),
                ("samples", bytes.values),
                ("lists of pixels", bytes.list),
            ],
        )
    }
}

/// Levels of a tree; coarser nodes are hardly ever lit or dark as a whole (Yusov 2012, section 6.3).
#[cfg(feature = "gpu")]
const MOST_LEVELS: u32 = 12;
