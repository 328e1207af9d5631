// Voxels of epipolar grids, as bits: set where the light is blocked; see voxels/mod.rs.

// Where a row of a grid of side^3 begins [words]; of several grids, slices count through.
fn voxel_row(side: u32, slice: u32, row: u32) -> u32 {
    return (slice * side + row) * (side / 32u);
}

// The bits below a number of them, 0 to 32.
fn voxel_mask(count: u32) -> u32 {
    return select((1u << (count & 31u)) - 1u, 0xffffffffu, count >= 32u);
}

// How much of the first `place` voxels of a word is dark; the voxel that `place` lies in counts in part.
fn voxel_dark(word: u32, place: f32) -> f32 {
    let whole = u32(place);
    let cut = select((word >> (whole & 31u)) & 1u, 0u, whole >= 32u);
    return f32(countOneBits(word & voxel_mask(whole))) + fract(place) * f32(cut);
}

// The row in whose voxel a light ray ends that is seen at `end` rows; `side` where no row sees it. View rays in the middle
// of a row before this one are before the end, in this one and after it behind it.
fn voxel_end(side: u32, end: f32) -> u32 {
    return u32(clamp(ceil(end - 0.5), 0.0, f32(side)));
}
