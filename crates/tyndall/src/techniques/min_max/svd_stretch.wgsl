// The light of a lit stretch by the svd integrator, but for the common factor.

// Nearer to the axis than a tenth of a radian few terms do not hold exp(-sigma_t gamma / sin beta).
const SVD_LEAST_SINE: f32 = 0.1;

fn svd_stretch(e: Epipolar, r: EpipolarRay, a: f32, b: f32) -> vec3f {
    let gammas = vec2f(epipolar_gamma(r, a), epipolar_gamma(r, b));
    let beta = atan2(r.c.y, r.t.y);
    let at_beta = clamp((beta - svd.beta_start) / svd.beta_step, 0.0, f32(SVD_GRID - 1u));
    let columns = clamp((gammas - e.tint_start) / e.tint_step, vec2f(0.0), vec2f(f32(e.tint_columns)));
    var sum = vec3f(0.0);
    for (var term = 0u; term < svd.rank; term++) {
        var part = vec3f(0.0);
        if tint_is_summed() {
            part = e.tint_step * (tint_sum(e, r, term, columns.y) - tint_sum(e, r, term, columns.x));
        } else {
            part = svd_sum(svd, term, svd_place(svd, gammas.y)) - svd_sum(svd, term, svd_place(svd, gammas.x));
        }
        sum += svd_at(term, SVD_BETA, at_beta) * part;
    }
    if light_is_local() {
        return light.color * sum / max(e.distance * r.c.y, LIGHT_RADIUS);
    }
    return sum / r.c.y;
}
