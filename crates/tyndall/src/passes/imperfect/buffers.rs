//! Buffers that the passes over a light's samples share.

use super::area::{AreaLight, BatchUniform, Maps};
use crate::gpu::scope::{Blocks, LightScope};

/// A light's samples, and the maps of a batch of them.
pub(crate) struct Buffers {
    pub(crate) batches: Blocks<BatchUniform>,
    pub(crate) samples: wgpu::Buffer,
    /// Intensity of each sample along the normal [W/sr].
    pub(crate) colors: wgpu::Buffer,
    pub(crate) maps: wgpu::Buffer,
}

impl Buffers {
    pub(super) fn new(scope: &mut LightScope<'_>, area: &AreaLight, maps: &Maps) -> Self {
        let count = area.positions.len() as u64;
        Self {
            batches: scope.blocks("batches", area.batches(maps)),
            samples: scope.upload("samples", &area.samples(scope.rays.eye, maps)),
            colors: scope.storage("colors of the samples", 16 * count),
            maps: scope.storage("imperfect maps", maps.bytes()),
        }
    }
}
