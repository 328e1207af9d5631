//! The maps of a rectangular light's samples in a storage buffer, batch by batch.

use super::{
    area::{AreaLight, Maps},
    buffers::Buffers,
    colors::Colors,
    pull_push::PullPush,
    splat::Splat,
};
use crate::gpu::{
    cache,
    pass::Pass,
    scope::{LightScope, Shared},
};

/// The programs that make imperfect shadow maps, by pass.
pub(crate) struct Programs {
    colors: Colors,
    splat: Splat,
    pull_push: PullPush,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            colors: Colors::new(device, shared),
            splat: Splat::new(device, shared),
            pull_push: PullPush::new(device, shared),
        }
    }
}

impl Programs {
    /// The samples of a light: their buffers, and the pass that colours them.
    pub(crate) fn sample(
        &self,
        scope: &mut LightScope<'_>,
        area: &AreaLight,
        maps: &Maps,
    ) -> (Buffers, Pass) {
        let buffers = Buffers::new(scope, area, maps);
        let count = area.positions.len() as u32;
        let pass = self.colors.pass(scope, &buffers, count);
        (buffers, pass)
    }

    /// The maps of a batch: its points, and their holes filled.
    pub(crate) fn draw(
        &self,
        scope: &mut LightScope<'_>,
        buffers: &Buffers,
        index: u32,
        cloud: &wgpu::Buffer,
    ) -> [Pass; 2] {
        [
            self.splat.pass(scope, buffers, index, cloud),
            self.pull_push.pass(scope, buffers, index),
        ]
    }
}
