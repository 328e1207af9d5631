//! Shadow maps by ray casting.

use tyndall::{
    cpu::{Progress, ShadowMap},
    frame::{Emitter, ShadowProjection},
};

use super::{
    map_rays::{MapRays, Texel},
    tracer::Tracer,
};

impl Tracer {
    /// The light's shadow map, `size` texels a face: in each texel the stored depth (clip z / w) of the first opaque surface
    /// between the near and the far plane that its centre meets, where the surface's plane is nearest to the light within the
    /// texel; the far plane's where there is none. It has no texels where
    /// a cube is asked for of a light that has no position.
    pub fn shadow_map(
        &self,
        emitter: &Emitter,
        projection: &ShadowProjection,
        size: [u32; 2],
        progress: Progress<'_>,
    ) -> ShadowMap {
        let rays = MapRays::new(emitter, projection, size);
        let depth = |texel: Texel| match self.closest(&texel.ray, [0.0, texel.length]) {
            Some(hit) => {
                let corners = self.geometry.positions[hit.triangle];
                rays.nearest_depth(&texel, hit.distance, corners.map(|p| p.as_dvec3()))
            }
            None => rays.far_value(),
        };
        let rows = rays.map_rows(progress, |row| rays.row(row).map(depth).collect::<Vec<_>>());
        let depth = rows.concat();
        ShadowMap { size, depth }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use glam::{
        DVec2, DVec3, Vec3,
        camera::rh::{proj::directx, view},
        vec3,
    };

    use super::*;
    use crate::{
        scene::Scene,
        test_scenes::{SUN_OVERHEAD, block, map_from_above, opaque, quad, soup},
        view::Ray,
    };

    const LAMP: Emitter = Emitter::Point {
        position: [0.25, 0.5, -0.25],
        intensity: [1.0; 3],
        radius: 0.0,
    };

    #[test]
    fn a_map_from_above_holds_heights() {
        // A square metre at y = 1, to the right of the middle and (seen from above, -z up) below it.
        let tracer = Tracer::new(&opaque(&quad(Vec3::Y, Vec3::X, Vec3::Z)));
        for (reversed, plate, nothing) in [(true, 0.5, 0.0), (false, 0.5, 1.0)] {
            let map =
                tracer.shadow_map(&SUN_OVERHEAD, &map_from_above(reversed), [4, 8], &|_, _| ());
            for (i, depth) in map.depth.iter().enumerate() {
                let on_plate = i % 4 == 2 && (4..6).contains(&(i / 4));
                let expected = if on_plate { plate } else { nothing };
                // 1e-6: the matrix is f32.
                assert!((depth - expected).abs() < 1e-6, "texel {i}: {depth}");
            }
        }
    }

    /// Through the texel's corners and centre, by rays: the plane of the surface that the centre meets is never nearer to the
    /// light than the map says, and at one corner it is as near.
    #[test]
    fn every_texel_holds_its_plane_where_it_is_nearest() {
        let tracer = Tracer::new(&opaque(&soup(400, 5)));
        let view_from_world = view::look_at_mat4(vec3(0.3, 2.5, 1.0), Vec3::ZERO, Vec3::Y);
        let clip = directx::perspective(1.2, 1.0, 10.0, 0.1) * view_from_world;
        let projection = ShadowProjection::Single {
            clip_from_world: clip.to_cols_array_2d(),
            reversed_depth: true,
        };
        let map = tracer.shadow_map(&SUN_OVERHEAD, &projection, [32, 32], &|_, _| ());
        let clip = clip.as_dmat4();
        let eye = DVec3::new(0.3, 2.5, 1.0);
        let mut hits = 0;
        for (i, &depth) in map.depth.iter().enumerate() {
            let towards = |dx: f64, dy: f64| {
                let ndc = DVec2::new((i % 32) as f64 - 15.5 + dx, 15.5 - (i / 32) as f64 + dy);
                let point = clip.inverse().project_point3((ndc / 16.0).extend(0.5));
                (point - eye).normalize()
            };
            let ray = Ray {
                origin: eye,
                direction: towards(0.0, 0.0),
            };
            let hit = tracer.closest(&ray, [0.1, 9.99]);
            assert_eq!(hit.is_some(), depth > 0.0);
            let Some(hit) = hit else { continue };
            hits += 1;
            let [a, b, c] = tracer.geometry.positions[hit.triangle].map(|p| p.as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)];
            let distances = corners.map(|(dx, dy)| {
                let direction = towards(dx, dy);
                ((a - eye).dot(normal) / direction.dot(normal), direction)
            });
            let depths = distances.map(|(s, direction)| clip.project_point3(eye + s * direction).z);
            // A plane may pass the light, or the horizon, before it comes to a corner.
            if distances.iter().all(|(s, _)| *s > 0.1) {
                let nearest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
                // Measured: 4e-7; what is stored is f32, and so is the matrix that is turned round.
                let error = (nearest - f64::from(depth)).abs();
                assert!(error < 8e-7, "{i}: {nearest}, not {depth}");
            }
        }
        assert!(hits > 100, "only {hits} hits");
    }

