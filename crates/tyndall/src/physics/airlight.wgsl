// Airlight of an unshadowed point light, per channel; see airlight.rs, which makes the table. The shader that uses it
// declares `var airlight_table: texture_2d_array<f32>`, one layer a phase function.

// A point light seen from a view ray: distance along the ray of the point nearest to it, and its distance from there [m].
struct AirlightLight {
    projection: f32,
    height: f32,
}

fn airlight_distance(light: AirlightLight, s: f32) -> f32 {
    return length(vec2f(s - light.projection, light.height));
}

// tan(phi / 2) = (s - t_p + d) / h, without cancellation before the light.
fn airlight_tangent(light: AirlightLight, s: f32) -> f32 {
    let x = s - light.projection;
    let d = airlight_distance(light, s);
    return select(light.height / (d - x), (x + d) / light.height, x > 0.0);
}

// x with x^2 (3 - 2 x) = v / (1 + v), for v >= 0. The arc sine of (1 - v) / (1 + v), as a tangent's, for arc sines are
// coarse.
fn airlight_axis(v: f32) -> f32 {
    return 0.5 - sin(PI / 6.0 - 2.0 / 3.0 * atan(sqrt(v)));
}

fn airlight_far_length(t: f32) -> f32 {
    return (1.0 + t * t) * atan(1.0 / t);
}

// near and far at (u, T).
fn airlight_near_and_far(layer: u32, u: f32, t: f32) -> vec2f {
    // Beyond 1e6 both are as at infinity, and T^2 stays finite.
    let length = airlight_far_length(min(t, 1e6));
    let size = vec2f(textureDimensions(airlight_table)) - 1.0;
    let place = vec2f(airlight_axis(t), airlight_axis(u * length)) * size;
    let cell = min(floor(place), size - 1.0);
    let f = place - cell;
    let c = vec2u(cell);
    let top = mix(
        textureLoad(airlight_table, c, layer, 0).rg,
        textureLoad(airlight_table, c + vec2u(1u, 0u), layer, 0).rg,
        f.x,
    );
    let bottom = mix(
        textureLoad(airlight_table, c + vec2u(0u, 1u), layer, 0).rg,
        textureLoad(airlight_table, c + vec2u(1u, 1u), layer, 0).rg,
        f.x,
    );
    let t2 = 1.0 + min(t, 1e6) * min(t, 1e6);
    let scale = vec2f(
        transmittance_integral(vec3f(u), 0.0, t).x,
        2.0 * length / (t2 * (1.0 + u * length)),
    );
    return scale * mix(top, bottom, f.y);
}

// Integral of exp(-sigma_t (s + d)) rho / d^2 over the distances a..b = stretch of a ray, one channel.
fn airlight_channel(layer: u32, sigma_t: f32, light: AirlightLight, stretch: vec2f) -> f32 {
    let u = sigma_t * light.height;
    let a = airlight_near_and_far(layer, u, airlight_tangent(light, stretch.x));
    let b = airlight_near_and_far(layer, u, airlight_tangent(light, stretch.y));
    let far_a = exp(-sigma_t * (stretch.x + airlight_distance(light, stretch.x))) * a.y;
    let far_b = exp(-sigma_t * (stretch.y + airlight_distance(light, stretch.y))) * b.y;
    let to_light = exp(-sigma_t * max(light.projection, 0.0));
    if stretch.y <= light.projection && to_light * b.x < far_a {
        return to_light * (b.x - a.x) / light.height;
    }
    return (far_a - far_b) / light.height;
}

fn airlight_segment(layer: u32, sigma_t: vec3f, light: AirlightLight, stretch: vec2f) -> vec3f {
    let is_gray = frame_choice(u32(all(sigma_t == sigma_t.rrr))) == 1u;
    if is_gray {
        return vec3f(airlight_channel(layer, sigma_t.r, light, stretch));
    }
    return vec3f(
        airlight_channel(layer, sigma_t.r, light, stretch),
        airlight_channel(layer, sigma_t.g, light, stretch),
        airlight_channel(layer, sigma_t.b, light, stretch),
    );
}
