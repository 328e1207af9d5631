// What tints lit stretches: the light's picture, and coloured glass (Chen 2011, section 4.3), as sums over each slice.
//
// A row of sums holds, at every column's border, the integral of the tint from the row's start, in columns. There are
// two a slice where there is glass: of the picture alone, and of the picture and all the glass on a light ray. Which of
// them holds for a view ray depends on whether it passes behind the glass; a tree of (min, max) of the glass's S,
// searched like that of the shadows, says where. Both are sampled on light rays in the middle of slice and column.

fn tint_is_any() -> bool {
    return SHADOW_GLASS || LIGHT_TEXTURE != LIGHT_TEXTURE_NONE;
}

// Columns of a row.
const TINT_COLUMNS: u32 = 1024u;
// Change in the light but for its tint over a block: optical depth, or angle at the light [rad].
const TINT_BLOCK_DEPTH: f32 = 0.25;
const TINT_BLOCK_ANGLE: f32 = 0.1;

// Among the columns.
fn tint_place(e: Epipolar, gamma: f32) -> f32 {
    return clamp((gamma - e.tint_start) / e.tint_step, 0.0, f32(TINT_COLUMNS));
}

// Where a border's sum is stored: rows of the picture alone, then rows of picture and glass.
fn tint_index(e: Epipolar, slice: u32, with_glass: u32, border: u32) -> u32 {
    return (with_glass * e.slices + slice) * (TINT_COLUMNS + 1u) + border;
}
