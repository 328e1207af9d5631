// What a technique does before its last pass, done only where any pixel is stale, or the shadow map another one.

@group(2) @binding(1) var<storage, read> gate_state: ReuseSettled;
@group(2) @binding(2) var<storage, read> gate_blocks: array<vec2f>;
@group(2) @binding(3) var<storage, read_write> gate_arguments: array<u32>;

// Whether nothing needs be done.
fn gate_is_shut() -> bool {
    if gate_state.mode != REUSE_MASKED || gate_state.stale > 0u {
        return false;
    }
    if reuse.faces > 0u {
        let coarsest = blocks_start(reuse.levels - 1u);
        for (var face = 0u; face < reuse.faces; face++) {
            let range = gate_blocks[coarsest + face];
            if range.x <= range.y {
                return false;
            }
        }
    }
    return true;
}
