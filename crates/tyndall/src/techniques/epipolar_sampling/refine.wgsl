// Stage 4: from which two samples of its slice each sample is interpolated (Yusov 2012, section 6.2). Sections of
// `initial_step` samples are cut where neighbours differ; a bit a sample says so. Stage 5: the list of samples to march,
// those that are their own source. In order within a group, so that neighbours in the list are neighbours on the picture.

const REFINE_GROUP: u32 = 256u;
// Sections at the epipole are this many times shorter.
const REFINE_DENSER: u32 = 4u;

@group(2) @binding(1) var<storage, read> refine_lines: array<ScreenLine>;
@group(2) @binding(2) var<storage, read> refine_depth: array<f32>;
// First and second source in 16 bits each.
@group(2) @binding(3) var<storage, read_write> refine_sources: array<u32>;
@group(2) @binding(4) var airlight_table: texture_2d_array<f32>;
@group(2) @binding(5) var<storage, read_write> refine_list: array<u32>;
@group(2) @binding(6) var<storage, read_write> refine_counts: array<atomic<u32>>;
@group(2) @binding(7) var<storage, read_write> refine_dispatches: array<atomic<u32>>;

// Bit i: sample i of the group and the next one differ.
var<workgroup> refine_breaks: array<atomic<u32>, 8>;
// Bit i: sample i of the group is marched.
var<workgroup> refine_marks: array<atomic<u32>, 8>;
var<workgroup> refine_start: u32;

@compute @workgroup_size(256)
fn refine(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) index: u32) {
    if index < 8u {
        atomicStore(&refine_breaks[index], 0u);
        atomicStore(&refine_marks[index], 0u);
    }
    workgroupBarrier();
    let sample = group.x * REFINE_GROUP + index;
    let here = group.y * sampling.samples + sample;
    let is_last = sample + 1u >= sampling.samples;
    if !is_last && refine_differ(group.y, sample, refine_depth[here], refine_depth[here + 1u]) {
        atomicOr(&refine_breaks[index / 32u], 1u << (index % 32u));
    }
    workgroupBarrier();
    var is_own = false;
    if sample < sampling.samples {
        let sources = refine_search(group.x * REFINE_GROUP, sample);
        refine_sources[here] = sources;
        is_own = refine_depth[here] >= 0.0 && (sources & 0xffffu) == sample;
    }
    if is_own {
        atomicOr(&refine_marks[index / 32u], 1u << (index % 32u));
    }
    workgroupBarrier();
    if index == 0u {
        refine_start = refine_reserve();
    }
    workgroupBarrier();
    if is_own {
        refine_list[refine_start + refine_marks_before(index)] = here;
    }
}

// Room in the list for the group's marks: where it starts.
fn refine_reserve() -> u32 {
    let count = refine_marks_before(REFINE_GROUP);
    var start = 0u;
    if count > 0u {
        start = atomicAdd(&refine_counts[0], count);
        atomicMax(&refine_dispatches[0], (start + count + MARCH_GROUP - 1u) / MARCH_GROUP);
    }
    return start;
}

// How many samples of the group before one are marked.
fn refine_marks_before(index: u32) -> u32 {
    var before = 0u;
    for (var i = 0u; i < index / 32u; i++) {
        before += countOneBits(atomicLoad(&refine_marks[i]));
    }
    if index % 32u > 0u {
        before += countOneBits(atomicLoad(&refine_marks[index / 32u]) & ((1u << (index % 32u)) - 1u));
    }
    return before;
}

fn refine_differ(slice: u32, sample: u32, depth: f32, next: f32) -> bool {
    if depth < 0.0 || next < 0.0 {
        return depth != next;
    }
    if frame_choice(sampling.criterion) == SAMPLING_CRITERION_DEPTH {
        return abs(depth - next) > sampling.threshold * min(depth, next);
    }
    let line = refine_lines[slice];
    var seen: array<vec3f, 2>;
    for (var i = 0u; i < 2u; i++) {
        let place = line.entry + f32(sample + i) * line.step;
        seen[i] = unshadowed(camera_ray_to(place, select(depth, next, i == 1u)));
    }
    return any(abs(seen[0] - seen[1]) > sampling.threshold * max(seen[0], seen[1]));
}

// The ends of the section that a sample lies in, cut by the breaks on either side.
fn refine_search(group_start: u32, sample: u32) -> u32 {
    var section = sampling.initial_step;
    if sample < section && screen_epipole_is_inside(frame.camera.size, sampling.epipole) {
        section = max(section / REFINE_DENSER, 1u);
    }
    let start = sample - sample % section;
    let end = min(start + section, sampling.samples - 1u);
    if sample == start || sample == end {
        return sample | (sample << 16u);
    }
    let first = refine_last_break(start - group_start, sample - group_start) + group_start;
    let second = refine_next_break(sample - group_start, end - group_start) + group_start;
    if sample == first || sample == second {
        return sample | (sample << 16u);
    }
    return first | (second << 16u);
}

// The sample behind the last break before a sample, or the start.
fn refine_last_break(start: u32, sample: u32) -> u32 {
    var word = (sample - 1u) / 32u;
    var bits = atomicLoad(&refine_breaks[word]) & (0xffffffffu >> (31u - (sample - 1u) % 32u));
    while bits == 0u && word > start / 32u {
        word--;
        bits = atomicLoad(&refine_breaks[word]);
    }
    return max(start, select(start, 32u * word + firstLeadingBit(bits) + 1u, bits != 0u));
}

// The sample before the next break from a sample on, or the end.
fn refine_next_break(sample: u32, end: u32) -> u32 {
    var word = sample / 32u;
    var bits = atomicLoad(&refine_breaks[word]) & (0xffffffffu << (sample % 32u));
    while bits == 0u && word < (end - 1u) / 32u {
        word++;
        bits = atomicLoad(&refine_breaks[word]);
    }
    return min(end, select(end, 32u * word + firstTrailingBit(bits), bits != 0u));
}
