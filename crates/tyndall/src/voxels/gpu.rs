//! Grids of voxels in a storage buffer, one after another.

use crate::gpu::{
    layout,
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

/// Places of voxels, and queries of a word.
pub(crate) const VOXELS: &str = include_str!("voxels.wgsl");
/// Queries of a row; needs `VOXELS` and a buffer `voxels`.
pub(crate) const RUNS: &str = include_str!("runs.wgsl");
pub(super) const SCAN: &str = include_str!("scan.wgsl");

/// Bytes of one grid.
pub(crate) fn bytes(side: u32) -> u64 {
    u64::from(side).pow(3) / 8
}

/// The scan of any number of grids.
pub(crate) struct Scan(ComputeProgram);

impl Scan {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [layout::uniform::<[u32; 4]>(0), layout::storage(1, false)];
        let program = ComputeProgram::new(device, shared, "scan", &[SCAN], "voxel_scan_rows", &own);
        Self(program.for_all_lights())
    }

    /// Of so many grids of side^3 voxels.
    pub(crate) fn pass(
        &self,
        scope: &mut LightScope<'_>,
        side: u32,
        voxels: &wgpu::Buffer,
        grids: u32,
    ) -> Pass {
        let uniform = scope.uniform("voxels a side", &[side, 0, 0, 0]);
        let resources = [uniform.as_entire_binding(), voxels.as_entire_binding()];
        let groups = [side, grids, (side / 32).div_ceil(4)];
        scope.compute(&self.0, "scan", &resources, groups)
    }
}
