//! Materials and their textures.

use std::{collections::HashMap, io::Cursor};

use gltf::{material::AlphaMode, texture::WrappingMode};
use image::{ImageReader, Limits};

use super::{
    buffers::Buffers,
    error::{Refusal, broken, called},
};
use crate::scene::{Blocking, Material, Texture, Wrap};

/// Largest width and height of an image \[texels].
const MAX_IMAGE_SIDE: u32 = 16384;

/// glTF's `alphaCutoff` where it is left out.
const DEFAULT_ALPHA_CUTOFF: f32 = 0.5;

/// The materials that the scene uses, and their textures.
pub(super) struct Materials<'a> {
    buffers: &'a Buffers<'a>,
    materials: Vec<Material>,
    textures: Vec<Texture>,
    /// Scene index by the document's index (none: the default material).
    material_indices: HashMap<Option<usize>, usize>,
    texture_indices: HashMap<usize, usize>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(buffers: &'a Buffers<'a>) -> Self {
        Self {
            buffers,
            materials: Vec::new(),
            textures: Vec::new(),
            material_indices: HashMap::new(),
            texture_indices: HashMap::new(),
        }
    }

    /// The scene's index of a material, which is read when it is first asked for.
    pub(super) fn index_of(&mut self, source: &gltf::Material<'_>) -> Result<usize, Refusal> {
        if let Some(&index) = self.material_indices.get(&source.index()) {
            return Ok(index);
        }
        let place = source.index().map_or_else(
            || "default material".to_owned(),
            |index| called("material", index, source.name()),
        );
        let material = self
            .read(source)
            .map_err(|refusal| refusal.within(&place))?;
        self.materials.push(material);
        let index = self.materials.len() - 1;
        self.material_indices.insert(source.index(), index);
        Ok(index)
    }

    pub(super) fn into_parts(self) -> (Vec<Material>, Vec<Texture>) {
        (self.materials, self.textures)
    }

    fn read(&mut self, source: &gltf::Material<'_>) -> Result<Material, Refusal> {
        let surface = source.pbr_metallic_roughness();
        let base_color_texture = surface
            .base_color_texture()
            .map(|info| self.texture_index(&info.texture()))
            .transpose()?
            .flatten();
        let material = Material {
            base_color: surface.base_color_factor(),
            base_color_texture,
            blocking: blocking(source),
            emissive: emissive(source),
        };
        check_values(&material)?;
        Ok(material)
    }

    /// `None` for textures whose image only an extension knows.
    fn texture_index(&mut self, source: &gltf::Texture<'_>) -> Result<Option<usize>, Refusal> {
        if let Some(&index) = self.texture_indices.get(&source.index()) {
            return Ok(Some(index));
        }
        let Some(file) = self.buffers.image(source)? else {
            return Ok(None);
        };
        let (size, texels) = decode(&file.bytes)
            .map_err(|error| broken(file.place, format!("cannot be decoded: {error}")))?;
        let sampler = source.sampler();
        self.textures.push(Texture {
            size,
            texels,
            wrap: [sampler.wrap_s(), sampler.wrap_t()].map(wrap),
        });
        let index = self.textures.len() - 1;
        self.texture_indices.insert(source.index(), index);
        Ok(Some(index))
    }
}

fn blocking(source: &gltf::Material<'_>) -> Blocking {
    let transmission = source
        .transmission()
        .map_or(0.0, |transmission| transmission.transmission_factor());
    match source.alpha_mode() {
        _ if transmission != 0.0 => Blocking::Transmissive { transmission },
        AlphaMode::Opaque => Blocking::Opaque,
        AlphaMode::Mask => Blocking::Masked {
            cutoff: source.alpha_cutoff().unwrap_or(DEFAULT_ALPHA_CUTOFF),
        },
        AlphaMode::Blend => Blocking::Blended,
    }
}

/// An emissive texture mostly keeps all but a small part dark: without it, the surface is better off dark.
fn emissive(source: &gltf::Material<'_>) -> [f32; 3] {
    if source.emissive_texture().is_some() {
        return [0.0; 3];
    }
    let strength = source.emissive_strength().unwrap_or(1.0);
    source.emissive_factor().map(|factor| factor * strength)
}

fn check_values(material: &Material) -> Result<(), Refusal> {
    let unit = |x: f32| (0.0..=1.0).contains(&x);
    let refuse = |field: &str, expected: &str, found: String| {
        Err(broken(field, format!("must be {expected}, found {found}")))
    };
    if !material.base_color.iter().copied().all(unit) {
        let found = format!("{:?}", material.base_color);
        return refuse("baseColorFactor", "in [0, 1]", found);
    }
    if !material.emissive.iter().all(|&x| x.is_finite() && x >= 0.0) {
        let found = format!("{:?}", material.emissive);
        return refuse("emissiveFactor", "finite and at least 0", found);
    }
    match material.blocking {
        Blocking::Transmissive { transmission } if !unit(transmission) => {
            refuse("transmissionFactor", "in [0, 1]", transmission.to_string())
        }
        Blocking::Masked { cutoff } if !(cutoff.is_finite() && cutoff >= 0.0) => {
            refuse("alphaCutoff", "finite and at least 0", cutoff.to_string())
        }
        _ => Ok(()),
    }
}

/// Size and texels.
type Decoded = ([u32; 2], Vec<[u8; 4]>);

fn decode(bytes: &[u8]) -> image::ImageResult<Decoded> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_IMAGE_SIDE);
    limits.max_image_height = Some(MAX_IMAGE_SIDE);
    reader.limits(limits);
    let image = reader.decode()?.into_rgba8();
    let texels = image.pixels().map(|pixel| pixel.0).collect();
    Ok((image.dimensions().into(), texels))
}

fn wrap(mode: WrappingMode) -> Wrap {
    match mode {
        WrappingMode::ClampToEdge => Wrap::ClampToEdge,
        WrappingMode::MirroredRepeat => Wrap::MirroredRepeat,
        WrappingMode::Repeat => Wrap::Repeat,
    }
}