    /// Directions of the faces by the table of the Direct3D 11.3 specification ("TextureCube"): the
    /// face's axis, and the world axes that u and v grow along.
    const FACES: [[Vec3; 3]; 6] = [
        [Vec3::X, Vec3::NEG_Z, Vec3::NEG_Y],
        [Vec3::NEG_X, Vec3::Z, Vec3::NEG_Y],
        [Vec3::Y, Vec3::X, Vec3::Z],
        [Vec3::NEG_Y, Vec3::X, Vec3::NEG_Z],
        [Vec3::Z, Vec3::X, Vec3::NEG_Y],
        [Vec3::NEG_Z, Vec3::NEG_X, Vec3::NEG_Y],
    ];

    #[test]
    fn cube_faces_look_where_a_cube_texture_s_do() {
        let Emitter::Point { position, .. } = LAMP else {
            return;
        };
        for reversed_depth in [false, true] {
            let projection = ShadowProjection::Cube {
                near: 0.5,
                far: 8.0,
                reversed_depth,
            };
            for (face, [axis, u, v]) in FACES.iter().enumerate() {
                for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let towards = *axis + (x as f32 - 0.5) * u + (y as f32 - 0.5) * v;
                    let center = Vec3::from(position) + 2.0 * towards;
                    let spot = block(center - 0.1, center + 0.1);
                    let map = Tracer::new(&opaque(&spot)).shadow_map(
                        &LAMP,
                        &projection,
                        [2, 2],
                        &|_, _| (),
                    );
                    let seen: Vec<usize> = (0..24)
                        .filter(|&i| {
                            map.depth[i] != map.depth[(i + 4) % 24] && map.depth[i].fract() != 0.0
                        })
                        .collect();
                    assert_eq!(
                        seen,
                        [4 * face + 2 * y + x],
                        "face {face}, texel ({x}, {y})"
                    );
                    // The block's near side is 1.9 m away along the axis.
                    let from_far = 0.5 * (8.0 - 1.9) / (1.9 * 7.5);
                    let expected = if reversed_depth {
                        from_far
                    } else {
                        1.0 - from_far
                    };
                    assert!((map.depth[seen[0]] - expected).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn progress_ends_at_the_total() {
        let most = AtomicU64::new(0);
        let progress = |done: u64, total: u64| {
            assert_eq!(total, 6 * 35);
            most.fetch_max(done, Ordering::Relaxed);
        };
        let projection = ShadowProjection::Cube {
            near: 0.1,
            far: 1.0,
            reversed_depth: true,
        };
        let map = Tracer::new(&Scene::default()).shadow_map(&LAMP, &projection, [7, 5], &progress);
        assert_eq!(map.depth, [0.0; 6 * 35]);
        assert_eq!(most.into_inner(), 6 * 35);
    }
}
