//! A camera's depth, normals and colours by ray casting.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use tyndall::{cpu::Progress, frame::Camera};

use super::tracer::{Hit, Tracer};
use crate::view::{Ray, View};

/// A camera's depth, normals and colours, one entry a pixel in every array, row by row from the top left.
///
/// A ray that meets no opaque surface between the near and the far plane has the far plane's depth, a zero normal and zero
/// colours; the view tint is there all the same.
#[derive(Clone, Debug, PartialEq)]
pub struct GBuffer {
    /// Width and height \[pixels].
    pub size: [u32; 2],
    /// Depth-buffer values, in the camera's convention.
    pub depth: Vec<f32>,
    /// World-space unit normal on the viewer's side.
    pub normal: Vec<[f32; 3]>,
    /// Linear RGB reflectance.
    pub base_color: Vec<[f32; 3]>,
    /// Emitted radiance [W/(m^2 sr)].
    pub emissive: Vec<[f32; 3]>,
    /// Factor on the surface's light by the glass and blended surfaces in front of it.
    pub view_tint: Vec<[f32; 3]>,
}

struct Pixel {
    depth: f32,
    normal: [f32; 3],
    base_color: [f32; 3],
    emissive: [f32; 3],
    view_tint: [f32; 3],
}

impl Tracer {
    /// Casts a ray through every pixel's centre. Textures are sampled trilinearly, at the level of detail of the pixel's
    /// 2 x 2 block, as a GPU does it.
    pub fn g_buffer(&self, camera: &Camera, size: [u32; 2], progress: Progress<'_>) -> GBuffer {
        let view = View::new(camera, size);
        let done = AtomicU64::new(0);
        let total = u64::from(size[0]) * u64::from(size[1]);
        let rows: Vec<Vec<Pixel>> = (0..size[1])
            .into_par_iter()
            .map(|y| {
                let row = (0..size[0]).map(|x| self.pixel(&view, x, y)).collect();
                let pixels = u64::from(size[0]);
                progress(done.fetch_add(pixels, Ordering::Relaxed) + pixels, total);
                row
            })
            .collect();
        let pixels = || rows.iter().flatten();
        GBuffer {
            size,
            depth: pixels().map(|p| p.depth).collect(),
            normal: pixels().map(|p| p.normal).collect(),
            base_color: pixels().map(|p| p.base_color).collect(),
            emissive: pixels().map(|p| p.emissive).collect(),
            view_tint: pixels().map(|p| p.view_tint).collect(),
        }
    }

    fn pixel(&self, view: &View, x: u32, y: u32) -> Pixel {
        let ray = view.ray(x, y);
        let [near, far] = view.span(&ray);
        let hit = self.closest(&ray, [near, far]);
        let view_tint = self.tint_along(&ray, [near, hit.map_or(far, |h| h.distance)]);
        let Some(hit) = hit else {
            return Pixel {
                depth: view.far_value(),
                normal: [0.0; 3],
                base_color: [0.0; 3],
                emissive: [0.0; 3],
                view_tint,
            };
        };
        // The other two corners of the pixel's block, whichever corner it is itself.
        let neighbours = [view.ray(x ^ 1, y), view.ray(x, y ^ 1)];
        Pixel {
            depth: view.stored_depth(&ray, hit.distance),
            normal: self.normal_towards(&ray, &hit).to_array(),
            base_color: self.base_color(&hit, &neighbours),
            emissive: self.surface(hit.triangle).emissive,
            view_tint,
        }
    }

    fn tint_along(&self, ray: &Ray, range: [f64; 2]) -> [f32; 3] {
        let mut glass = Vec::new();
        self.glass(ray, range, &mut glass);
        let tint: DVec3 = glass.iter().map(|hit| hit.tint).product();
        tint.as_vec3().to_array()
    }

    fn normal_towards(&self, ray: &Ray, hit: &Hit) -> Vec3 {
        let [a, b, c] = self.geometry.normals[hit.triangle];
        let weights = hit.weights.as_vec3();
        let normal = (weights.x * a + weights.y * b + weights.z * c).normalize_or(a);
        if normal.dot(ray.direction.as_vec3()) > 0.0 {
            -normal
        } else {
            normal
        }
    }

