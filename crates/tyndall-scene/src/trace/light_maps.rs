//! What a light sees: shadow maps and glass maps, by casting a ray through every texel's centre.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat4, DVec2, DVec3, DVec4, Vec4Swizzles};
use rayon::prelude::*;
use tyndall::{
    cpu::{GlassMap, Progress, ShadowMap},
    frame::{Emitter, ShadowProjection},
};

use super::{GlassHit, Tracer};
use crate::view::{DepthRange, Ray};

/// Layers of a glass map: how many panes of tinted glass, one behind the other, tint what is behind them all.
pub const GLASS_LAYERS: u32 = 4;

impl Tracer {
    /// The light's shadow map, `size` texels a face: at each texel's centre the stored depth (clip z / w) of the first
    /// opaque surface between the near and the far plane, the far plane's where there is none.
    pub fn shadow_map(
        &self,
        emitter: &Emitter,
        projection: &ShadowProjection,
        size: [u32; 2],
        progress: Progress<'_>,
    ) -> ShadowMap {
        let rays = MapRays::new(emitter, projection, size);
        let depth = rays.map_texels(progress, |ray, length| {
            self.closest(ray, [0.0, length])
                .map_or(rays.far_value, |hit| {
                    rays.stored_depth(ray.at(hit.distance))
                })
        });
        ShadowMap { size, depth }
    }

    /// The tinted glass that light passes before the first opaque surface: at each texel's centre up to `layers` panes,
    /// nearest to the light first. Panes beyond that many are left out. `None` where the scene has no tinted glass.
    pub fn glass_map(
        &self,
        emitter: &Emitter,
        projection: &ShadowProjection,
        size: [u32; 2],
        layers: u32,
        progress: Progress<'_>,
    ) -> Option<GlassMap> {
        if !self.has_tinted_glass() {
            return None;
        }
        let rays = MapRays::new(emitter, projection, size);
        let columns = rays.map_texels(progress, |ray, length| {
            let mut column = vec![[1.0, 1.0, 1.0, rays.far_value]; layers as usize];
            for (texel, pane) in column.iter_mut().zip(self.panes(ray, length)) {
                let [r, g, b] = pane.tint.as_vec3().to_array();
                *texel = [r, g, b, rays.stored_depth(ray.at(pane.distance))];
            }
            column
        });
        let face_texels = (size[0] as usize * size[1] as usize).max(1);
        let layer = |face: &[Vec<[f32; 4]>], layer: usize| -> Vec<[f32; 4]> {
            face.iter().map(|column| column[layer]).collect()
        };
        let texels = columns
            .chunks_exact(face_texels)
            .flat_map(|face| (0..layers as usize).flat_map(move |l| layer(face, l)))
            .collect();
        Some(GlassMap {
            size,
            layers,
            texels,
        })
    }

    /// Tinted glass in front of the first opaque surface, nearest first.
    fn panes(&self, ray: &Ray, length: f64) -> Vec<GlassHit> {
        let mut panes = Vec::new();
        self.glass(ray, [0.0, length], &mut panes);
        if !panes.is_empty() {
            if let Some(blocker) = self.closest(ray, [0.0, length]) {
                panes.retain(|pane| pane.distance < blocker.distance);
            }
            panes.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        }
        panes
    }
}

/// The rays through a shadow map's texels, from its near to its far plane.
struct MapRays {
    size: [u32; 2],
    faces: u32,
    far_value: f32,
    shape: MapShape,
}

enum MapShape {
    Single {
        clip_from_world: DMat4,
        world_from_clip: DMat4,
        /// Clip depth of the near and the far plane.
        planes: [f64; 2],
    },
    Cube {
        position: DVec3,
        range: DepthRange,
    },
}

