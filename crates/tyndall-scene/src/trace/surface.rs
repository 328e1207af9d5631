//! A material's effect on light, ready for lookups.

use glam::{DVec2, DVec3, DVec4};

use crate::{
    scene::{Blocking, Material},
    texture::MipTexture,
};

/// A material, with f64 factors and the tint it has where no texture varies it.
pub(super) struct Surface {
    base_color: DVec4,
    texture: Option<usize>,
    blocking: Blocking,
    /// Emitted radiance [W/(m^2 sr)].
    pub(super) emissive: [f32; 3],
    /// Tint of the surface if it is one all over.
    pub(super) uniform: Option<DVec3>,
}

impl Surface {
    pub(super) fn new(material: &Material, textures: &[MipTexture]) -> Self {
        let mut surface = Self {
            base_color: DVec4::from(material.base_color.map(f64::from)),
            texture: material.base_color_texture,
            blocking: material.blocking,
            emissive: material.emissive,
            uniform: None,
        };
        surface.uniform = surface.uniform_tint(textures);
        surface
    }

    /// True if light and view rays can end here.
    pub(super) fn can_block(&self) -> bool {
        match self.blocking {
            Blocking::Opaque | Blocking::Masked { .. } => self.uniform != Some(DVec3::ONE),
            Blocking::Transmissive { .. } | Blocking::Blended => false,
        }
    }

    /// True if it is glass that changes the light's colour somewhere.
    pub(super) fn is_tinted_glass(&self) -> bool {
        match self.blocking {
            Blocking::Opaque | Blocking::Masked { .. } => false,
            Blocking::Transmissive { .. } | Blocking::Blended => self.uniform != Some(DVec3::ONE),
        }
    }

    /// The material's texture.
    pub(super) fn texture<'a>(&self, textures: &'a [MipTexture]) -> Option<&'a MipTexture> {
        self.texture.map(|t| &textures[t])
    }

    /// Linear RGBA at a level of detail.
    pub(super) fn color(&self, textures: &[MipTexture], uv: DVec2, lod: f64) -> DVec4 {
        self.texture(textures)
            .map_or(DVec4::ONE, |t| t.trilinear(uv, lod))
            * self.base_color
    }

    /// Linear RGBA at one level of the texture.
    pub(super) fn color_at_level(&self, textures: &[MipTexture], uv: DVec2, level: usize) -> DVec4 {
        self.texture(textures)
            .map_or(DVec4::ONE, |t| t.bilinear(uv, level))
            * self.base_color
    }

    /// Factor on light where the surface has this colour: zero where it blocks, one where it is not there.
    pub(super) fn tint(&self, color: DVec4) -> DVec3 {
        let [r, g, b, alpha] = color.to_array();
        let rgb = DVec3::new(r, g, b);
        match self.blocking {
            Blocking::Opaque => DVec3::ZERO,
            Blocking::Masked { cutoff } if alpha >= f64::from(cutoff) => DVec3::ZERO,
            Blocking::Masked { .. } => DVec3::ONE,
            Blocking::Transmissive { transmission } => f64::from(transmission) * rgb,
            Blocking::Blended => DVec3::ONE - alpha * (DVec3::ONE - rgb),
        }
    }

    /// Factor on light at a point of the surface.
    pub(super) fn tint_at(&self, textures: &[MipTexture], uv: DVec2) -> DVec3 {
        self.uniform
            .unwrap_or_else(|| self.tint(self.color_at_level(textures, uv, 0)))
    }

    /// Smallest alpha that blocks, for a surface with holes.
    pub(super) fn cutoff(&self) -> Option<f64> {
        match self.blocking {
            Blocking::Masked { cutoff } => Some(f64::from(cutoff)),
            _ => None,
        }
    }

    fn uniform_tint(&self, textures: &[MipTexture]) -> Option<DVec3> {
        let Some(texture) = self.texture(textures) else {
            return Some(self.tint(self.base_color));
        };
        if self.blocking == Blocking::Opaque {
            return Some(DVec3::ZERO);
        }
        let mut texels = texture.levels()[0].texels.iter();
        let first = texels.next()?;
        let same = texels.all(|t| t == first);
        same.then(|| self.tint(self.color_at_level(textures, DVec2::ZERO, 0)))
    }
}
