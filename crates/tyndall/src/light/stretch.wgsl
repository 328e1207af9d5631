// The light that a stretch of a view ray scatters towards the eye where nothing shades it, of a light without a picture.
// The shader that uses it declares `var airlight_table: texture_2d_array<f32>`, one layer a component of the medium.

// Gauss-Legendre's four points on [-1, 1]: abscissa, weight; the other two mirror them.
const STRETCH_GAUSS = array<vec2f, 2>(
    vec2f(0.33998104358485626, 0.65214515486254614),
    vec2f(0.86113631159405258, 0.34785484513745386),
);
// Angle at the light [rad] that four points are spent on.
const STRETCH_PANEL: f32 = 0.5;

// The light's place seen from the ray.
fn stretch_light(ray: Ray) -> AirlightLight {
    let to_light = light.position - ray.origin;
    let projection = dot(to_light, ray.direction);
    return AirlightLight(projection, stretch_height(length(to_light - projection * ray.direction)));
}

// Closed forms know of no radius inside which 1 / d^2 grows no further. A ray that comes as near as h < r sees
// 2 atan(h / x) / h + 2 x / r^2 of it, x^2 = r^2 - h^2; of no radius, at this height, as much: pi / height.
fn stretch_height(h: f32) -> f32 {
    let near = clamp(h, 1e-6 * LIGHT_RADIUS, LIGHT_RADIUS);
    let x = sqrt(LIGHT_RADIUS * LIGHT_RADIUS - near * near);
    let seen = 2.0 * atan2(near, x) / near + 2.0 * x / (LIGHT_RADIUS * LIGHT_RADIUS);
    return max(h, PI / seen);
}

// Chen 2011, eq. 1 over the distances a..b [m], unshadowed: radiance [W/(m^2 sr)]. Zero where a >= b.
fn stretch_plain(ray: Ray, a: f32, b: f32) -> vec3f {
    if a >= b {
        return vec3f(0.0);
    }
    if LIGHT_KIND == LIGHT_DIRECTIONAL {
        let scattering = medium_scattering(-dot(light.direction, ray.direction));
        return light.color * scattering * transmittance_integral(frame.medium.sigma_t, a, b);
    }
    if LIGHT_KIND == LIGHT_POINT {
        return stretch_point(stretch_light(ray), vec2f(a, b));
    }
    return stretch_spot(ray, vec2f(a, b));
}

// As `stretch_plain`, of stretches so short that differences of tables are less exact than quadrature.
fn stretch_short(ray: Ray, a: f32, b: f32) -> vec3f {
    if LIGHT_KIND == LIGHT_DIRECTIONAL {
        return stretch_plain(ray, a, b);
    }
    return stretch_quadrature(ray, vec2f(a, b));
}

// A light that shines evenly: the airlight tables.
fn stretch_point(place: AirlightLight, stretch: vec2f) -> vec3f {
    var sum = vec3f(0.0);
    let count = frame_choice(frame.medium.count);
    for (var i = 0u; i < count; i++) {
        sum += frame.medium.components[i].sigma_s * airlight_segment(i, frame.medium.sigma_t, place, stretch);
    }
    return light.color * sum;
}

// A cone: as a point light inside the inner cone, by quadrature where it fades.
fn stretch_spot(ray: Ray, stretch: vec2f) -> vec3f {
    let from_light = ray.origin - light.position;
    let outer = light_cone_interval(from_light, ray.direction, light.direction, light.cos_outer, stretch);
    if outer.x >= outer.y {
        return vec3f(0.0);
    }
    let inner = light_cone_interval(from_light, ray.direction, light.direction, light.cos_inner, outer);
    if inner.x >= inner.y {
        return stretch_quadrature(ray, outer);
    }
    return stretch_point(stretch_light(ray), inner)
        + stretch_quadrature(ray, vec2f(outer.x, inner.x))
        + stretch_quadrature(ray, vec2f(inner.y, outer.y));
}

// A local light, where its cone has no kink: Gauss-Legendre over xi, s = t_p + h tan(xi) (Kulla & Fajardo 2012).
fn stretch_quadrature(ray: Ray, stretch: vec2f) -> vec3f {
    if stretch.x >= stretch.y {
        return vec3f(0.0);
    }
    let place = stretch_light(ray);
    let nearest = ray.origin + place.projection * ray.direction - light.position;
    // cos(angle to the axis) = (cos xi, sin xi) . axis
    let axis = vec2f(dot(nearest, light.direction) / place.height, dot(ray.direction, light.direction));
    let xi = atan((stretch - place.projection) / place.height);
    // A stretch may be too short for its angles to differ.
    let panels = max(ceil((xi.y - xi.x) / STRETCH_PANEL), 1.0);
    let half = 0.5 * (xi.y - xi.x) / panels;
    var sum = vec3f(0.0);
    for (var i = 0.0; i < panels; i += 1.0) {
        let middle = xi.x + (2.0 * i + 1.0) * half;
        for (var k = 0u; k < 2u; k++) {
            let offset = half * STRETCH_GAUSS[k].x;
            sum += STRETCH_GAUSS[k].y
                * (stretch_density(place, axis, middle - offset) + stretch_density(place, axis, middle + offset));
        }
    }
    return light.color * sum * half / place.height;
}

// exp(-sigma_t (s + d)) sigma_s rho falloff at xi, where s + d = t_p + h tan(pi / 4 + xi / 2).
fn stretch_density(place: AirlightLight, axis: vec2f, xi: f32) -> vec3f {
    var falloff = 1.0;
    if LIGHT_KIND == LIGHT_SPOT {
        falloff = light_spot_falloff(dot(vec2f(cos(xi), sin(xi)), axis), light.cos_inner, light.cos_outer);
    }
    let path = place.projection + place.height * tan(0.25 * PI + 0.5 * xi);
    return falloff * medium_scattering(-sin(xi)) * transmittance(frame.medium.sigma_t, path);
}

// The light of a short stretch of a light that shines evenly to all sides, by the rule of the middle over the angle at
// the light: ds / d^2 = d xi / h.
fn stretch_middle(ray: Ray, a: f32, b: f32) -> vec3f {
    let place = stretch_light(ray);
    let from_light = vec2f(a, b) - place.projection;
    let xi = atan(from_light / place.height);
    let middle = 0.5 * (xi.x + xi.y);
    let path = place.projection + place.height * tan(0.25 * PI + 0.5 * middle);
    let scattered = medium_scattering(-sin(middle)) * transmittance(frame.medium.sigma_t, path);
    return scattered * (xi.y - xi.x) / place.height;
}