    fn base_color(&self, hit: &Hit, neighbours: &[Ray; 2]) -> [f32; 3] {
        let surface = self.surface(hit.triangle);
        let uv = self.uv(hit.triangle, hit.weights);
        let lod = surface.texture(&self.textures).map_or(0.0, |texture| {
            let [dx, dy] = neighbours.map(|ray| self.uv_on_plane(hit.triangle, &ray) - uv);
            texture.lod(dx, dy)
        });
        let [r, g, b, _] = surface.color(&self.textures, uv, lod).as_vec4().to_array();
        [r, g, b]
    }

    /// Texture coordinates of the point where a ray meets the triangle's plane, inside the triangle or not.
    fn uv_on_plane(&self, triangle: usize, ray: &Ray) -> DVec2 {
        let [a, b, c] = self.geometry.positions[triangle].map(|p| p.as_dvec3());
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let distance = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
        let offset = ray.at(distance) - a;
        let area2 = normal.length_squared();
        let weight_b = offset.cross(ac).dot(normal) / area2;
        let weight_c = ab.cross(offset).dot(normal) / area2;
        self.uv(
            triangle,
            DVec3::new(1.0 - weight_b - weight_c, weight_b, weight_c),
        )
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, vec3};
    use tyndall::frame::{DepthRange, Projection};

    use super::*;
    use crate::{
        scene::{Blocking, Scene, Texture, Wrap},
        test_scenes::{ball, material, opaque, quad, scene},
    };

    /// Looks along -z from z = 4; 90 degrees high and wide, or 8 m.
    fn cameras() -> [Camera; 5] {
        let at_origin = |perspective: bool, depth_range: DepthRange| Camera {
            eye: [0.0, 0.0, 4.0],
            forward: [0.0, 0.0, -1.0],
            up: [0.0, 1.0, 0.0],
            projection: if perspective {
                Projection::Perspective {
                    half_extent: [1.0; 2],
                    center: [0.0; 2],
                    near: 0.5,
                    far: 16.0,
                }
            } else {
                Projection::Orthographic {
                    half_extent: [4.0; 2],
                    center: [0.0; 2],
                    near: 0.5,
                    far: 16.0,
                }
            },
            depth_range,
        };
        [
            at_origin(true, DepthRange::Reversed),
            at_origin(true, DepthRange::Standard),
            at_origin(false, DepthRange::Reversed),
            at_origin(false, DepthRange::Standard),
            at_origin(true, DepthRange::ReversedInfinite),
        ]
    }

    fn g_buffer(scene: &Scene, camera: &Camera, size: [u32; 2]) -> GBuffer {
        Tracer::new(scene).g_buffer(camera, size, &|_, _| ())
    }

    #[test]
    fn a_ball_has_the_depth_and_the_normals_of_a_ball() {
        let tracer_scene = opaque(&ball(Vec3::ZERO, 1.0, 96));
        for camera in cameras() {
            let image = g_buffer(&tracer_scene, &camera, [64, 64]);
            let rays = tyndall::camera::CameraRays::new(&camera, [64, 64]);
            let mut hits = 0;
            for (i, &depth) in image.depth.iter().enumerate() {
                if depth == View::new(&camera, [64, 64]).far_value() {
                    assert_eq!(image.normal[i], [0.0; 3]);
                    continue;
                }
                hits += 1;
                let ray = rays.ray(i as u32 % 64, i as u32 / 64, depth);
                let point = ray.at(ray.length);
                // A polyhedron of 96 rings is at most 5.4e-4 inside its ball.
                assert!((0.9994..1.00001).contains(&point.length()), "{point}");
                let normal = DVec3::from(image.normal[i].map(f64::from));
                // Its flat sides turn by at most 0.033 from one to the next.
                assert!(
                    normal.is_normalized() && normal.dot(point) > 0.9992,
                    "{normal} at {point}"
                );
            }
            assert!(hits > 100, "only {hits} pixels of the ball");
        }
    }

