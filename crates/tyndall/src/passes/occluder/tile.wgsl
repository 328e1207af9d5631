// What is kept of the shadow volumes' boundaries on the screen: view depths [m] a tile of 4 x 4 pixels, between which lies
// whatever a ray of the tile meets. (OCCLUDER_BEYOND, 0) where none meets any; the first is OCCLUDER_BEYOND too where none
// enters a shadow, the second where one may stay in it for ever.

const OCCLUDER_TILE: u32 = 4u; // pixels a side
const OCCLUDER_BEYOND: f32 = 0x1p+100f;

fn occluder_tiles() -> vec2u {
    return (vec2u(frame.camera.size) + OCCLUDER_TILE - 1u) / OCCLUDER_TILE;
}

// Where a pixel's tile stands.
fn occluder_tile_of(pixel: vec2u) -> u32 {
    let tile = pixel / OCCLUDER_TILE;
    return tile.y * occluder_tiles().x + tile.x;
}

// Whether any ray meets a boundary there.
fn occluder_is_met(bounds: vec2f) -> bool {
    return bounds.x < OCCLUDER_BEYOND || bounds.y > 0.0;
}
