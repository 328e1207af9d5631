// Sizes of dispatches and draws that are known beforehand: as they are, or nothing.

@group(2) @binding(4) var<storage, read> gate_sizes: array<vec4u>;

@compute @workgroup_size(1)
fn gate_open() {
    let is_shut = gate_is_shut();
    for (var i = 0u; i < arrayLength(&gate_sizes); i++) {
        for (var k = 0u; k < 4u; k++) {
            gate_arguments[4u * i + k] = select(gate_sizes[i][k], 0u, is_shut);
        }
    }
}
