// The maps of all samples of a batch resampled to light rays: the end of each sets a voxel of its sample's grid.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> grids: array<Epipolar>;
@group(2) @binding(3) var<storage, read> imperfect_maps: array<u32>;
@group(2) @binding(4) var<storage, read_write> voxels: array<u32>;

// A thread takes the light rays of a slice whose voxels share their words: no other writes those.
@compute @workgroup_size(64)
fn rectify(@builtin(global_invocation_id) id: vec3u) {
    let e = grids[imperfect_batch.first + id.z];
    let side = e.samples;
    let words = side / 32u;
    let slice = id.x / words;
    let word = id.x % words;
    let sample = imperfect_samples[imperfect_batch.first + id.z];
    let alpha = e.alpha_start + (f32(slice) + 0.5) * e.alpha_step;
    let outward = imperfect_local(sample, epipolar_outward(e, alpha));
    let axis = imperfect_local(sample, e.axis);
    for (var bit = 0u; bit < 32u; bit++) {
        let gamma = e.gamma_start + (f32(32u * word + bit) + 0.5) * e.gamma_step;
        let end = imperfect_local_end(id.z, sin(gamma) * outward - cos(gamma) * axis);
        let row = voxel_end(side, epipolar_shadow(e, gamma, end));
        if row < side {
            voxels[voxel_row(side, id.z * side + slice, row) + word] |= 1u << bit;
        }
    }
}
