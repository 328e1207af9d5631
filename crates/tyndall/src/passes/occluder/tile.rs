//! Tiles of the screen that bounds are kept by.

use crate::shader::constant;

/// Tiles of an image of this size \[pixels].
pub(super) fn tiles(size: [u32; 2]) -> u64 {
    let [columns, rows] = size.map(|side| u64::from(side.div_ceil(constant("OCCLUDER_TILE"))));
    columns * rows
}

/// Bytes of the bounds of an image of this size \[pixels].
pub(super) fn tile_bytes(size: [u32; 2]) -> u64 {
    size_of::<[f32; 2]>() as u64 * tiles(size)
}
