// The svd integrator: the integrand without visibility as a sum of products of a function of the view ray and one of
// the light ray (Chen 2011, section 3.2, eq. 5 and 6); see svd.rs.

// Samples of a factor.
const SVD_GRID: u32 = 64u;
// B, Gamma, and the integral of Gamma from the first sample.
const SVD_BETA: u32 = 0u;
const SVD_GAMMA: u32 = 1u;
const SVD_SUM: u32 = 2u;

// Where the samples lie [rad; gamma of the sun: m].
struct Svd {
    beta_start: f32,
    beta_step: f32,
    gamma_start: f32,
    gamma_step: f32,
    rank: u32,
}

fn svd_place(svd: Svd, gamma: f32) -> f32 {
    return clamp((gamma - svd.gamma_start) / svd.gamma_step, 0.0, f32(SVD_GRID - 1u));
}

fn svd_factor(term: u32, kind: u32, sample: u32) -> vec3f {
    return svd_factors[(3u * term + kind) * SVD_GRID + sample].rgb;
}

// B or Gamma between samples.
fn svd_at(term: u32, kind: u32, place: f32) -> vec3f {
    let sample = min(u32(place), SVD_GRID - 2u);
    return mix(svd_factor(term, kind, sample), svd_factor(term, kind, sample + 1u), place - f32(sample));
}

// The integral of Gamma from the first sample.
fn svd_sum(svd: Svd, term: u32, place: f32) -> vec3f {
    let sample = min(u32(place), SVD_GRID - 2u);
    let t = place - f32(sample);
    let start = svd_factor(term, SVD_GAMMA, sample);
    let end = svd_factor(term, SVD_GAMMA, sample + 1u);
    return svd_factor(term, SVD_SUM, sample) + svd.gamma_step * t * mix(start, end, 0.5 * t);
}
