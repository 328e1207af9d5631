//! The textures that passes draw on, of one size each.

use tyndall::{
    cpu::{GlassMap, ShadowMap},
    frame::ShadowProjection,
};
use wgpu::{Device, Queue, Texture, TextureFormat, TextureUsages, TextureView};

use super::{
    error::GpuSceneError,
    readback::{self, ReadbackError},
};

pub(super) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;
pub(super) const NORMAL_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
pub(super) const BASE_COLOR_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
pub(super) const EMISSIVE_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
pub(super) const VIEW_TINT_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
pub(super) const GLASS_FORMAT: TextureFormat = TextureFormat::Rg32Uint;

/// A texture and a view of all of it.
pub(super) struct Target {
    pub(super) texture: Texture,
    pub(super) view: TextureView,
}

impl Target {
    fn new(
        device: &Device,
        label: &str,
        size: [u32; 2],
        format: TextureFormat,
    ) -> Result<Self, GpuSceneError> {
        let texture = create_texture(device, label, size, 1, format)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { texture, view })
    }
}

/// A camera's G-buffer: the first opaque surface of each pixel, and the tint of the glass before it.
pub struct GBufferTargets {
    size: [u32; 2],
    pub(super) depth: Target,
    pub(super) normal: Target,
    pub(super) base_color: Target,
    pub(super) emissive: Target,
    pub(super) view_tint: Target,
}

impl GBufferTargets {
    /// Makes textures of this size \[pixels].
    ///
    /// # Errors
    /// [`GpuSceneError`] if the size is zero or beyond the device's limit.
    pub fn new(device: &Device, size: [u32; 2]) -> Result<Self, GpuSceneError> {
        let target = |label, format| Target::new(device, label, size, format);
        Ok(Self {
            size,
            depth: target("g-buffer depth", DEPTH_FORMAT)?,
            normal: target("g-buffer normal", NORMAL_FORMAT)?,
            base_color: target("g-buffer base colour", BASE_COLOR_FORMAT)?,
            emissive: target("g-buffer emissive", EMISSIVE_FORMAT)?,
            view_tint: target("g-buffer view tint", VIEW_TINT_FORMAT)?,
        })
    }

    /// Width and height \[pixels].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Depth (`Depth32Float`) in the camera's convention; the far plane's value without a surface.
    pub fn depth(&self) -> &Texture {
        &self.depth.texture
    }

    /// A view of [`GBufferTargets::depth`], as [`tyndall::FrameInputs`] takes it.
    pub fn depth_view(&self) -> &TextureView {
        &self.depth.view
    }

    /// World-space normals (`Rgba16Float`, unit length in rgb) that face the viewer; zero without a surface.
    pub fn normal(&self) -> &Texture {
        &self.normal.texture
    }

    /// Linear base colour (`Rgba16Float`); zero without a surface.
    pub fn base_color(&self) -> &Texture {
        &self.base_color.texture
    }

    /// Emitted radiance (`Rgba16Float`) [W/(m^2 sr)]; zero without a surface.
    pub fn emissive(&self) -> &Texture {
        &self.emissive.texture
    }

    /// Factor of the glass and blended surfaces on the light from the first opaque surface, or the sky (`Rgba16Float`, 1
    /// where there are none).
    pub fn view_tint(&self) -> &Texture {
        &self.view_tint.texture
    }

    /// Bytes of the textures.
    pub fn bytes(&self) -> u64 {
        [
            &self.depth,
            &self.normal,
            &self.base_color,
            &self.emissive,
            &self.view_tint,
        ]
        .map(|target| texture_bytes(&target.texture))
        .iter()
        .sum()
    }
}

/// A light's shadow map: depth of the first opaque surface, in the convention of its [`ShadowProjection`].
pub struct ShadowMapTarget {
    size: [u32; 2],
    texture: Texture,
    view: TextureView,
    pub(super) faces: Vec<TextureView>,
}

impl ShadowMapTarget {
    /// Makes the texture: `size` texels a face, one layer, or six for a cube.
    ///
    /// # Errors
    /// [`GpuSceneError`] if the size is zero or beyond the device's limit.
    pub fn new(
        device: &Device,
        projection: &ShadowProjection,
        size: [u32; 2],
    ) -> Result<Self, GpuSceneError> {
        let layers = face_count(projection);
        let texture = create_texture(device, "shadow map", size, layers, DEPTH_FORMAT)?;
        Ok(Self {
            size,
            view: array_view(&texture),
            faces: layer_views(&texture),
            texture,
        })
    }

    /// Width and height of a face \[texels].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The texture (`Depth32Float`): 1 layer, or 6 in the order of [`ShadowProjection::Cube`].
    pub fn texture(&self) -> &Texture {
        &self.texture
    }

    /// A 2-D array view of all layers, as [`tyndall::LightInputs`] takes it.
    pub fn view(&self) -> &TextureView {
        &self.view
    }

