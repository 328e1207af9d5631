// Widens what is kept on the screen, see tile.wgsl.

@group(2) @binding(6) var<storage, read_write> write_tiles: array<atomic<u32>>;

// Bits of a depth that are rounded away: what moves a little keeps its bounds.
const WRITE_COARSE: u32 = 0x7fffu;

// Of a piece between these depths.
fn write_depths(tile: u32, depths: vec2f, facing: vec2<bool>) {
    // Positive floats are ordered as their bits are.
    let bits = bitcast<vec2u>(clamp(depths, vec2f(0.0), vec2f(OCCLUDER_BEYOND)));
    if facing.x {
        atomicMin(&write_tiles[2u * tile], bits.x & ~WRITE_COARSE);
    }
    if facing.y && depths.y >= 0.0 {
        atomicMax(&write_tiles[2u * tile + 1u], max(bits.y + WRITE_COARSE, WRITE_COARSE + 1u) & ~WRITE_COARSE);
    }
}
