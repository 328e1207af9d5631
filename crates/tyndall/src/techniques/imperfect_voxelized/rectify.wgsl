// The maps of all samples of a batch resampled to light rays: the end of each sets a voxel of its sample's grid.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> grids: array<Epipolar>;
@group(2) @binding(3) var<storage, read> imperfect_maps: array<u32>;
@group(2) @binding(4) var<storage, read_write> voxels: array<atomic<u32>>;

@compute @workgroup_size(64)
fn rectify(@builtin(global_invocation_id) id: vec3u) {
    let e = grids[imperfect_batch.first + id.z];
    let side = e.samples;
    let alpha = e.alpha_start + (f32(id.y) + 0.5) * e.alpha_step;
    let gamma = e.gamma_start + (f32(id.x) + 0.5) * e.gamma_step;
    let way = sin(gamma) * epipolar_outward(e, alpha) - cos(gamma) * e.axis;
    let row = voxel_end(side, epipolar_shadow(e, gamma, imperfect_end(id.z, way)));
    if row < side {
        atomicOr(&voxels[voxel_row(side, id.z * side + id.y, row) + id.x / 32u], 1u << (id.x & 31u));
    }
}
