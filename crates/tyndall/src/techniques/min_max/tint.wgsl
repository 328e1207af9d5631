// What light rays are dimmed by on their whole length, the light's picture and a spot's cone, as sums over each slice
// (Chen 2011, section 4.3): a row of sums holds, at every column's border, the integral from the row's start, in columns.

// True where there is a picture; without one a cone goes with the light's own integral.
fn tint_has_picture() -> bool {
    return LIGHT_TEXTURE != LIGHT_TEXTURE_NONE;
}

// Where a border's sum is stored.
fn tint_index(e: Epipolar, slice: u32, border: u32) -> u32 {
    return slice * (e.tint_columns + 1u) + border;
}
