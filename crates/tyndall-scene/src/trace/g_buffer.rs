//! What the camera sees.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use tyndall::{cpu::Progress, frame::Camera};

use super::{Hit, Tracer};
use crate::view::{Ray, View};

/// What the camera sees, one entry a pixel in every array, row by row from the top left.
///
/// Where a ray meets no opaque surface between the near and the far plane, depth is the far plane's, the normal and
/// the colours are zero; the view tint is there all the same.
#[derive(Clone, Debug, PartialEq)]
pub struct GBuffer {
    /// Width and height [pixels].
    pub size: [u32; 2],
    /// What a depth buffer holds, in the camera's convention.
    pub depth: Vec<f32>,
    /// World-space unit normal on the viewer's side.
    pub normal: Vec<[f32; 3]>,
    /// Linear RGB reflectance.
    pub base_color: Vec<[f32; 3]>,
    /// Radiance that the surface gives off by itself [W/(m^2 sr)].
    pub emissive: Vec<[f32; 3]>,
    /// What the glass and blended surfaces in front of the surface multiply its light by.
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

    /// Texture coordinates where a ray meets the triangle's plane, inside the triangle or not.
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
