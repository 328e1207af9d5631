// Where a ray is inside a spot light's cone.

// The part of the ray q0 + s v inside the cone of unit axis and half angle acos(cos_outer) < pi/2 about the origin,
// intersected with span; empty (x >= y) where it misses. v has unit length. The solid cone is convex: one interval,
// between the roots of (q . axis)^2 = cos^2 |q|^2, or beyond one of them.
fn light_cone_interval(q0: vec3f, v: vec3f, axis: vec3f, cos_outer: f32, span: vec2f) -> vec2f {
    let cos2 = cos_outer * cos_outer;
    let v_axis = dot(v, axis);
    // About the point of the ray nearest to the apex, where f32 loses least.
    let t = -dot(q0, v);
    let n = q0 + t * v;
    let n_axis = dot(n, axis);
    let a = v_axis * v_axis - cos2;
    let b = n_axis * v_axis;
    let c = n_axis * n_axis - cos2 * dot(n, n);
    let discriminant = b * b - a * c;
    if discriminant <= 0.0 {
        return span.xx;
    }
    // Citardauq keeps both roots exact where a is near zero.
    let w = -(b + select(-1.0, 1.0, b >= 0.0) * sqrt(discriminant));
    let r0 = select(w / a, sign(w) * 1e30, abs(a) < 1e-12);
    let r1 = c / w;
    let roots = vec2f(min(r0, r1), max(r0, r1));
    if a < 0.0 {
        if n_axis + 0.5 * (roots.x + roots.y) * v_axis <= 0.0 {
            return span.xx;
        }
        return vec2f(max(span.x, roots.x + t), min(span.y, roots.y + t));
    }
    if v_axis > 0.0 {
        return vec2f(max(span.x, roots.y + t), span.y);
    }
    return vec2f(span.x, min(span.y, roots.x + t));
}
