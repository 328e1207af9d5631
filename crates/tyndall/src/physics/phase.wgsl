// Phase functions of cos(theta), the cosine between the way light travels and the way it is scattered [1/sr].

const PI: f32 = 3.14159265358979;

fn phase_isotropic() -> f32 {
    return 1.0 / (4.0 * PI);
}

// Rayleigh 1871.
fn phase_rayleigh(cos_theta: f32) -> f32 {
    return 3.0 / (16.0 * PI) * (1.0 + cos_theta * cos_theta);
}

// Henyey & Greenstein 1941. The base is (1 - g)^2 + 2 g (1 - cos): no cancellation as g and cos near 1.
fn phase_hg(g: f32, cos_theta: f32) -> f32 {
    let base = max((1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cos_theta), 1e-12);
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}
