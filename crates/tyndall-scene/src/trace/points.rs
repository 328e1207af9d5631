//! The surfaces that block light as points.

use std::f64::consts::PI;

use glam::DVec3;

use super::tracer::{Hit, Tracer};

/// The ratios of a sequence that fills the unit cube evenly, any stretch of it (Roberts 2018): powers of 1 / x, where
/// x^4 = x + 1.
const RATIOS: [f64; 3] = [
    0.819_172_513_396_164_5,
    0.671_043_606_703_789_3,
    0.549_700_477_901_970_3,
];

impl Tracer {
    /// `count` points spread evenly over the area of all surfaces that block light, those before holes of alpha-tested
    /// surfaces left out: world-space position and, last, the radius of the disc each stands for \[m]. Points that follow
    /// each other are spread evenly, too. Empty where nothing blocks light.
    pub fn point_cloud(&self, count: u32) -> Vec<[f32; 4]> {
        let blockers = |t: &usize| self.surface(*t).can_block();
        let triangles: Vec<usize> = (0..self.geometry.len()).filter(blockers).collect();
        let mut area = 0.0;
        let areas_up_to = |t: &usize| {
            let [a, b, c] = self.geometry.positions[*t].map(|p| p.as_dvec3());
            area += 0.5 * (b - a).cross(c - a).length();
            area
        };
        let up_to: Vec<f64> = triangles.iter().map(areas_up_to).collect();
        let whole = up_to.last().copied().unwrap_or(0.0);
        if whole <= 0.0 {
            return Vec::new();
        }
        let radius = (whole / (PI * f64::from(count))).sqrt();
        let point = |i: u32| {
            let [place, u, v] = RATIOS.map(|ratio| (0.5 + f64::from(i) * ratio).fract());
            let index = up_to.partition_point(|area| *area <= place * whole);
            let triangle = triangles[index.min(triangles.len() - 1)];
            // Even over a triangle (Turk 1990).
            let root = u.sqrt();
            let weights = DVec3::new(1.0 - root, root * (1.0 - v), root * v);
            let hit = Hit {
                distance: 0.0,
                triangle,
                weights,
            };
            let corners = self.geometry.positions[triangle].map(|p| p.as_dvec3());
            let position: DVec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
            self.blocks(&hit)
                .then(|| position.extend(radius).as_vec4().to_array())
        };
        (0..count).filter_map(point).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec3, vec3};

    use super::*;
    use crate::test_scenes::{opaque, quad};

    /// Any stretch of a cloud over two squares, one of twice the other's edge, holds them four to one, and its boxes evenly.
    #[test]
    fn points_are_even_over_the_area() {
        let mut soup = quad(Vec3::ZERO, Vec3::X, Vec3::Z).to_vec();
        soup.extend(quad(vec3(0.0, 5.0, 0.0), 2.0 * Vec3::X, 2.0 * Vec3::Z));
        let tracer = Tracer::new(&opaque(&soup));
        let cloud = tracer.point_cloud(40_000);
        assert_eq!(cloud.len(), 40_000);
        for stretch in cloud.chunks(4_000) {
            let low = stretch.iter().filter(|p| p[1] < 1.0).count() as f64;
            assert!((low - 800.0).abs() < 20.0, "{low}");
            let in_box = |x: f32, z: f32| {
                let near = |a: f32, b: f32| (a - b).abs() <= 0.25;
                let inside = |p: &&[f32; 4]| p[1] > 1.0 && near(p[0], x) && near(p[2], z);
                stretch.iter().filter(inside).count() as f64
            };
            for i in 0..16 {
                let [x, z] = [i % 4, i / 4].map(|k| 0.25 + 0.5 * k as f32);
                // 200 each. Largest difference measured: 11.
                assert!((in_box(x, z) - 200.0).abs() < 20.0, "{}", in_box(x, z));
            }
        }
        let area: f64 = cloud.iter().map(|p| PI * f64::from(p[3]).powi(2)).sum();
        assert!((area - 5.0).abs() < 1e-3, "{area}");
    }

    #[test]
    fn nothing_has_no_points() {
        assert!(Tracer::new(&opaque(&[])).point_cloud(100).is_empty());
    }
}
