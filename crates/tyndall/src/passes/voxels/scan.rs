//! The scan of grids of voxels, row by row.

use crate::{
    gpu::{
        cache,
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::constant,
};

/// Threads that share the rows of a word where words are few.
const PARTS: u32 = 16;
/// From so many words on a thread each keeps a device busy, and reads them once where several read them twice.
const MANY_WORDS: u32 = 1 << 16;

/// Columns of words that are scanned: the words of a row, of all slices of so many grids.
pub(super) fn scan_columns(side: u32, grids: u32) -> u32 {
    grids * side * (side / 32)
}

/// Workgroups of a scan that shares the rows of a word out to so many threads.
pub(super) fn scan_groups(columns: u32, parts: u32) -> [u32; 3] {
    [
        columns.div_ceil(constant("VOXEL_SCAN_THREADS") / parts),
        1,
        1,
    ]
}

/// The scan of any number of grids.
pub(crate) struct Scan {
    /// A thread a word.
    by_word: ComputeProgram,
    /// [`PARTS`] threads a word.
    shared_out: ComputeProgram,
}

impl cache::Programs for Scan {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |parts: u32| {
            ComputeProgram::new(device, shared, "passes::voxels::scan", "voxel_scan_rows")
                .with("VOXEL_SCAN_PARTS", parts.into())
                .for_all_lights()
        };
        Self {
            by_word: program(1),
            shared_out: program(PARTS),
        }
    }
}

impl Scan {
    /// The scan of so many grids of side^3 voxels.
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
            (&self.by_word, 1)
        };
        let uniform = scope.uniform("voxels a side", &[side, columns, 0, 0]);
        let resources = [uniform.as_entire_binding(), voxels.as_entire_binding()];
        scope.compute(program, "scan", &resources, scan_groups(columns, parts))
    }
}
