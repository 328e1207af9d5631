//! The part of a ray that is inside a spot light's cone.

/// The part of the ray `q0 + s v` inside the cone of unit `axis` and half angle acos(`cos_outer`) <= pi/2 about the
/// origin, intersected with `[a, b]`; empty (`a >= b`) where it misses. `v` has unit length.
///
/// The solid cone is convex, so there is one interval: between the two roots of
/// `(q . axis)^2 = cos^2 |q|^2` where the ray crosses the cone sideways, else beyond one of them. About the point n of the
/// ray nearest to the apex n . v = 0, and the discriminant is `cos^2 ((n . axis)^2 + |n|^2 ((v . axis)^2 - cos^2))`: nothing
/// cancels as the cone widens to a half space, whose border is a double root.
pub fn cone_interval(
    q0: glam::DVec3,
    v: glam::DVec3,
    axis: glam::DVec3,
    cos_outer: f64,
    [a, b]: [f64; 2],
) -> [f64; 2] {
    let cos2 = cos_outer * cos_outer;
    let v_axis = v.dot(axis);
    let t = -q0.dot(v);
    let n = q0 + t * v;
    let n_axis = n.dot(axis);
    let qa = v_axis * v_axis - cos2;
    let qb = n_axis * v_axis;
    let qc = n_axis * n_axis - cos2 * n.length_squared();
    let beside = n_axis * n_axis + n.length_squared() * qa;
    if beside < 0.0 {
        return [a, a];
    }
    if v_axis == 0.0 && cos_outer == 0.0 {
        return if n_axis > 0.0 { [a, b] } else { [a, a] };
    }
    // Citardauq keeps both roots exact where qa is near zero; through the apex both are 0.
    let w = -(qb + qb.signum() * cos_outer * beside.sqrt());
    let [r0, r1] = if w == 0.0 { [0.0; 2] } else { [w / qa, qc / w] };
    let (low, high) = (r0.min(r1), r0.max(r1));
    let (from, to) = if qa < 0.0 {
        let middle = 0.5 * (low + high);
        if n_axis + middle * v_axis <= 0.0 {
            return [a, a];
        }
        (low + t, high + t)
    } else if v_axis > 0.0 {
        (high + t, f64::INFINITY)
    } else {
        (f64::NEG_INFINITY, low + t)
    };
    [from.max(a), to.min(b)]
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;
    use crate::light::model::fade;
    use glam::DVec3;

    /// A small linear congruential sequence in [-1, 1].
    fn sequence() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn agrees_with_the_angle_at_every_point() {
        let mut next = sequence();
        let mut inside_seen = 0;
        for i in 0..4000 {
            let mut vector = || DVec3::new(next(), next(), next());
            let (q0, v, axis) = (3.0 * vector(), vector().normalize(), vector().normalize());
            // One in eight is as wide as a half space, one is not by a hair.
            let cos_outer = match i % 8 {
                0 => fade(0.0, FRAC_PI_2)[1],
                1 => fade(0.0, FRAC_PI_2.next_down())[1],
                _ => (0.05 + 1.52 * (0.5 + 0.5 * next())).cos(),
            };
            let [a, b] = cone_interval(q0, v, axis, cos_outer, [0.0, 10.0]);
            for i in 0..50 {
                let s = 0.2 * f64::from(i) + 0.1;
                let q = q0 + s * v;
                let margin = q.dot(axis) - cos_outer * q.length();
                if margin.abs() > 1e-9 {
                    assert_eq!(s > a && s < b, margin > 0.0, "s {s}, [{a}, {b}], {margin}");
                    inside_seen += i32::from(margin > 0.0);
                }
            }
        }
        assert!(
            inside_seen > 10_000,
            "only {inside_seen} points inside a cone"
        );
    }

    #[test]
    fn a_half_space_is_bounded_by_a_plane() {
        let inside =
            |q0: DVec3, v: DVec3| cone_interval(q0, v.normalize(), DVec3::Y, 0.0, [0.0, 9.0]);
        let empty = |[a, b]: [f64; 2]| a >= b;
        // Along the plane, at either side of it and on it.
        assert_eq!(inside(DVec3::Y, DVec3::X), [0.0, 9.0]);
        assert!(empty(inside(-DVec3::Y, DVec3::X)));
        assert!(empty(inside(DVec3::X, DVec3::X)));
        // Across it: beside the apex, through it, and by an angle so small that its square is lost.
        assert_eq!(inside(DVec3::new(3.0, -2.0, 1.0), DVec3::Y), [2.0, 9.0]);
        assert_eq!(inside(-2.0 * DVec3::Y, DVec3::Y), [2.0, 9.0]);
        assert_eq!(inside(2.0 * DVec3::Y, -DVec3::Y), [0.0, 2.0]);
        let [a, b] = inside(DVec3::new(0.0, -1e-9, 2.0), DVec3::new(1.0, 1e-9, 0.0));
        assert!((a - 1.0).abs() < 1e-12 && b == 9.0, "{a}");
    }
}
