//! Pictures as textures: mip chains of base-colour textures, and lights' textures.

use half::f16;
use tyndall::cpu::LightTexture;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{Device, Features, Queue, TextureFormat, TextureUsages, TextureView};

use super::{error::GpuSceneError, targets::check_size};
use crate::scene::Texture;

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
    let levels = mip_levels(texture);
    Ok(create(device, queue, &what, texture.size, &levels))
}

/// What a material without a texture samples.
pub(super) fn upload_white(device: &Device, queue: &Queue) -> TextureView {
    create(device, queue, "white", [1, 1], &[vec![[255; 4]]])
}

fn create(
    device: &Device,
    queue: &Queue,
    label: &str,
    size: [u32; 2],
    levels: &[Vec<[u8; 4]>],
) -> TextureView {
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some(label),
            size: extent(size),
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: TextureFormat::Rgba8UnormSrgb,
            usage: TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        TextureDataOrder::LayerMajor,
        levels.concat().as_flattened(),
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// All levels of a picture, sRGB-encoded as the picture itself; each is the box-filtered one before it, in linear light.
fn mip_levels(texture: &Texture) -> Vec<Vec<[u8; 4]>> {
    let linear: [f32; 256] = std::array::from_fn(|code| linear_from_srgb(code as f32 / 255.0));
    let decode = |&[r, g, b, a]: &[u8; 4]| {
        let [r, g, b] = [r, g, b].map(|code| linear[usize::from(code)]);
        [r, g, b, f32::from(a) / 255.0]
    };
    let encode = |&[r, g, b, a]: &[f32; 4]| {
        let [r, g, b] = [r, g, b].map(srgb_from_linear);
        [r, g, b, a].map(|value| (value * 255.0).round() as u8)
    };
    let mut levels = vec![texture.texels.clone()];
    let mut size = texture.size;
    let mut texels: Vec<[f32; 4]> = texture.texels.iter().map(decode).collect();
    while size != [1, 1] {
        (size, texels) = halve(size, &texels);
        levels.push(texels.iter().map(encode).collect());
    }
    levels
}

/// The next mip level: each texel is the mean of those it covers (2 x 2; up to 3 a side where a side is odd).
fn halve(size: [u32; 2], texels: &[[f32; 4]]) -> ([u32; 2], Vec<[f32; 4]>) {
    let half = size.map(|side| (side / 2).max(1));
    let covered = |axis: usize, i: u32| {
        let scale = |i: u32| (u64::from(i) * u64::from(size[axis]) / u64::from(half[axis])) as u32;
        scale(i)..scale(i + 1)
    };
    let mean = |x: u32, y: u32| {
        let mut sum = [0.0; 4];
        let mut count = 0.0;
        for row in covered(1, y) {
            for column in covered(0, x) {
                let texel = texels[(row * size[0] + column) as usize];
                sum = std::array::from_fn(|c| sum[c] + texel[c]);
                count += 1.0;
            }
        }
        sum.map(|s| s / count)
    };
    let next = (0..half[1])
        .flat_map(|y| (0..half[0]).map(move |x| (x, y)))
        .map(|(x, y)| mean(x, y))
        .collect();
    (half, next)
}

/// IEC 61966-2-1.
fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// IEC 61966-2-1.
fn srgb_from_linear(value: f32) -> f32 {
    if value <= 0.003_130_8 {
        12.92 * value
    } else {
        1.055 * value.powf(1.0 / 2.4) - 0.055
    }
}

/// Uploads a light's texture: linear RGB, one level, in the most precise format that the device can filter
/// (`Rgba32Float`, else `Rgba16Float`).
///
/// # Errors
/// Where the texture is empty or beyond the device's limit, or has not as many texels as its size says.
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
