// The shadow map resampled to light rays: the end of each sets a voxel (Wyman and Dai 2013, section 2.6).

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var<storage, read_write> voxels: array<atomic<u32>>;

@compute @workgroup_size(64)
fn voxelize(@builtin(global_invocation_id) id: vec3u) {
    let e = epipolar;
    let column = id.x;
    let slice = id.y;
    let alpha = e.alpha_start + (f32(slice) + 0.5) * e.alpha_step;
    let gamma = e.gamma_start + (f32(column) + 0.5) * e.gamma_step;
    let light_ray = epipolar_light_ray(e, alpha, epipolar_outward(e, alpha), gamma);
    let end = light_ray_end(shadow_line(light_ray.origin, light_ray.way));
    let row = voxel_end(e.samples, epipolar_shadow(e, gamma, end));
    if row < e.samples {
        atomicOr(&voxels[voxel_row(e.samples, slice, row) + column / 32u], 1u << (column & 31u));
    }
}
