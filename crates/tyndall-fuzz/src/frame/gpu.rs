//! A frame on the GPU.

use std::sync::LazyLock;

use tyndall::{
    Effect, EffectOptions, FrameInputs, LightInputs, Occluder, OccluderMesh, OutputPrecision,
    PointCloud, frame::LightKind,
};
use tyndall_testkit::device::{TestDevice, device};
use wgpu::{
    TextureFormat,
    util::{BufferInitDescriptor, DeviceExt, TextureDataOrder},
};

use super::{
    checked,
    drawn::{Drawn, Pictures},
};
use crate::outcome::Outcome;

/// The device and the effect, made once; `None` where there is no driver.
static GPU: LazyLock<Option<(&'static TestDevice, Effect)>> = LazyLock::new(|| {
    let gpu = device().ok()?;
    let options = EffectOptions {
        target_format: TextureFormat::Rgba16Float,
        output: OutputPrecision::Full,
    };
    Some((gpu, Effect::new(&gpu.device, &options).ok()?))
});

/// Computes a frame drawn from bytes; `None` where there is no driver.
pub fn run(bytes: &[u8]) -> Option<Outcome> {
    let (gpu, effect) = GPU.as_ref()?;
    let drawn = Drawn::new(bytes);
    let textures: Vec<_> = drawn.lights.iter().map(|p| textures(gpu, p)).collect();
    let points = gpu.device.create_buffer_init(&BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&drawn.points),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let corners: Vec<[f32; 3]> = drawn.points.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
    let mesh = OccluderMesh::new(&gpu.device, &corners, &[0, 1, 2, 2, 3, 4, 5, 4, 3]).ok();
    let occluders = mesh.as_ref().map(|mesh| {
        let mut world_from_mesh = [[0.0; 4]; 4];
        (0..4).for_each(|i| world_from_mesh[i][i] = 1.0);
        [Occluder {
            mesh,
            world_from_mesh,
        }]
    });
    let lights: Vec<_> = drawn
        .frame
        .lights
        .iter()
        .zip(&textures)
        .map(|(light, [map, glass, texture])| LightInputs {
            shadow_map: map.as_ref(),
            glass: glass.as_ref(),
            texture: texture.as_ref(),
            occluders: occluders.as_ref().map(|list| &list[..]),
            points: (light.kind() == LightKind::Rect).then_some(PointCloud {
                points: &points,
                map_side: 16,
            }),
            shadow_revision: None,
        })
        .collect();
    let depth = depth(gpu, drawn.size, 1, &drawn.depth).create_view(&Default::default());
    let inputs = FrameInputs {
        depth: &depth,
        lights: &lights,
    };
    let Ok(mut view) = effect.create_view(&gpu.device, drawn.size) else {
        return Some(Outcome::Refused);
    };
    let (device, queue) = (&gpu.device, &gpu.queue);
    if effect
        .prepare(
            device,
            queue,
            &mut view,
            &inputs,
            &drawn.frame,
            &drawn.techniques,
        )
        .is_err()
    {
        return Some(Outcome::Refused);
    }
    let mut encoder = device.create_command_encoder(&Default::default());
    effect.record(&mut encoder, &mut view, None);
    queue.submit([encoder.finish()]);
    let pixels: Vec<[f32; 4]> = gpu
        .read_texture(view.output().texture())
        .expect("the device works");
    Some(checked(&pixels, &(&drawn.frame, &drawn.techniques)))
}

/// Shadow map, glass and texture.
fn textures(gpu: &TestDevice, pictures: &Pictures) -> [Option<wgpu::TextureView>; 3] {
    let map = pictures.shadow_map.as_ref().map(|map| {
        let faces = map.depth.len() as u32 / (map.size[0] * map.size[1]);
        array(&depth(gpu, map.size, faces, &map.depth))
    });
    let glass = pictures.glass.as_ref().map(|glass| {
        let root = |x: f32| (x.clamp(0.0, 1.0).sqrt() * 1023.0) as u32;
        let pack =
            |&[r, g, b, z]: &[f32; 4]| [z.to_bits(), root(r) | root(g) << 10 | root(b) << 20];
        let texels: Vec<[u32; 2]> = glass.texels.iter().map(pack).collect();
        let layers = texels.len() as u32 / (glass.size[0] * glass.size[1]);
        array(&upload(
            gpu,
            TextureFormat::Rg32Uint,
            glass.size,
            layers,
            bytemuck::cast_slice(&texels),
        ))
    });
    let texture = pictures.texture.as_ref().map(|texture| {
        let byte = |x: f32| (255.0 * x) as u8;
        let texels: Vec<[u8; 4]> = texture
            .texels
            .iter()
            .map(|t| [byte(t[0]), byte(t[1]), byte(t[2]), 255])
            .collect();
        let bytes = bytemuck::cast_slice(&texels);
        upload(gpu, TextureFormat::Rgba8UnormSrgb, texture.size, 1, bytes)
            .create_view(&Default::default())
    });
    [map, glass, texture]
}

/// A depth texture of a format that can be written from memory.
fn depth(gpu: &TestDevice, size: [u32; 2], layers: u32, values: &[f32]) -> wgpu::Texture {
    let texels: Vec<u16> = values.iter().map(|x| (65535.0 * x) as u16).collect();
    upload(
        gpu,
        TextureFormat::Depth16Unorm,
        size,
        layers,
        bytemuck::cast_slice(&texels),
    )
}

fn array(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

fn upload(
    gpu: &TestDevice,
    format: TextureFormat,
    [width, height]: [u32; 2],
    layers: u32,
    bytes: &[u8],
) -> wgpu::Texture {
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    gpu.device.create_texture_with_data(
        &gpu.queue,
        &descriptor,
        TextureDataOrder::LayerMajor,
        bytes,
    )
}
