// Stage 5: the list of samples to march, those that are their own source. In order within a group, so that neighbours in
// the list are neighbours on the picture.

const MARK_GROUP: u32 = 256u;

@group(2) @binding(1) var<storage, read> mark_depth: array<f32>;
@group(2) @binding(2) var<storage, read> mark_sources: array<u32>;
@group(2) @binding(3) var<storage, read_write> mark_list: array<u32>;
@group(2) @binding(4) var<storage, read_write> mark_counts: array<atomic<u32>>;
@group(2) @binding(5) var<storage, read_write> mark_dispatches: array<atomic<u32>>;

var<workgroup> mark_bits: array<atomic<u32>, 8>;
var<workgroup> mark_start: u32;

@compute @workgroup_size(256)
fn mark(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) index: u32) {
    if index < 8u {
        atomicStore(&mark_bits[index], 0u);
    }
    workgroupBarrier();
    let sample = group.x * MARK_GROUP + index;
    let here = group.y * sampling.samples + sample;
    let is_own = sample < sampling.samples && mark_depth[here] >= 0.0 && (mark_sources[here] & 0xffffu) == sample;
    if is_own {
        atomicOr(&mark_bits[index / 32u], 1u << (index % 32u));
    }
    workgroupBarrier();
    if index == 0u {
        var count = 0u;
        for (var i = 0u; i < 8u; i++) {
            count += countOneBits(atomicLoad(&mark_bits[i]));
        }
        mark_start = 0u;
        if count > 0u {
            mark_start = atomicAdd(&mark_counts[0], count);
            atomicMax(&mark_dispatches[0], (mark_start + count + MARCH_GROUP - 1u) / MARCH_GROUP);
        }
    }
    workgroupBarrier();
    if is_own {
        var before = countOneBits(atomicLoad(&mark_bits[index / 32u]) & ((1u << (index % 32u)) - 1u));
        for (var i = 0u; i < index / 32u; i++) {
            before += countOneBits(atomicLoad(&mark_bits[i]));
        }
        mark_list[mark_start + before] = here;
    }
}
