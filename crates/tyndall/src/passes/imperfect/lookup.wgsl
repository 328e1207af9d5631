// The maps of a batch, read. The shader that uses it declares `imperfect_batch`, `imperfect_samples` and `imperfect_maps`.

// Distance [m] to the surface that a sample's light ends on this way; 1e30 where there is none.
fn imperfect_end(tile: u32, way: vec3f) -> f32 {
    return imperfect_local_end(tile, imperfect_local(imperfect_samples[imperfect_batch.first + tile], way));
}

// The same of a way in the sample's own frame.
fn imperfect_local_end(tile: u32, local: vec3f) -> f32 {
    let side = imperfect_batch.side;
    if side == 0u || local.z <= 0.0 {
        return 1e30;
    }
    let held = imperfect_maps[tile * side * side + imperfect_texel(side, imperfect_place(local))];
    return select(bitcast<f32>(held), 1e30, held == IMPERFECT_NOTHING);
}
