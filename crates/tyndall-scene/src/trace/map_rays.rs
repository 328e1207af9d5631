//! The rays through the centres of a shadow map's texels, and the depths it stores along them.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;
use tyndall::{
    cpu::Progress,
    frame::{Emitter, ShadowProjection},
    shadow,
};

use crate::view::Ray;

/// The rays through a shadow map's texels, from its near to its far plane.
pub(super) struct MapRays {
    size: [u32; 2],
    faces: Vec<Face>,
    reversed: bool,
}

/// A texel and the ray through its centre.
pub(super) struct Texel {
    face: usize,
    /// Starts on the near plane.
    pub(super) ray: Ray,
    /// Distance to the far plane \[m].
    pub(super) length: f64,
}

/// A face's projection, with depth 1 at the near plane, and its inverse.
struct Face {
    clip_from_world: DMat4,
    world_from_clip: DMat4,
}

impl Face {
    /// Depth, 1 at the near plane, of a point along a texel's ray.
    fn depth(&self, texel: &Texel, distance: f64) -> f64 {
        let point = texel.ray.at(distance);
        self.clip_from_world.project_point3(point).z
    }
}

impl MapRays {
    pub(super) fn new(emitter: &Emitter, projection: &ShadowProjection, size: [u32; 2]) -> Self {
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

    /// What `value` gives for every row, face by face.
    pub(super) fn map_rows<T: Send>(
        &self,
        progress: Progress<'_>,
        value: impl Fn(usize) -> T + Sync,
    ) -> Vec<T> {
        let [width, height] = self.size.map(u64::from);
        let total = self.faces.len() as u64 * width * height;
        let done = AtomicU64::new(0);
        let counted = |row: usize| {
            let value = value(row);
            progress(done.fetch_add(width, Ordering::Relaxed) + width, total);
            value
        };
        let rows = 0..self.faces.len() * height as usize;
        rows.into_par_iter().map(counted).collect()
    }

    /// A row's texels, from the left.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = Texel> {
        let height = self.size[1] as usize;
        (0..self.size[0] as usize).map(move |x| self.texel(row / height, [x, row % height]))
    }

    /// Number of faces: 1 or 6; 0 where a cube is asked for of a light that has no position.
    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn texel(&self, face: usize, [x, y]: [usize; 2]) -> Texel {
        let size = DVec2::from(self.size.map(f64::from));
        let ndc = DVec2::new(2.0, -2.0) * ((DVec2::new(x as f64, y as f64) + 0.5) / size - 0.5);
        let world_from_clip = self.faces[face].world_from_clip;
        let [from, to] = [1.0, 0.0].map(|z| world_from_clip.project_point3(ndc.extend(z)));
        let length = (to - from).length();
        Texel {
            face,
            ray: Ray {
                origin: from,
                direction: (to - from) / length,
            },
            length,
        }
    }

    /// The depth that the map stores for a plane through a triangle, which a texel's ray meets at a distance \[m]: where the plane
    /// is nearest to the light within the texel. So no light passes between a slanted wall's steps.
    pub(super) fn nearest_depth(&self, texel: &Texel, distance: f64, [a, b, c]: [DVec3; 3]) -> f32 {
        let face = &self.faces[texel.face];
        let depth = face.depth(texel, distance);
        let normal = (b - a).cross(c - a);
        // In clip space planes are planes, and depth is affine over the map.
        let plane = face.world_from_clip.transpose() * normal.extend(-normal.dot(a));
        let slope = plane.truncate().truncate() / plane.z;
        let half_texel = slope.abs() / DVec2::from(self.size.map(f64::from));
        let towards = half_texel.element_sum();
        let nearest = if towards.is_finite() {
            depth + towards
        } else {
            depth
        };
        self.stored(nearest.min(1.0))
    }

    /// The depth that the map stores for a point at a distance along a texel's ray \[m].
    pub(super) fn stored_depth(&self, texel: &Texel, distance: f64) -> f32 {
        self.stored(self.faces[texel.face].depth(texel, distance))
    }

    /// The depth that the map stores where there is no surface.
    pub(super) fn far_value(&self) -> f32 {
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
