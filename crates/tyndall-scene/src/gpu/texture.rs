//! Textures on the device: base-colour textures with their mip chains, and lights' textures.

use half::f16;
use tyndall::cpu::LightTexture;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{Device, Features, Queue, TextureFormat, TextureUsages, TextureView};

use super::{error::GpuSceneError, targets::check_size};
use crate::{
    scene::{Texture, Wrap},
    texture::MipTexture,
};

/// Uploads a base-colour texture with all its mip levels.
pub(super) fn upload(
    device: &Device,
    queue: &Queue,
    index: usize,
    texture: &Texture,
) -> Result<TextureView, GpuSceneError> {
    let what = format!("texture {index}");
    check_size(device, &what, texture.size)?;
    check_count(&what, texture.size, texture.texels.len())?;
    Ok(create(device, queue, &what, &MipTexture::new(texture)))
}

/// Uploads the texture that materials without one sample.
pub(super) fn upload_white(device: &Device, queue: &Queue) -> TextureView {
    let white = MipTexture::new(&Texture {
        size: [1, 1],
        texels: vec![[255; 4]],
        wrap: [Wrap::ClampToEdge; 2],
    });
    create(device, queue, "white", &white)
}

fn create(device: &Device, queue: &Queue, label: &str, mips: &MipTexture) -> TextureView {
    let texels: Vec<[u8; 4]> = mips
        .levels()
        .iter()
        .flat_map(|level| level.texels.iter().copied())
        .collect();
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some(label),
            size: extent(mips.levels()[0].size),
            mip_level_count: mips.levels().len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: TextureFormat::Rgba8UnormSrgb,
            usage: TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        TextureDataOrder::LayerMajor,
        texels.as_flattened(),
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Uploads a light's texture: linear RGB, one level, in the most precise format that the device can filter
/// (`Rgba32Float`, else `Rgba16Float`).
///
/// # Errors
/// [`GpuSceneError`] if the texture is empty or beyond the device's limit, or has not as many texels as its size says.
pub fn upload_light_texture(
    device: &Device,
    queue: &Queue,
    texture: &LightTexture,
) -> Result<wgpu::Texture, GpuSceneError> {
    let what = "light texture";
    check_size(device, what, texture.size)?;
    check_count(what, texture.size, texture.texels.len())?;
    let texels = texture.texels.iter().map(|&[r, g, b]| [r, g, b, 1.0]);
    let (format, data) = if device.features().contains(Features::FLOAT32_FILTERABLE) {
        let data: Vec<[f32; 4]> = texels.collect();
        (
            TextureFormat::Rgba32Float,
            bytemuck::cast_slice(&data).to_vec(),
        )
    } else {
        let data: Vec<[u16; 4]> = texels
            .map(|t| t.map(|c| f16::from_f32(c).to_bits()))
            .collect();
        (
            TextureFormat::Rgba16Float,
            bytemuck::cast_slice(&data).to_vec(),
        )
    };
    Ok(device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some(what),
            size: extent(texture.size),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
            view_formats: &[],
        },
        TextureDataOrder::LayerMajor,
        &data,
    ))
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

fn check_count(what: &str, size: [u32; 2], found: usize) -> Result<(), GpuSceneError> {
    let expected = size[0] as usize * size[1] as usize;
    if found == expected {
        return Ok(());
    }
    Err(GpuSceneError::TexelCount {
        what: what.to_owned(),
        expected,
        found,
    })
}
