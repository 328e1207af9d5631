//! Grids of voxels in a storage buffer, one after another.

/// Bytes of one grid.
pub(crate) fn bytes(side: u32) -> u64 {
    u64::from(side).pow(3) / 8
}
