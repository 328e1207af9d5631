//! What a light sees: shadow maps and glass maps, by casting a ray through every texel's centre.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat4, DVec2};
use rayon::prelude::*;
use tyndall::{
    cpu::{GlassMap, Progress, ShadowMap},
    frame::{Emitter, ShadowProjection},
    shadow,
};

use super::{GlassHit, Tracer};
use crate::view::Ray;

/// Layers of a glass map: how many panes of tinted glass, one behind the other, tint what is behind them all.
pub const GLASS_LAYERS: u32 = 4;

impl Tracer {
    /// The light's shadow map, `size` texels a face: at each texel's centre the stored depth (clip z / w) of the first
    /// opaque surface between the near and the far plane, the far plane's where there is none. Without any texels where
    /// a cube is asked for of a light that has no position.
    pub fn shadow_map(
        &self,
        emitter: &Emitter,
        projection: &ShadowProjection,
        size: [u32; 2],
        progress: Progress<'_>,
    ) -> ShadowMap {
        let rays = MapRays::new(emitter, projection, size);
        let depth = rays.flat_map_texels(progress, |texel| {
            [self
                .closest(&texel.ray, [0.0, texel.length])
                .map_or(rays.far_value(), |hit| {
                    rays.stored_depth(&texel, hit.distance)
                })]
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
        // Most texels see no glass: what they see is gathered first and strewn over an empty map.
        let panes = rays.flat_map_texels(progress, |texel| {
            let panes = self.panes(&texel.ray, texel.length);
            let stored = |pane: &GlassHit| {
                let [r, g, b] = pane.tint.as_vec3().to_array();
                [r, g, b, rays.stored_depth(&texel, pane.distance)]
            };
            let shown = panes.iter().take(layers as usize).enumerate();
            shown
                .map(|(layer, pane)| (texel.face, layer, texel.index, stored(pane)))
                .collect::<Vec<_>>()
        });
        let plane = size[0] as usize * size[1] as usize;
        let count = rays.faces.len() * layers as usize * plane;
        let mut texels = vec![[1.0, 1.0, 1.0, rays.far_value()]; count];
        for (face, layer, index, texel) in panes {
            texels[(face * layers as usize + layer) * plane + index] = texel;
        }
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
    faces: Vec<Face>,
    reversed: bool,
}

/// A texel's place and its ray.
struct Texel {
    face: usize,
    /// Within its face, row by row.
    index: usize,
    /// From the near plane.
    ray: Ray,
    /// Distance to the far plane [m].
    length: f64,
}

/// A face's projection, with depth 1 at the near plane, and its inverse.
struct Face {
    clip_from_world: DMat4,
    world_from_clip: DMat4,
}

impl MapRays {
    fn new(emitter: &Emitter, projection: &ShadowProjection, size: [u32; 2]) -> Self {
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) = *projection;
        let faces = shadow::faces(emitter, projection).unwrap_or_default();
        Self {
            size,
            faces: faces
                .iter()
                .map(|face| Face {
                    clip_from_world: face.clip_from_world,
                    world_from_clip: face.clip_from_world.inverse(),
                })
                .collect(),
            reversed: reversed_depth,
        }
    }

    /// What `values` gives for all texels, face by face, row by row.
    fn flat_map_texels<T: Send, I: IntoIterator<Item = T>>(
        &self,
        progress: Progress<'_>,
        values: impl Fn(Texel) -> I + Sync,
    ) -> Vec<T> {
        let [width, height] = self.size.map(|n| n as usize);
        let total = (self.faces.len() * width * height) as u64;
        let done = AtomicU64::new(0);
        let row_of_values = |row: usize| -> Vec<T> {
            let first = row % height * width;
            let texels = (first..first + width).map(|index| self.texel(row / height, index));
            let values = texels.flat_map(&values).collect();
            progress(
                done.fetch_add(width as u64, Ordering::Relaxed) + width as u64,
                total,
            );
            values
        };
        (0..self.faces.len() * height)
            .into_par_iter()
            .flat_map_iter(row_of_values)
            .collect()
    }

    fn texel(&self, face: usize, index: usize) -> Texel {
        let (x, y) = (index % self.size[0] as usize, index / self.size[0] as usize);
        let size = DVec2::from(self.size.map(f64::from));
        let ndc = DVec2::new(2.0, -2.0) * ((DVec2::new(x as f64, y as f64) + 0.5) / size - 0.5);
        let world_from_clip = self.faces[face].world_from_clip;
        let [from, to] = [1.0, 0.0].map(|z| world_from_clip.project_point3(ndc.extend(z)));
        let length = (to - from).length();
        Texel {
            face,
            index,
            ray: Ray {
                origin: from,
                direction: (to - from) / length,
            },
            length,
        }
    }

    /// What the map holds for a surface at a distance along a texel's ray [m].
    fn stored_depth(&self, texel: &Texel, distance: f64) -> f32 {
        let clip_from_world = self.faces[texel.face].clip_from_world;
        self.stored(clip_from_world.project_point3(texel.ray.at(distance)).z)
    }

    /// What the map holds where there is no surface.
    fn far_value(&self) -> f32 {
        self.stored(0.0)
    }

    fn stored(&self, near_is_one: f64) -> f32 {
        (if self.reversed {
            near_is_one
        } else {
            1.0 - near_is_one
        }) as f32
    }
}

#[cfg(test)]
mod tests {
    use glam::{
        DVec3, Vec2, Vec3,
        camera::rh::{proj::directx, view},
        vec3,
    };

    use super::*;
    use crate::{
        scene::{Blocking, Scene},
        trace::test_scenes::{block, material, opaque, quad, scene, soup},
    };

    const SUN: Emitter = Emitter::Directional {
        direction: [0.0, -1.0, 0.0],
        illuminance: [1.0; 3],
    };
    const LAMP: Emitter = Emitter::Point {
        position: [0.25, 0.5, -0.25],
        intensity: [1.0; 3],
    };

    /// Looks down from y = 3; 4 x 4 m, depth 1 at y = 3 and 0 at y = -1.
    fn from_above(reversed_depth: bool) -> ShadowProjection {
        let view_from_world = view::look_to_mat4(3.0 * Vec3::Y, Vec3::NEG_Y, Vec3::NEG_Z);
        let (near, far) = if reversed_depth {
            (4.0, 0.0)
        } else {
            (0.0, 4.0)
        };
        let clip = directx::orthographic(-2.0, 2.0, -2.0, 2.0, near, far) * view_from_world;
        ShadowProjection::Single {
            clip_from_world: clip.to_cols_array_2d(),
            reversed_depth,
        }
    }

    #[test]
    fn a_map_from_above_holds_heights() {
        // A square metre at y = 1, to the right of the middle and (seen from above, -z up) below it.
        let tracer = Tracer::new(&opaque(&quad(Vec3::Y, Vec3::X, Vec3::Z)));
        for (reversed, plate, nothing) in [(true, 0.5, 0.0), (false, 0.5, 1.0)] {
            let map = tracer.shadow_map(&SUN, &from_above(reversed), [4, 8], &|_, _| ());
            for (i, depth) in map.depth.iter().enumerate() {
                let on_plate = i % 4 == 2 && (4..6).contains(&(i / 4));
                let expected = if on_plate { plate } else { nothing };
                // 1e-6: the matrix is f32.
                assert!((depth - expected).abs() < 1e-6, "texel {i}: {depth}");
            }
        }
    }

    #[test]
    fn every_texel_s_point_projects_back_onto_it() {
        let tracer = Tracer::new(&opaque(&soup(400, 5)));
        let view_from_world = view::look_at_mat4(vec3(0.3, 2.5, 1.0), Vec3::ZERO, Vec3::Y);
        let clip = directx::perspective(1.2, 1.0, 10.0, 0.1) * view_from_world;
        let projection = ShadowProjection::Single {
            clip_from_world: clip.to_cols_array_2d(),
            reversed_depth: true,
        };
        let map = tracer.shadow_map(&SUN, &projection, [32, 32], &|_, _| ());
        let clip = clip.as_dmat4();
        let mut hits = 0;
        for (i, &depth) in map.depth.iter().enumerate() {
            let ndc = DVec2::new((i % 32) as f64 - 15.5, 15.5 - (i / 32) as f64) / 16.0;
            let point = clip.inverse().project_point3(ndc.extend(f64::from(depth)));
            let eye = DVec3::new(0.3, 2.5, 1.0);
            let ray = Ray {
                origin: eye,
                direction: (point - eye).normalize(),
            };
            let hit = tracer.closest(&ray, [0.1, 9.99]);
            assert_eq!(hit.is_some(), depth > 0.0);
            if let Some(hit) = hit {
                hits += 1;
                // Measured: 1.5e-6; the stored depth is f32.
                assert!((hit.distance - (point - eye).length()).abs() < 4e-6);
            }
        }
        assert!(hits > 100, "only {hits} hits");
    }

    /// Where texel (x, y) of a face of 2 x 2 looks, by the table of the Direct3D 11.3 specification ("TextureCube"): the
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
    fn glass_is_listed_from_the_light_up_to_the_first_blocker() {
        let layer = |height: f32| quad(vec3(-1.0, height, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z);
        let heights = [0.5, 2.0, 1.5, -0.5];
        let mut panes: Scene = scene(
            &heights.iter().flat_map(|&h| layer(h)).collect::<Vec<_>>(),
            |_| Vec2::ZERO,
            material(
                Blocking::Transmissive { transmission: 0.5 },
                [1.0, 0.5, 0.25, 1.0],
            ),
            None,
        );
        let mut floor = opaque(&layer(0.0));
        let mut mesh = floor.meshes.remove(0);
        mesh.primitives[0].material = 1;
        panes.materials.push(floor.materials.remove(0));
        panes.meshes[0].primitives.extend(mesh.primitives);
        let tracer = Tracer::new(&panes);
        for (layers, expected) in [(4, vec![0.75, 0.625, 0.375, 0.0]), (2, vec![0.75, 0.625])] {
            let map = tracer
                .glass_map(&SUN, &from_above(true), [4, 4], layers, &|_, _| ())
                .unwrap();
            assert_eq!(map.texels.len(), 16 * layers as usize);
            for (layer, expected) in expected.into_iter().enumerate() {
                // A texel over the panes, on their diagonal: no pane counts twice there.
                let [r, g, b, depth] = map.texels[16 * layer + 10];
                assert!((depth - expected).abs() < 1e-6, "layer {layer}: {depth}");
                let tint = if expected > 0.0 {
                    [0.5, 0.25, 0.125]
                } else {
                    [1.0; 3]
                };
                assert_eq!([r, g, b], tint);
                assert_eq!(
                    map.texels[16 * layer],
                    [1.0, 1.0, 1.0, 0.0],
                    "beside the panes"
                );
            }
        }
        let no_glass = Tracer::new(&opaque(&layer(0.0)));
        assert_eq!(
            no_glass.glass_map(&SUN, &from_above(true), [4, 4], 4, &|_, _| ()),
            None
        );
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
