// What light rays are dimmed by on their whole length, the light's picture and a spot's cone, as sums over each slice
// (Chen 2011, section 4.3): a row of sums holds, at every column's border, the integral from the row's start, in columns;
// for the svd integrator one row a term, weighted by the term's Gamma.

override SVD: bool = false;

// True where there are such sums. Without a picture a cone goes with the light's own integral, if that is closed.
fn tint_is_summed() -> bool {
    return LIGHT_TEXTURE != LIGHT_TEXTURE_NONE || (SVD && LIGHT_KIND == LIGHT_SPOT);
}

// Where a border's sum is stored.
fn tint_index(e: Epipolar, slice: u32, term: u32, border: u32) -> u32 {
    return (term * e.slices + slice) * (e.tint_columns + 1u) + border;
}
