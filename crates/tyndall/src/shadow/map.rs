//! A shadow map and its coloured glass in f64, looked up by points.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use super::panes::Panes;
use crate::{
    frame::{Emitter, ShadowProjection},
    inputs::{CpuLightInputs, GlassMap, ShadowMap},
    physics::reals,
};

/// Directions of a cube face's u, v and axis in world space, in the order +X, -X, +Y, -Y, +Z, -Z
/// (WebGPU specification, "cube texture view"): u to the right, v downwards, seen from inside.
const CUBE_FACES: [[DVec3; 3]; 6] = [
    [DVec3::NEG_Z, DVec3::NEG_Y, DVec3::X],
    [DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X],
    [DVec3::X, DVec3::Z, DVec3::Y],
    [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
    [DVec3::X, DVec3::NEG_Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z],
];

/// One face of a shadow map's projection.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// World space to clip space, z in [0, 1] with 1 nearest to the light ("reversed"), y up.
    pub clip_from_world: DMat4,
}

/// The faces a shadow map was drawn with, with depth turned so that 1 is nearest to the light.
/// `None` where a cube is given to a light without a position.
pub fn faces(emitter: &Emitter, projection: &ShadowProjection) -> Option<Vec<Face>> {
    let reverse = |reversed: bool, clip_from_world: DMat4| {
        let flip = DMat4::from_cols(
            DVec4::X,
            DVec4::Y,
            -DVec4::Z,
            DVec4::new(0.0, 0.0, 1.0, 1.0),
        );
        Face {
            clip_from_world: if reversed {
                clip_from_world
            } else {
                flip * clip_from_world
            },
        }
    };
    match *projection {
        ShadowProjection::Single {
            clip_from_world,
            reversed_depth,
        } => {
            let matrix = DMat4::from_cols_array_2d(&clip_from_world.map(|c| c.map(f64::from)));
            Some(vec![reverse(reversed_depth, matrix)])
        }
        ShadowProjection::Cube { near, far, .. } => {
            let (Emitter::Point { position, .. } | Emitter::Spot { position, .. }) = *emitter
            else {
                return None;
            };
            let (near, far) = (f64::from(near), f64::from(far));
            Some(
                CUBE_FACES
                    .iter()
                    .map(|axes| Face {
                        clip_from_world: cube_face(axes, reals(position), near, far),
                    })
                    .collect(),
            )
        }
    }
}

/// A 90 degree perspective projection along `axis` with depth 1 at `near` and 0 at `far`.
fn cube_face([u, v, axis]: &[DVec3; 3], position: DVec3, near: f64, far: f64) -> DMat4 {
    let view = DMat3::from_cols(*u, -*v, *axis).transpose();
    let view_from_world = DMat4::from_mat3(view) * DMat4::from_translation(-position);
    let scale = near / (far - near);
    let clip_from_view = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, -scale, 1.0),
        DVec4::new(0.0, 0.0, scale * far, 0.0),
    );
    clip_from_view * view_from_world
}

/// A light's shadow map and coloured glass, ready to be asked about points.
#[derive(Clone, Debug)]
pub struct Shadows<'a> {
    pub(super) faces: Vec<Face>,
    /// Centre that a cube's faces meet around; unused for a single map.
    pub(super) center: DVec3,
    pub(super) reversed: bool,
    pub(super) map: &'a ShadowMap,
    pub(super) glass: Option<&'a GlassMap>,
    pub(super) panes: Panes,
}