    /// The map as the CPU has it. Waits for the device.
    ///
    /// # Errors
    /// [`ReadbackError`].
    pub fn read(&self, device: &Device, queue: &Queue) -> Result<ShadowMap, ReadbackError> {
        Ok(ShadowMap {
            size: self.size,
            depth: readback::texture_f32(device, queue, &self.texture)?,
        })
    }

    /// Bytes of the texture.
    pub fn bytes(&self) -> u64 {
        texture_bytes(&self.texture)
    }
}

/// A light's coloured glass, some layers a face, nearest to the light first.
pub struct GlassMapTarget {
    texture: Texture,
    view: TextureView,
    /// Layers a face.
    pub(super) layers_a_face: usize,
    /// Layer `face * layers_a_face + layer`.
    pub(super) layers: Vec<TextureView>,
    /// Sorts the fragments of the layer being drawn.
    pub(super) depth: Target,
}

impl GlassMapTarget {
    /// Makes the texture: as many texels and faces as the light's shadow map, of a face's layers those that the scene can
    /// fill, [`super::SceneRenderer::glass_layers`].
    ///
    /// # Errors
    /// [`GpuSceneError`] if the number of layers is beyond the device's limit.
    pub fn new(
        device: &Device,
        shadow_map: &ShadowMapTarget,
        layers_a_face: u32,
    ) -> Result<Self, GpuSceneError> {
        let size = shadow_map.size();
        let layers = shadow_map.faces.len() as u32 * layers_a_face;
        let texture = create_texture(device, "glass map", size, layers, GLASS_FORMAT)?;
        Ok(Self {
            view: array_view(&texture),
            layers: layer_views(&texture),
            layers_a_face: layers_a_face as usize,
            depth: Target::new(device, "glass depth", size, DEPTH_FORMAT)?,
            texture,
        })
    }

    /// The texture, laid out as [`tyndall::LightInputs::glass`] says.
    pub fn texture(&self) -> &Texture {
        &self.texture
    }

    /// A 2-D array view of all layers, as [`tyndall::LightInputs`] takes it.
    pub fn view(&self) -> &TextureView {
        &self.view
    }

    /// The map as the CPU has it. Waits for the device.
    ///
    /// # Errors
    /// [`ReadbackError`].
    pub fn read(&self, device: &Device, queue: &Queue) -> Result<GlassMap, ReadbackError> {
        let words = readback::texture_u32(device, queue, &self.texture)?;
        let (texels, _) = words.as_chunks();
        Ok(GlassMap {
            size: [self.texture.width(), self.texture.height()],
            layers: self.layers_a_face as u32,
            texels: texels.iter().copied().map(unpack_glass).collect(),
        })
    }

    /// Bytes of the textures.
    pub fn bytes(&self) -> u64 {
        texture_bytes(&self.texture) + texture_bytes(&self.depth.texture)
    }
}

/// Depth's bits and the tint's square roots in 10 bits each, as the CPU has them: linear tint, then depth.
fn unpack_glass([depth, tint]: [u32; 2]) -> [f32; 4] {
    let [r, g, b] = [0, 10, 20].map(|shift| ((tint >> shift & 1023) as f32 / 1023.0).powi(2));
    [r, g, b, f32::from_bits(depth)]
}

fn face_count(projection: &ShadowProjection) -> u32 {
    match projection {
        ShadowProjection::Single { .. } => 1,
        ShadowProjection::Cube { .. } => 6,
    }
}

fn array_view(texture: &Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

fn layer_views(texture: &Texture) -> Vec<TextureView> {
    (0..texture.depth_or_array_layers())
        .map(|layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        })
        .collect()
}

/// A texture that is drawn on, sampled and read back.
fn create_texture(
    device: &Device,
    label: &str,
    size: [u32; 2],
    layers: u32,
    format: TextureFormat,
) -> Result<Texture, GpuSceneError> {
    check_size(device, label, size)?;
    let limit = device.limits().max_texture_array_layers;
    if layers > limit {
        return Err(GpuSceneError::TextureLayers {
            what: label.to_owned(),
            found: layers,
            limit,
        });
    }
    Ok(device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC,
        view_formats: &[],
    }))
}

/// Checks a texture's sides against the device's limit.
pub(super) fn check_size(device: &Device, what: &str, size: [u32; 2]) -> Result<(), GpuSceneError> {
    let limit = device.limits().max_texture_dimension_2d;
    if size.iter().all(|side| (1..=limit).contains(side)) {
        return Ok(());
    }
    Err(GpuSceneError::TextureSize {
        what: what.to_owned(),
        size,
        limit,
    })
}

fn texture_bytes(texture: &Texture) -> u64 {
    let texels = u64::from(texture.width())
        * u64::from(texture.height())
        * u64::from(texture.depth_or_array_layers());
    texels * u64::from(texture.format().block_copy_size(None).unwrap_or(0))
}
