// The maps of all samples of a batch resampled to light rays: the end of each sets a voxel of its sample's grid.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> grids: array<Epipolar>;
@group(2) @binding(3) var<storage, read> imperfect_maps: array<u32>;
@group(2) @binding(4) var<storage, read_write> voxels: array<atomic<u32>>;

// Light rays of a slice that a thread takes.
const RECTIFY_RAYS: u32 = 8u;

@compute @workgroup_size(64)
fn rectify(@builtin(global_invocation_id) id: vec3u) {
    let e = grids[imperfect_batch.first + id.z];
    let side = e.samples;
    let rays = side / RECTIFY_RAYS;
    let slice = id.x / rays;
    let first = RECTIFY_RAYS * (id.x % rays);
    let sample = imperfect_samples[imperfect_batch.first + id.z];
    let alpha = e.alpha_start + (f32(slice) + 0.5) * e.alpha_step;
    let outward = imperfect_local(sample, epipolar_outward(e, alpha));
    let axis = imperfect_local(sample, e.axis);
    for (var column = first; column < first + RECTIFY_RAYS; column++) {
        let gamma = e.gamma_start + (f32(column) + 0.5) * e.gamma_step;
        let end = imperfect_local_end(id.z, sin(gamma) * outward - cos(gamma) * axis);
        let row = voxel_end(side, epipolar_shadow(e, gamma, end));
        if row < side {
            atomicOr(&voxels[voxel_row(side, id.z * side + slice, row) + column / 32u], 1u << (column & 31u));
        }
    }
}