    #[test]
    fn normals_face_the_viewer_on_either_side() {
        let front = quad(vec3(-9.0, -9.0, 0.0), 18.0 * Vec3::X, 18.0 * Vec3::Y);
        let back = front.map(|[a, b, c]| [a, c, b]);
        for triangles in [front, back] {
            let image = g_buffer(&opaque(&triangles), &cameras()[0], [4, 4]);
            assert_eq!(image.normal, [[0.0, 0.0, 1.0]; 16]);
        }
    }

    #[test]
    fn near_and_far_planes_end_the_view() {
        let wall = |z: f32| quad(vec3(-99.0, -99.0, z), 198.0 * Vec3::X, 198.0 * Vec3::Y);
        // View depth is 4 - z; the planes are at 0.5 and 16.
        for (walls, expected) in [
            (vec![wall(3.6), wall(0.0)], 4.0),
            (vec![wall(3.4), wall(0.0)], 0.6),
            (vec![wall(3.6), wall(-11.9)], 15.9),
            (vec![wall(3.6), wall(-12.1)], 16.0),
        ] {
            for camera in cameras() {
                let image = g_buffer(&opaque(&walls.concat()), &camera, [5, 5]);
                for depth in image.depth {
                    let found = tyndall::camera::CameraRays::new(&camera, [5, 5]).view_depth(depth);
                    // Not reversed, f32 near 1 is coarse: 2 / 2^25 of 16^2 / 0.5.
                    assert!(
                        (found - expected).abs() < 4e-5,
                        "{found}, expected {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn glass_tints_the_view_of_what_is_behind_it_only() {
        let pane = |z: f32| quad(vec3(-99.0, -99.0, z), 198.0 * Vec3::X, 198.0 * Vec3::Y);
        let glass = material(
            Blocking::Transmissive { transmission: 0.5 },
            [1.0, 0.5, 0.0, 1.0],
        );
        let mut both = scene(
            &[pane(1.0), pane(2.0), pane(-1.0)].concat(),
            |_| Vec2::ZERO,
            glass,
            None,
        );
        let mut wall = opaque(&pane(0.0));
        wall.meshes[0].primitives[0].material = 1;
        both.materials.extend(wall.materials);
        let image = g_buffer(&both, &cameras()[0], [3, 3]);
        // Without the wall, all three panes tint the far plane.
        assert_eq!(image.view_tint, [[0.125, 0.015_625, 0.0]; 9]);
        both.meshes[0]
            .primitives
            .extend(wall.meshes.remove(0).primitives);
        let image = g_buffer(&both, &cameras()[0], [3, 3]);
        assert_eq!(image.view_tint, [[0.25, 0.0625, 0.0]; 9]);
        assert_eq!(image.base_color, [[0.5; 3]; 9]);
    }

    /// A checkerboard of 256 texels over 8 m, seen from so far that a pixel covers 2^n texels, has the colour of level n:
    /// crisp from near, an even grey from far.
    #[test]
    fn textures_blur_with_distance() {
        let checker = Texture {
            size: [256, 256],
            texels: (0..256 * 256)
                .map(|i| [if (i + i / 256) % 2 == 0 { 255 } else { 0 }; 4])
                .collect(),
            wrap: [Wrap::Repeat; 2],
        };
        let wall = quad(vec3(-4.0, -4.0, 0.0), 8.0 * Vec3::X, 8.0 * Vec3::Y);
        let white = material(Blocking::Opaque, [1.0, 1.0, 0.5, 1.0]);
        let uv = |p: Vec3| (p.truncate() + 4.0) / 8.0;
        let checkered = scene(&wall, uv, white, Some(checker));
        // Perspective, then orthographic: both see just the wall at z = 0. A pixel's centre is a texel's at 256.
        for camera in [cameras()[0], cameras()[2]] {
            let crisp = g_buffer(&checkered, &camera, [256, 256]);
            // 0.002: the levels' rounding to 8 bits; coordinates are f32.
            assert!(
                crisp
                    .base_color
                    .iter()
                    .all(|c| c[0] < 0.002 || c[0] > 0.998)
            );
            let blurred = g_buffer(&checkered, &camera, [128, 128]);
            assert!(
                blurred
                    .base_color
                    .iter()
                    .all(|c| (c[0] - 0.5).abs() < 0.004 && (c[2] - 0.25).abs() < 0.002)
            );
        }
    }
}