impl<'a> Shadows<'a> {
    /// `None` where the light has no shadow map.
    pub fn new(
        emitter: &Emitter,
        projection: Option<&ShadowProjection>,
        inputs: &CpuLightInputs<'a>,
    ) -> Option<Self> {
        let projection = projection?;
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) = *projection;
        let center = match *emitter {
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => reals(position),
            Emitter::Directional { .. } | Emitter::Rect { .. } => DVec3::ZERO,
        };
        Some(Self {
            faces: faces(emitter, projection)?,
            center,
            reversed: reversed_depth,
            map: inputs.shadow_map?,
            glass: inputs.glass,
            panes: inputs
                .glass
                .map(|glass| Panes::new(glass, |depth| near_is_one(reversed_depth, depth)))
                .unwrap_or_default(),
        })
    }

    /// The factor of light that travels to `point`: 0 where it is blocked.
    pub fn tint(&self, point: DVec3) -> DVec3 {
        let face = self.face_of(point);
        let clip = self.faces[face].clip_from_world * point.extend(1.0);
        let Some(uv) = picture_point(clip) else {
            return DVec3::ONE;
        };
        let depth = clip.z / clip.w;
        let lit = texel_index(uv, self.map.size)
            .is_none_or(|texel| reaches(depth, self.stored_depth(face, texel)));
        if !lit {
            return DVec3::ZERO;
        }
        let Some((glass, texel)) = self.glass.and_then(|g| Some((g, texel_index(uv, g.size)?)))
        else {
            return DVec3::ONE;
        };
        self.glass_texel_tint(glass, face, texel, depth)
    }

    /// The tint of light that has passed the texel in this column and row of a face, for a point at `depth`, 1 nearest to
    /// the light; 0 where it is blocked. The glass has the map's size.
    ///
    /// # Panics
    /// If the map has no such texel.
    pub fn texel_tint(&self, face: usize, [x, y]: [u32; 2], depth: f64) -> DVec3 {
        let texel = y as usize * self.map.size[0] as usize + x as usize;
        if !reaches(depth, self.stored_depth(face, texel)) {
            return DVec3::ZERO;
        }
        self.glass.map_or(DVec3::ONE, |glass| {
            self.glass_texel_tint(glass, face, texel, depth)
        })
    }

    /// The product of the tints of a texel's glass before a point at `depth`.
    fn glass_texel_tint(&self, glass: &GlassMap, face: usize, texel: usize, depth: f64) -> DVec3 {
        (0..glass.layers)
            .map(|layer| self.glass_layer(glass, face, layer, texel))
            .filter(|(layer_depth, _)| !reaches(depth, *layer_depth))
            .map(|(_, tint)| tint)
            .product()
    }

    /// Distance \[m] from a point of a light ray, along its unit direction, at which the map ends the ray; infinite
    /// where it does not. A local light's ray starts at the light; the sun's may end before the point.
    pub(crate) fn light_end(&self, origin: DVec3, direction: DVec3) -> f64 {
        let Some(line) = self.line(origin, direction) else {
            return f64::INFINITY;
        };
        let stored = texel_index(line.uv, self.map.size)
            .map_or(0.0, |texel| self.stored_depth(line.face, texel));
        if stored <= 0.0 {
            f64::INFINITY
        } else {
            line.end(stored)
        }
    }

    /// A light ray on the map: from a local light's position, or from any point of the sun's ray. `None` where it
    /// travels behind the map's light.
    pub(crate) fn line(&self, origin: DVec3, direction: DVec3) -> Option<ShadowLine> {
        let face = self.face_of(self.center + direction);
        let matrix = &self.faces[face].clip_from_world;
        let c0 = *matrix * origin.extend(1.0);
        let c1 = *matrix * direction.extend(0.0);
        // All of its points fall on one place: a lamp's that of its direction, the sun's that of any of them.
        let uv = picture_point(if c1.w == 0.0 { c0 } else { c1 })?;
        Some(ShadowLine { uv, face, c0, c1 })
    }

    /// The part of the ray's stretch `[a, b]` \[m] that a single map covers; beyond it everything is lit.
    pub(crate) fn covered(&self, origin: DVec3, direction: DVec3, [a, b]: [f64; 2]) -> [f64; 2] {
        if self.faces.len() > 1 {
            return [a, b];
        }
        let matrix = &self.faces[0].clip_from_world;
        let c0 = *matrix * origin.extend(1.0);
        let c1 = *matrix * direction.extend(0.0);
        let (mut from, mut to) = (a, b);
        // w - x, w + x, w - y, w + y >= 0, each linear in s.
        for (constant, slope) in [
            (c0.w - c0.x, c1.w - c1.x),
            (c0.w + c0.x, c1.w + c1.x),
            (c0.w - c0.y, c1.w - c1.y),
            (c0.w + c0.y, c1.w + c1.y),
        ] {
            let crossing = -constant / slope;
            match slope {
                k if k > 0.0 => from = from.max(crossing),
                k if k < 0.0 => to = to.min(crossing),
                _ if constant < 0.0 => to = from,
                _ => {}
            }
        }
        [from, to]
    }

    /// Side of a face \[texels], the longer one.
    pub(crate) fn side(&self) -> u32 {
        self.map.size[0].max(self.map.size[1])
    }

    /// Width and height of a face \[texels].
    pub fn size(&self) -> [u32; 2] {
        self.map.size
    }

    /// The faces' projections.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// The face whose axis is nearest to the direction from the centre.
    pub fn face_of(&self, point: DVec3) -> usize {
        if self.faces.len() == 1 {
            return 0;
        }
        let q = point - self.center;
        let a = q.abs();
        let (axis, value) = if a.x >= a.y && a.x >= a.z {
            (0, q.x)
        } else if a.y >= a.z {
            (1, q.y)
        } else {
            (2, q.z)
        };
        2 * axis + usize::from(value < 0.0)
    }

    /// A texel's depth, 1 nearest to the light.
    pub(super) fn stored_depth(&self, face: usize, texel: usize) -> f64 {
        let faces = self.map.size[0] as usize * self.map.size[1] as usize;
        self.near_is_one(self.map.depth[face * faces + texel])
    }

    pub(super) fn glass_layer(
        &self,
        glass: &GlassMap,
        face: usize,
        layer: u32,
        texel: usize,
    ) -> (f64, DVec3) {
        let plane = glass.size[0] as usize * glass.size[1] as usize;
        let index = (face * glass.layers as usize + layer as usize) * plane + texel;
        let [r, g, b, depth] = glass.texels[index];
        (self.near_is_one(depth), reals([r, g, b]))
    }

    pub(super) fn near_is_one(&self, depth: f32) -> f64 {
        near_is_one(self.reversed, depth)
    }
}