impl MapRays {
    fn new(emitter: &Emitter, projection: &ShadowProjection, size: [u32; 2]) -> Self {
        match *projection {
            ShadowProjection::Single {
                clip_from_world,
                reversed_depth,
            } => {
                let clip_from_world =
                    DMat4::from_cols_array_2d(&clip_from_world.map(|column| column.map(f64::from)));
                Self {
                    size,
                    faces: 1,
                    far_value: if reversed_depth { 0.0 } else { 1.0 },
                    shape: MapShape::Single {
                        clip_from_world,
                        world_from_clip: clip_from_world.inverse(),
                        planes: if reversed_depth {
                            [1.0, 0.0]
                        } else {
                            [0.0, 1.0]
                        },
                    },
                }
            }
            ShadowProjection::Cube {
                near,
                far,
                reversed_depth,
            } => {
                let range = DepthRange {
                    near: f64::from(near),
                    far: f64::from(far),
                    reversed: reversed_depth,
                };
                Self {
                    size,
                    faces: 6,
                    far_value: range.far_value(),
                    shape: MapShape::Cube {
                        position: position(emitter),
                        range,
                    },
                }
            }
        }
    }

    /// The values of all texels, face by face, row by row. `value` is given a texel's ray from the near plane and its
    /// length to the far plane [m].
    fn map_texels<T: Send>(
        &self,
        progress: Progress<'_>,
        value: impl Fn(&Ray, f64) -> T + Sync,
    ) -> Vec<T> {
        let rows = u64::from(self.faces) * u64::from(self.size[1]);
        let (done, width) = (AtomicU64::new(0), u64::from(self.size[0]));
        let row_of_texels = |row: u64| -> Vec<T> {
            let (face, y) = (row / u64::from(self.size[1]), row % u64::from(self.size[1]));
            let texels = (0..self.size[0])
                .map(|x| {
                    let (ray, length) = self.ray(face as usize, DVec2::new(f64::from(x), y as f64));
                    value(&ray, length)
                })
                .collect();
            progress(
                done.fetch_add(width, Ordering::Relaxed) + width,
                rows * width,
            );
            texels
        };
        (0..rows)
            .into_par_iter()
            .flat_map_iter(row_of_texels)
            .collect()
    }

    fn ray(&self, face: usize, texel: DVec2) -> (Ray, f64) {
        let size = DVec2::from(self.size.map(f64::from));
        let ndc = DVec2::new(2.0, -2.0) * ((texel + 0.5) / size - 0.5);
        let [from, to] = match &self.shape {
            MapShape::Single {
                world_from_clip,
                planes,
                ..
            } => planes.map(|z| {
                let point = *world_from_clip * ndc.extend(z).extend(1.0);
                point.xyz() / point.w
            }),
            MapShape::Cube { position, range } => {
                let direction = cube_direction(face, ndc);
                [range.near, range.far].map(|depth| position + depth * direction)
            }
        };
        let length = (to - from).length();
        let ray = Ray {
            origin: from,
            direction: (to - from) / length,
        };
        (ray, length)
    }

    /// What the map holds for a surface at this point.
    fn stored_depth(&self, point: DVec3) -> f32 {
        (match &self.shape {
            MapShape::Single {
                clip_from_world, ..
            } => {
                let clip: DVec4 = *clip_from_world * point.extend(1.0);
                clip.z / clip.w
            }
            MapShape::Cube { position, range } => {
                range.perspective((point - position).abs().max_element())
            }
        }) as f32
    }
}

/// Where a light's cube map is seen from. A cube belongs to a light that has a position.
fn position(emitter: &Emitter) -> DVec3 {
    match *emitter {
        Emitter::Point { position, .. } | Emitter::Spot { position, .. } => position,
        Emitter::Rect { center, .. } => center,
        Emitter::Directional { .. } => [0.0; 3],
    }
    .map(f64::from)
    .into()
}

/// The direction, of length 1 along the face's axis, to a point of a cube map's face (+X, -X, +Y, -Y, +Z, -Z) at
/// normalised device coordinates (x right, y up), in the orientation of WebGPU's and Direct3D's cube textures.
pub fn cube_direction(face: usize, ndc: DVec2) -> DVec3 {
    let DVec2 { x, y } = ndc;
    match face {
        0 => DVec3::new(1.0, y, -x),
        1 => DVec3::new(-1.0, y, x),
        2 => DVec3::new(x, 1.0, -y),
        3 => DVec3::new(x, -1.0, y),
        4 => DVec3::new(x, y, 1.0),
        _ => DVec3::new(-x, y, -1.0),
    }
}
