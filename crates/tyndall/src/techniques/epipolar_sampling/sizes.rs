//! Sizes of the buffers of a light's passes.

use super::params::{INFO, Params, Tree};
use crate::{
    error::PrepareError,
    frame::{Light, ShadowProjection},
    gpu::limits,
    inputs::LightInputs,
    techniques::LightRequest,
};

/// Numbers of slices, samples and so on for one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sizes {
    pub(super) slices: u32,
    pub(super) samples: u32,
    /// Charts a slice: two where the shadow map is a cube.
    pub(super) charts: u32,
    /// Leaves of a tree.
    pub(super) columns: u32,
    /// Levels of a tree above its leaves; 0: no trees.
    pub(super) levels: u32,
    /// Width and height of what samples are unwarped to \[pixels].
    pub(super) coarse: [u32; 2],
    pub(super) size: [u32; 2],
}

/// Bytes of each buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bytes {
    pub(super) lines: u64,
    pub(super) traces: u64,
    pub(super) depth: u64,
    pub(super) sources: u64,
    pub(super) nodes: u64,
    pub(super) values: u64,
    pub(super) coarse_list: u64,
    pub(super) list: u64,
}

impl Sizes {
    pub(super) fn new(
        params: &Params,
        size: [u32; 2],
        light: &Light,
        inputs: &LightInputs<'_>,
    ) -> Self {
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

    /// The weight that samples must have together to stand for a pixel. That of the shaders is 0.01; in an image of so few pixels
    /// a side that light changes from each to the next as it will, none is enough, and all are marched.
    pub(super) fn least_weight(&self) -> f32 {
        if self.size[0].min(self.size[1]) <= FEW_PIXELS {
            f32::MAX
        } else {
            0.01
        }
    }

    pub(super) fn bytes(&self) -> Bytes {
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

/// Refuses what does not fit into the device's storage bindings.
pub(crate) fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let bytes = Sizes::new(params, request.size, request.light, request.inputs).bytes();
    limits::check_storage(
        request.limits,
        &format!("technique `{}` (lights[{}])", INFO.name, request.index),
        &[
            ("min/max trees", bytes.nodes),
            ("samples", bytes.values),
            ("lists of pixels", bytes.list),
        ],
    )
}

/// Pixels a side of images that are marched pixel by pixel: measured at 16, the error of interpolation is twice that at 32.
const FEW_PIXELS: u32 = 16;

/// Levels of a tree; coarser nodes are hardly ever lit or dark throughout (Yusov 2012, section 6.3).
const MOST_LEVELS: u32 = 12;
