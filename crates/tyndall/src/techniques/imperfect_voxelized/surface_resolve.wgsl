// The share of a light that reaches the surfaces, of what was added up for each pixel.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<uniform> ivsv: IvsvParams;
@group(2) @binding(2) var<storage, read> ivsv_lit: array<vec4f>;
@group(2) @binding(3) var<storage, read> ivsv_all: array<vec4f>;

@fragment
fn ivsv_surface_resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let length = frame_ray(position).length;
    var lit = vec3f(0.0);
    var all = vec3f(0.0);
    for (var i = 0u; i < 9u; i++) {
        let tap = ivsv_tap(vec2u(position.xy), length, i);
        lit += tap.weight * ivsv_lit[tap.index].rgb;
        all += tap.weight * ivsv_all[tap.index].rgb;
    }
    // Where there is no light, nothing blocks it.
    return vec4f(select(saturate(lit / max(all, vec3f(1e-30))), vec3f(1.0), all <= vec3f(1e-30)), 1.0);
}
