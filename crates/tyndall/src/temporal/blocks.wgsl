// Blocks of shadow-map texels and the depths between which their visibility changed, 1 nearest to the light: from x to y,
// nothing where x > y. A pyramid, finest level first; each level's faces one after the other, row by row.

const BLOCKS_SIDE: u32 = 8u; // texels of a finest block's side
// Farther from the light than all depths.
const BLOCKS_BEYOND: f32 = -1e30;
const BLOCKS_NOTHING: vec2f = vec2f(1e30, -1e30);

fn blocks_size(level: u32) -> vec2u {
    let finest = (reuse.map + BLOCKS_SIDE - 1u) / BLOCKS_SIDE;
    return max((finest + (1u << level) - 1u) >> vec2u(level), vec2u(1u));
}

// Where a level begins.
fn blocks_start(level: u32) -> u32 {
    var start = 0u;
    for (var k = 0u; k < level; k++) {
        let size = blocks_size(k);
        start += size.x * size.y * reuse.faces;
    }
    return start;
}
