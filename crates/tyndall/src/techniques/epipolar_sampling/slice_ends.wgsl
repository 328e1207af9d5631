// Stage 2: where each slice's line begins and how far its samples are apart. Empties the lists of later stages.

@group(2) @binding(1) var<storage, read_write> slice_lines: array<ScreenLine>;
@group(2) @binding(2) var<storage, read_write> slice_counts: array<u32>;
@group(2) @binding(3) var<storage, read_write> slice_dispatches: array<u32>;

@compute @workgroup_size(64)
fn slice_ends(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&slice_counts) / SAMPLING_COUNT {
        let count = SAMPLING_COUNT * id.x;
        slice_counts[count] = 0u;
        slice_counts[count + 1u] = 1u;
        slice_counts[count + 2u] = 0u;
        slice_counts[count + 3u] = 0u;
        slice_dispatches[3u * id.x] = 0u;
        slice_dispatches[3u * id.x + 1u] = 1u;
        slice_dispatches[3u * id.x + 2u] = 1u;
    }
    if id.x < sampling.slices {
        let border = screen_slice_border(sampling.arc, sampling.slices, id.x);
        slice_lines[id.x] = screen_line(frame.camera.size, sampling.epipole, border, sampling.samples);
    }
}
