//! Ray against triangle, watertight.

use glam::{DVec3, Vec3};

use crate::view::Ray;

/// A ray prepared for triangles: the transform that takes it to the z axis
/// (Woop, Benthin & Wald 2013, "Watertight ray/triangle intersection").
///
/// Edge functions of a shared edge are exact negatives of each other. Where one is zero, the edge belongs to one of
/// its two triangles by its direction, as in a rasteriser: a ray through an edge or a corner of a closed surface hits
/// exactly one of the triangles that meet there, so that glass isn't counted twice.
pub(super) struct TriangleRay {
    origin: DVec3,
    axes: [usize; 3],
    shear: DVec3,
}

/// The point where a ray meets a triangle.
pub(super) struct Crossing {
    /// Distance along the ray \[m].
    pub(super) distance: f64,
    /// Weights of the corners; they add up to 1.
    pub(super) weights: DVec3,
}

impl TriangleRay {
    pub(super) fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let z = d.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        Self {
            origin: ray.origin,
            axes: [x, y, z],
            shear: DVec3::new(d[x], d[y], 1.0) / d[z],
        }
    }

    /// The crossing with a triangle, at any distance; `None` if they miss or the triangle is degenerate.
    pub(super) fn meet(&self, corners: &[Vec3; 3]) -> Option<Crossing> {
        let [a, b, c] = corners.map(|p| self.sheared(p));
        let edge = |p: DVec3, q: DVec3| q.x * p.y - q.y * p.x;
        let functions = DVec3::new(edge(b, c), edge(c, a), edge(a, b));
        let area = functions.element_sum();
        if area == 0.0 {
            return None;
        }
        let sign = area.signum();
        let inside = |function: f64, from: DVec3, to: DVec3| {
            let along = sign * (to - from);
            sign * function > 0.0
                || function == 0.0 && (along.y > 0.0 || along.y == 0.0 && along.x > 0.0)
        };
        let hit =
            inside(functions.x, b, c) && inside(functions.y, c, a) && inside(functions.z, a, b);
        hit.then(|| {
            let weights = functions / area;
            Crossing {
                distance: weights.dot(DVec3::new(a.z, b.z, c.z)),
                weights,
            }
        })
    }

    fn sheared(&self, point: Vec3) -> DVec3 {
        let q = point.as_dvec3() - self.origin;
        let [x, y, z] = self.axes;
        DVec3::new(
            q[x] - self.shear.x * q[z],
            q[y] - self.shear.y * q[z],
            self.shear.z * q[z],
        )
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    /// A fan of triangles round a corner, with edges along and across the axes.
    fn fan() -> Vec<[Vec3; 3]> {
        let hub = vec3(0.25, 0.5, 0.0);
        let rim = [
            vec3(1.25, 0.5, 0.0),
            vec3(1.25, 1.5, 0.1),
            vec3(0.25, 1.5, 0.0),
            vec3(-1.0, 1.5, -0.2),
            vec3(-1.0, 0.5, 0.0),
            vec3(-1.0, -0.5, 0.3),
            vec3(0.25, -0.5, 0.0),
            vec3(1.25, -0.5, 0.0),
        ];
        (0..8)
            .map(|i| {
                let (p, q) = (rim[i], rim[(i + 1) % 8]);
                // Neighbours of either winding must agree as well.
                if i % 3 == 0 { [hub, q, p] } else { [p, q, hub] }
            })
            .collect()
    }

    #[test]
    fn edges_and_corners_belong_to_exactly_one_triangle() {
        let fan = fan();
        for direction in [
            DVec3::NEG_Z,
            DVec3::Z,
            DVec3::new(0.0, 0.25, -1.0),
            DVec3::new(0.5, 0.0, 1.0),
        ] {
            for (x, y) in [
                (0.25, 0.5),
                (0.75, 0.5),
                (0.25, 1.0),
                (0.25, 0.0),
                (0.5, 0.75),
                (0.0, 0.5),
            ] {
                let target = DVec3::new(x, y, 0.0);
                let ray = Ray {
                    origin: target - 4.0 * direction,
                    direction,
                };
                let prepared = TriangleRay::new(&ray);
                let hits: Vec<_> = fan.iter().filter_map(|t| prepared.meet(t)).collect();
                assert_eq!(hits.len(), 1, "towards {direction} at {target}");
            }
        }
    }

    #[test]
    fn distance_and_weights_are_those_of_the_point() {
        let corners = [
            vec3(1.0, 0.0, 2.0),
            vec3(0.0, 3.0, 2.5),
            vec3(-1.0, -1.0, 4.0),
        ];
        let weights = DVec3::new(0.2, 0.5, 0.3);
        let point: DVec3 = (0..3).map(|i| weights[i] * corners[i].as_dvec3()).sum();
        for origin in [
            DVec3::ZERO,
            DVec3::new(5.0, 1.0, -3.0),
            DVec3::new(0.1, 0.2, 9.0),
        ] {
            let ray = Ray {
                origin,
                direction: (point - origin).normalize(),
            };
            let crossing = TriangleRay::new(&ray).meet(&corners).unwrap();
            assert!((crossing.distance - (point - origin).length()).abs() < 1e-13);
            assert!((crossing.weights - weights).length() < 1e-13);
        }
    }

    #[test]
    fn degenerate_triangles_are_missed() {
        let ray = Ray {
            origin: DVec3::NEG_Z,
            direction: DVec3::Z,
        };
        let prepared = TriangleRay::new(&ray);
        for corners in [
            [Vec3::ZERO; 3],
            [Vec3::X, Vec3::NEG_X, Vec3::ZERO],
            [Vec3::X, Vec3::X, Vec3::NEG_X],
        ] {
            assert!(prepared.meet(&corners).is_none());
        }
    }
}
