//! Bind group layouts that all passes share, and the pictures that stand in for inputs a light does not have.

use std::num::NonZeroU64;

use super::uniforms::{FrameUniform, LightUniform};

/// A uniform block of this type at `binding`, for all stages.
pub(crate) fn uniform<T>(binding: u32) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: NonZeroU64::new(size_of::<T>() as u64),
        },
    )
}

/// A storage buffer at `binding`; vertices only ever read one.
pub(crate) fn storage(binding: u32, read_only: bool) -> wgpu::BindGroupLayoutEntry {
    let buffer = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    if read_only {
        return entry(binding, buffer);
    }
    writable(binding, buffer)
}

/// What vertices may not see without a feature of their own.
fn writable(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    let mut entry = entry(binding, ty);
    entry.visibility.remove(wgpu::ShaderStages::VERTEX);
    entry
}

/// A 2-D texture that a compute shader writes, at `binding`.
pub(crate) fn storage_texture(
    binding: u32,
    format: wgpu::TextureFormat,
) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2,
    };
    writable(binding, ty)
}

/// A 2-D texture of floats at `binding` that is read texel by texel.
pub(crate) fn texels(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let texels = wgpu::TextureSampleType::Float { filterable: false };
    texture(binding, texels, wgpu::TextureViewDimension::D2)
}

/// An array of 2-D textures of floats at `binding` that is read texel by texel.
pub(crate) fn texel_layers(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let texels = wgpu::TextureSampleType::Float { filterable: false };
    texture(binding, texels, wgpu::TextureViewDimension::D2Array)
}

/// The airlight tables ([`AirlightPictures`](super::airlight::AirlightPictures)) at `binding`.
pub(crate) fn airlight(binding: u32) -> wgpu::BindGroupLayoutEntry {
    texel_layers(binding)
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    }
}

fn texture(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        },
    )
}

/// Bind group 0: the frame's uniforms, the depth buffer, the in-scattered light so far.
pub(crate) fn frame(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    use wgpu::{TextureSampleType as Sample, TextureViewDimension as Dimension};
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("tyndall frame"),
        entries: &[
            uniform::<FrameUniform>(0),
            texture(1, Sample::Depth, Dimension::D2),
            texture(2, Sample::Float { filterable: false }, Dimension::D2),
        ],
    })
}

/// Bind group 1: a light's uniforms, shadow map, glass and picture.
pub(crate) fn light(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    use wgpu::{TextureSampleType as Sample, TextureViewDimension as Dimension};
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("tyndall light"),
        entries: &[
            uniform::<LightUniform>(0),
            texture(1, Sample::Depth, Dimension::D2Array),
            texture(2, Sample::Uint, Dimension::D2Array),
            texture(3, Sample::Float { filterable: true }, Dimension::D2),
            entry(
                4,
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            ),
        ],
    })
}

/// What is bound where a light has no such picture.
pub(crate) struct Absent {
    pub(crate) shadow_map: wgpu::TextureView,
    pub(crate) glass: wgpu::TextureView,
    pub(crate) picture: wgpu::TextureView,
    pub(crate) light: wgpu::TextureView,
}

impl Absent {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let texel = |format, dimension| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("tyndall absent input"),
                size: wgpu::Extent3d::default(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(dimension),
                ..Default::default()
            })
        };
        use wgpu::{TextureFormat as Format, TextureViewDimension as Dimension};
        Self {
            shadow_map: texel(Format::Depth32Float, Dimension::D2Array),
            glass: texel(Format::Rg32Uint, Dimension::D2Array),
            picture: texel(Format::Rgba8Unorm, Dimension::D2),
            light: texel(Format::Rgba16Float, Dimension::D2),
        }
    }
}
