//! Buffers of one light's reuse.

use std::mem::offset_of;

use super::{
    blocks::Pyramid,
    frame::Frame,
    reuse::{MAX_DISPATCHES, ParamsUniform, State},
};
use crate::{
    gpu::{pass::Workgroups, pool::Owner, scope::LightScope},
    shader::block,
};

block! {
    /// The shaders' `DecideSizes`.
    pub(super) struct Sizes = "DecideSizes" in "tyndall::temporal::decide", checked by decide_sizes_is_laid_out_as_in_wgsl {
        pub(super) mask: [[u32; 3]; MAX_DISPATCHES],
        pub(super) reproject: [u32; 3],
        pub(super) restore: [u32; 4],
    }
}

/// Buffers of one light.
pub(super) struct Buffers {
    pub(super) params: wgpu::Buffer,
    /// [`State`].
    pub(super) state: wgpu::Buffer,
    /// [`Sizes`].
    pub(super) sizes: wgpu::Buffer,
    /// Depths between which visibility changed, a block of the shadow map each.
    pub(super) blocks: wgpu::Buffer,
    /// The shadow map that the frame before saw.
    pub(super) map_seen: wgpu::Buffer,
    /// The depth buffer that the frame before saw.
    pub(super) depth_seen: wgpu::Buffer,
    /// Each pixel's memory, see `REUSE_AGE`.
    pub(super) age: wgpu::Buffer,
    /// The witness that the frame before saw.
    pub(super) witness_seen: wgpu::Buffer,
    /// Each pixel as it is found in the image of another camera.
    pub(super) found: wgpu::Buffer,
}

impl Buffers {
    pub(super) fn new(
        frame: &Frame<'_>,
        pyramid: &Pyramid,
        params: &ParamsUniform,
        witness: Option<&wgpu::Buffer>,
        scope: &mut LightScope<'_>,
    ) -> Self {
        let word = size_of::<u32>() as u64;
        let texels = pyramid.texels().max(1);
        let blocks = pyramid.blocks().max(1) * size_of::<[f32; 2]>() as u64;
        let pixels = u64::from(scope.size[0]) * u64::from(scope.size[1]);
        let witnessed = witness.map_or(size_of::<[f32; 2]>() as u64, wgpu::Buffer::size);
        let found = if frame.reuse.reproject.is_some() {
            pixels
        } else {
            1
        };
        let sizes = size_of::<Sizes>().div_ceil(size_of::<[u32; 3]>());
        Self {
            params: scope.uniform("reuse params", params),
            state: state(scope),
            sizes: scope.indirect("reuse dispatches", sizes as u64),
            blocks: scope.kept_storage("reuse blocks", blocks),
            map_seen: scope.kept_storage("reuse shadow map", word * texels),
            depth_seen: scope.kept_storage("reuse depth", word * pixels),
            age: scope.kept_storage("reuse age", word * pixels),
            witness_seen: scope.kept_storage("reuse witness", witnessed),
            found: scope.kept_storage("reuse found", 4 * word * found),
        }
    }

    /// Workgroups of one of the dispatches that look for stale pixels.
    pub(super) fn mask_groups(&self, index: usize) -> Workgroups {
        let offset = offset_of!(Sizes, mask) + index * size_of::<[u32; 3]>();
        Workgroups::Indirect(self.sizes.clone(), offset as u64)
    }
}

fn state(scope: &mut LightScope<'_>) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let key = (Owner::Light(scope.index), "reuse state");
    let bytes = size_of::<State>() as u64;
    scope.pool.buffer(scope.device, key, bytes, usage)
}