/// A light ray on a shadow map: `c0 + t c1` in a face's clip space, at one place of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowLine {
    /// (0, 0) top left, (1, 1) bottom right.
    pub(crate) uv: DVec2,
    pub(crate) face: usize,
    c0: DVec4,
    c1: DVec4,
}

impl ShadowLine {
    /// Distance \[m] from the ray's point to the plane of this depth: `z(t) = depth w(t)`.
    pub(crate) fn end(&self, depth: f64) -> f64 {
        (depth * self.c0.w - self.c0.z) / (self.c1.z - depth * self.c1.w)
    }
}

/// A depth, 1 nearest to the light.
fn near_is_one(reversed: bool, depth: f32) -> f64 {
    let depth = f64::from(depth);
    if reversed { depth } else { 1.0 - depth }
}

/// True iff light reaches a point at `depth` past a texel at `stored` (1 nearest to the light; 0 is nothing at all).
fn reaches(depth: f64, stored: f64) -> bool {
    stored <= 0.0 || depth >= stored
}

/// The place on the map, (0, 0) top left, (1, 1) bottom right, of a point in front of the light.
pub(super) fn picture_point(clip: DVec4) -> Option<DVec2> {
    (clip.w > 0.0).then(|| DVec2::new(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w))
}

pub(super) fn texel_index(uv: DVec2, size: [u32; 2]) -> Option<usize> {
    let [width, height] = size.map(f64::from);
    let (x, y) = (uv.x * width, uv.y * height);
    let inside = x >= 0.0 && y >= 0.0 && x < width && y < height;
    inside.then(|| y as usize * size[0] as usize + x as usize)
}
