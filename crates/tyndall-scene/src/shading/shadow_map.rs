//! Visibility by a shadow map with its glass, filtered.

use glam::{DVec2, DVec3};
use tyndall::{
    cpu::{CpuLightInputs, GlassMap, ShadowMap},
    frame::{Emitter, Light, ShadowProjection},
    shadow,
};

use super::surface::vector;

/// Offset along its normal at which a point's shadow is looked up \[texels].
pub const NORMAL_OFFSET_TEXELS: f64 = 2.0;

/// A shadow map with its glass, looked up with a filter.
pub(super) struct SurfaceShadow<'a> {
    faces: Vec<shadow::Face>,
    /// World-space point where a cube's faces meet \[m]; unused for a single map.
    center: DVec3,
    reversed: bool,
    map: &'a ShadowMap,
    glass: Option<&'a GlassMap>,
}

impl<'a> SurfaceShadow<'a> {
    pub(super) fn new(light: &Light, inputs: &CpuLightInputs<'a>) -> Option<Self> {
        let projection = light.shadow?;
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) = projection;
        Some(Self {
            faces: shadow::faces(&light.emitter, &projection)?,
            center: match light.emitter {
                Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                    vector(position)
                }
                Emitter::Directional { .. } | Emitter::Rect { .. } => DVec3::ZERO,
            },
            reversed: reversed_depth,
            map: inputs.shadow_map?,
            glass: inputs.glass,
        })
    }

    /// Share of the light that reaches a surface, per channel.
    pub(super) fn visibility(&self, point: DVec3, normal: DVec3) -> DVec3 {
        let offset = NORMAL_OFFSET_TEXELS * self.texel_size(point);
        let point = point + offset * normal;
        let face = self.face_of(point);
        let clip = self.faces[face].clip_from_world * point.extend(1.0);
        // Behind the light.
        if clip.w <= 0.0 {
            return DVec3::ONE;
        }
        self.filtered(face, clip.truncate() / clip.w)
    }

    /// The tints of the four texels round a place in a face's normalised device coordinates, weighted bilinearly.
    fn filtered(&self, face: usize, ndc: DVec3) -> DVec3 {
        let size = DVec2::from(self.map.size.map(f64::from));
        let texel = DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * size - 0.5;
        let (corner, share) = (texel.floor(), texel - texel.floor());
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
            .into_iter()
            .map(|(dx, dy)| {
                let weights = DVec2::new(
                    if dx == 0.0 { 1.0 - share.x } else { share.x },
                    if dy == 0.0 { 1.0 - share.y } else { share.y },
                );
                let tint = self.texel_tint(face, corner + DVec2::new(dx, dy), ndc.z);
                weights.element_product() * tint
            })
            .sum()
    }

    /// Edge of a texel at a point's distance from the light \[m].
    fn texel_size(&self, point: DVec3) -> f64 {
        let matrix = self.faces[self.face_of(point)].clip_from_world;
        let rows = [matrix.row(0), matrix.row(1)].map(|row| row.truncate().length());
        let per_meter =
            (rows[0] * f64::from(self.map.size[0])).min(rows[1] * f64::from(self.map.size[1]));
        2.0 * (matrix * point.extend(1.0)).w.max(0.0) / per_meter
    }

    /// The tint of light that has passed one texel, for a point at `depth` (1 nearest to the light).
    fn texel_tint(&self, face: usize, texel: DVec2, depth: f64) -> DVec3 {
        let last = DVec2::from(self.map.size.map(f64::from)) - 1.0;
        let clamped = texel.clamp(DVec2::ZERO, last);
        if self.faces.len() == 1 && clamped != texel {
            return DVec3::ONE;
        }
        let [width, height] = self.map.size.map(|n| n as usize);
        let (plane, index) = (
            width * height,
            clamped.y as usize * width + clamped.x as usize,
        );
        if self.hides(self.map.depth[face * plane + index], depth) {
            return DVec3::ZERO;
        }
        let Some(glass) = self.glass else {
            return DVec3::ONE;
        };
        let layers = glass.layers as usize;
        (face * layers..(face + 1) * layers)
            .map(|layer| glass.texels[layer * plane + index])
            .filter(|[.., stored]| self.hides(*stored, depth))
            .map(|[r, g, b, _]| vector([r, g, b]))
            .product()
    }

    /// True if a stored depth is nearer to the light than `depth` (1 nearest); nothing was drawn where it is 0.
    fn hides(&self, stored: f32, depth: f64) -> bool {
        let stored = if self.reversed {
            f64::from(stored)
        } else {
            1.0 - f64::from(stored)
        };
        stored > 0.0 && depth < stored
    }

    /// The face whose axis is nearest to the direction from the centre.
    fn face_of(&self, point: DVec3) -> usize {
        if self.faces.len() == 1 {
            return 0;
        }
        let q = point - self.center;
        let axis = q.abs().max_position();
        2 * axis + usize::from(q[axis] < 0.0)
    }
}
