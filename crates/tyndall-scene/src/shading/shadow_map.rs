//! Visibility by a shadow map with its glass, filtered.

use glam::{DVec2, DVec3};
use tyndall::{cpu::CpuLightInputs, frame::Light, shadow::Shadows};

/// Offset along its normal at which a point's shadow is looked up where it faces the light \[texels].
pub const NORMAL_OFFSET_TEXELS: f64 = 1.0;
/// What the offset grows by until the light grazes the point, with the sine of the light's angle \[texels].
pub const NORMAL_OFFSET_GRAZING_TEXELS: f64 = 4.0;

/// A shadow map with its glass, looked up with a filter.
pub(super) struct SurfaceShadow<'a> {
    shadows: Shadows<'a>,
    /// Width and height of a face \[texels].
    size: DVec2,
}

impl<'a> SurfaceShadow<'a> {
    pub(super) fn new(light: &Light, inputs: &CpuLightInputs<'a>) -> Option<Self> {
        let shadows = Shadows::new(&light.emitter, light.shadow.as_ref(), inputs)?;
        let size = DVec2::from(shadows.size().map(f64::from));
        Some(Self { shadows, size })
    }

    /// Share of the light that reaches a surface, per channel; `direction` is that in which it travels there.
    pub(super) fn visibility(&self, point: DVec3, normal: DVec3, direction: DVec3) -> DVec3 {
        let grazing = NORMAL_OFFSET_GRAZING_TEXELS * normal.cross(direction).length();
        let offset = (NORMAL_OFFSET_TEXELS + grazing) * self.texel_size(point);
        let point = point + offset * normal;
        let face = self.shadows.face_of(point);
        let clip = self.shadows.faces()[face].clip_from_world * point.extend(1.0);
        // Behind the light.
        if clip.w <= 0.0 {
            return DVec3::ONE;
        }
        self.filtered(face, clip.truncate() / clip.w)
    }

    /// The tints of the four texels round a place in a face's normalised device coordinates, weighted bilinearly.
    fn filtered(&self, face: usize, ndc: DVec3) -> DVec3 {
        let texel = DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * self.size - 0.5;
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
        let face = self.shadows.face_of(point);
        let matrix = self.shadows.faces()[face].clip_from_world;
        let rows = [matrix.row(0), matrix.row(1)].map(|row| row.truncate().length());
        let per_meter = (DVec2::from(rows) * self.size).min_element();
        2.0 * (matrix * point.extend(1.0)).w.max(0.0) / per_meter
    }

    /// The tint of light that has passed one texel, for a point at `depth` (1 nearest to the light).
    fn texel_tint(&self, face: usize, texel: DVec2, depth: f64) -> DVec3 {
        let clamped = texel.clamp(DVec2::ZERO, self.size - 1.0);
        if self.shadows.faces().len() == 1 && clamped != texel {
            return DVec3::ONE;
        }
        self.shadows
            .texel_tint(face, clamped.as_uvec2().to_array(), depth)
    }
}
