//! Grids of voxels in a storage buffer, one after another.

use bytemuck::{Pod, Zeroable};

use crate::gpu::{
    layout,
    pass::{Dispatch, Pass},
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

/// Places of voxels, and queries of a word.
pub(crate) const VOXELS: &str = include_str!("voxels.wgsl");
/// Queries of a row; needs `VOXELS` and a buffer `voxels`.
pub(crate) const RUNS: &str = include_str!("runs.wgsl");
pub(super) const SCAN: &str = include_str!("scan.wgsl");
pub(super) const CLEAR: &str = include_str!("clear.wgsl");

/// The most workgroups a dimension may have on every device.
const MAX_WORKGROUPS: u64 = 65_535;
/// Words that a workgroup of `clear.wgsl` sets at least.
const CLEARED_WORDS: u64 = 1024;

/// `VoxelScan` of `scan.wgsl` and `VoxelClear` of `clear.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct WordUniform {
    word: u32,
    pad: [u32; 3],
}

impl WordUniform {
    fn new(word: u32) -> Self {
        Self { word, pad: [0; 3] }
    }
}

/// Bytes of one grid.
pub(crate) fn bytes(side: u32) -> u64 {
    u64::from(side).pow(3) / 8
}

/// What all grids of voxels need.
pub(crate) struct Programs {
    clear: ComputeProgram,
    scan: ComputeProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [layout::uniform::<WordUniform>(0), layout::storage(1, false)];
        let program = |label, wgsl, entry_point| {
            ComputeProgram::new(device, shared, label, &[wgsl], entry_point, &own).for_all_lights()
        };
        Self {
            clear: program("clear words", CLEAR, "voxel_clear_words"),
            scan: program("scan", SCAN, "voxel_scan_rows"),
        }
    }

    /// Sets every word of a buffer, whose size is a multiple of 16 bytes.
    pub(crate) fn clear(
        &self,
        scope: &mut LightScope<'_>,
        name: &'static str,
        words: &wgpu::Buffer,
        value: u32,
    ) -> Dispatch {
        let uniform = scope.uniform(name, &WordUniform::new(value));
        let groups = (words.size() / 4)
            .div_ceil(CLEARED_WORDS)
            .clamp(1, MAX_WORKGROUPS);
        let resources = [uniform.as_entire_binding(), words.as_entire_binding()];
        scope.dispatch(&self.clear, &resources, [groups as u32, 1, 1])
    }

    /// The scan of so many grids.
    pub(crate) fn scan(
        &self,
        scope: &mut LightScope<'_>,
        side: u32,
        voxels: &wgpu::Buffer,
        grids: u32,
    ) -> Pass {
        let uniform = scope.uniform("voxels a side", &WordUniform::new(side));
        let resources = [uniform.as_entire_binding(), voxels.as_entire_binding()];
        let groups = [side, grids, (side / 32).div_ceil(4)];
        scope.compute(&self.scan, "scan", &resources, groups)
    }
}
