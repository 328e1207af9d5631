// Third pass of the adaptive mesh: lists its triangles, and says how much there is to draw.

// A triangle: column (13 bits), row (13), which of the four round it (2), face (3).
@group(2) @binding(2) var<storage, read_write> light_volume_triangles: array<u32>;
@group(2) @binding(3) var<storage, read_write> light_volume_counts: LightVolumeCounts;

// Two draws' arguments, and what they come from.
struct LightVolumeCounts {
    adaptive_vertices: u32,
    adaptive_instances: u32,
    adaptive_first: vec2u,
    full_vertices: u32,
    full_instances: u32,
    full_first: vec2u,
    listing: atomic<u32>, // triangles listed so far; 0 between frames
    triangles: u32, // of the adaptive mesh, listed or not
}

// Bit k: the triangle between neighbours k and k + 1 of a vertex is part of the mesh.
fn light_volume_leaves(face: u32, vertex: vec2u) -> u32 {
    if any(vertex > light_volume.cells) {
        return 0u;
    }
    let spacing = light_volume_spacing(vertex);
    let is_edge = light_volume_is_edge(vertex, spacing);
    var leaves = 0u;
    for (var k = 0u; k < 4u; k++) {
        let a = vec2i(vertex) + light_volume_neighbor(k, spacing, is_edge);
        let b = vec2i(vertex) + light_volume_neighbor(k + 1u, spacing, is_edge);
        let is_inside = all(min(a, b) >= vec2i(0)) && all(max(a, b) <= vec2i(light_volume.cells));
        let is_smallest = is_edge && spacing == 1u;
        leaves |= u32(is_inside && (is_smallest || !light_volume_is_split(face, (a + b) / 2))) << k;
    }
    return leaves;
}

@compute @workgroup_size(64)
fn light_volume_list(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= light_volume.pitch {
        return;
    }
    let word = atomicLoad(&light_volume_splits[light_volume_word(id.z, vec2u(32u * id.x, id.y))]);
    var count = 0u;
    for (var rest = word; rest != 0u; rest &= rest - 1u) {
        count += countOneBits(light_volume_leaves(id.z, vec2u(32u * id.x + firstTrailingBit(rest), id.y)));
    }
    if count == 0u {
        return;
    }
    var slot = atomicAdd(&light_volume_counts.listing, count);
    if slot + count > light_volume.capacity {
        return;
    }
    for (var rest = word; rest != 0u; rest &= rest - 1u) {
        let vertex = vec2u(32u * id.x + firstTrailingBit(rest), id.y);
        let name = vertex.x | (vertex.y << 13u) | (id.z << 28u);
        for (var leaves = light_volume_leaves(id.z, vertex); leaves != 0u; leaves &= leaves - 1u) {
            light_volume_triangles[slot] = name | (firstTrailingBit(leaves) << 26u);
            slot++;
        }
    }
}

// The full mesh where the list is too short for the adaptive one.
@compute @workgroup_size(1)
fn light_volume_choose() {
    let count = atomicExchange(&light_volume_counts.listing, 0u);
    light_volume_counts.triangles = count;
    let fits = count <= light_volume.capacity;
    light_volume_counts.adaptive_vertices = select(0u, 3u * count, fits);
    light_volume_counts.adaptive_instances = 1u;
    light_volume_counts.full_vertices = 2u * (light_volume.cells.x + 1u);
    light_volume_counts.full_instances = select(select(1u, 6u, SHADOW_KIND == SHADOW_CUBE) * light_volume.cells.y, 0u, fits);
}
