//! Grids of voxels in a storage buffer, one after another.

use crate::gpu::{
    cache, layout,
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

/// Threads of a workgroup of `scan.wgsl`.
const SCAN_THREADS: u32 = 64;
/// Threads that share the rows of a word where words are few.
const PARTS: u32 = 16;
/// From so many words on a thread each keeps a device busy, and reads them once where several read them twice.
const MANY_WORDS: u32 = 1 << 16;

/// What `scan.wgsl` scans row by row: the words of a row, of all slices of so many grids.
pub(super) fn scan_columns(side: u32, grids: u32) -> u32 {
    grids * side * (side / 32)
}

/// Workgroups of a scan that shares the rows of a word out to so many threads.
pub(super) fn scan_groups(columns: u32, parts: u32) -> [u32; 3] {
    [columns.div_ceil(SCAN_THREADS / parts), 1, 1]
}

/// The scan of any number of grids.
pub(crate) struct Scan {
    /// A thread a word.
    whole: ComputeProgram,
    /// [`PARTS`] threads a word.
    shared_out: ComputeProgram,
}

impl cache::Programs for Scan {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [layout::uniform::<[u32; 4]>(0), layout::storage(1, false)];
        let program = |parts: u32| {
            ComputeProgram::new(device, shared, "scan", &[SCAN], "voxel_scan_rows", &own)
                .with("VOXEL_SCAN_PARTS", parts.into())
                .for_all_lights()
        };
        Self {
            whole: program(1),
            shared_out: program(PARTS),
        }
    }
}

impl Scan {
    /// Of so many grids of side^3 voxels.
    pub(crate) fn pass(
        &self,
        scope: &mut LightScope<'_>,
        side: u32,
        voxels: &wgpu::Buffer,
        grids: u32,
    ) -> Pass {
        let columns = scan_columns(side, grids);
        let (program, parts) = if columns < MANY_WORDS {
            (&self.shared_out, PARTS)
        } else {
            (&self.whole, 1)
        };
        let uniform = scope.uniform("voxels a side", &[side, columns, 0, 0]);
        let resources = [uniform.as_entire_binding(), voxels.as_entire_binding()];
        scope.compute(program, "scan", &resources, scan_groups(columns, parts))
    }
}
