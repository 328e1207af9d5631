// The size that an earlier pass wrote: as it is, or nothing.

@group(2) @binding(4) var<storage, read> gate_written: array<u32>;
@group(2) @binding(5) var<uniform> gate_words: vec4u; // the first of the written ones, how many, the first of ours

@compute @workgroup_size(1)
fn gate_pass() {
    let is_shut = gate_is_shut();
    for (var i = 0u; i < gate_words.y; i++) {
        gate_arguments[gate_words.z + i] = select(gate_written[gate_words.x + i], 0u, is_shut);
    }
}
