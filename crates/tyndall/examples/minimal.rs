//! The smallest program that computes volumetric shadows on the GPU, with made-up inputs: nothing to be seen up to the
//! far plane, and a sun overhead that shines through slits. Prints the in-scattered light as characters.
//!
//! ```sh
//! cargo run --release -p tyndall --example minimal
//! ```

use std::{error::Error, sync::mpsc};

use tyndall::{
    Effect, EffectOptions, FrameInputs, LightInputs, OutputPrecision,
    frame::{Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase, ShadowProjection},
    techniques::TechniqueChoice,
};
use wgpu::util::{DeviceExt, DownloadBuffer, TextureDataOrder};

/// Width and height of the image \[pixels]; a row of 16-byte pixels is a multiple of 256 bytes, as copies want it.
const SIZE: [u32; 2] = [96, 32];
/// Side of the shadow map \[texels].
const MAP: u32 = 64;

fn main() -> Result<(), Box<dyn Error>> {
    let Some((device, queue)) = pollster::block_on(open()) else {
        eprintln!("skipped: there is no GPU adapter");
        return Ok(());
    };

    // Depth as a renderer would have drawn it. It is reversed: 0 is the far plane, 1 the near one.
    let depth = depth_texture(&device, &queue, SIZE, |_, _| 0.0);
    let slits = depth_texture(&device, &queue, [MAP; 2], |x, _| (x / 8 % 2) as f32);
    let (depth, shadow_map) = (view_of(&depth, false), view_of(&slits, true));
    let lights = [LightInputs {
        shadow_map: Some(&shadow_map),
        ..LightInputs::default()
    }];
    let inputs = FrameInputs {
        depth: &depth,
        lights: &lights,
    };

    let options = EffectOptions {
        target_format: wgpu::TextureFormat::Rgba16Float,
        output: OutputPrecision::Full,
    };
    let effect = Effect::new(&device, &options)?;
    let mut view = effect.create_view(&device, SIZE)?;
    effect.prepare(
        &device,
        &queue,
        &mut view,
        &inputs,
        &frame(),
        &TechniqueChoice::default(),
    )?;
    let mut encoder = device.create_command_encoder(&Default::default());
    effect.record(&mut encoder, &mut view, None);
    queue.submit([encoder.finish()]);

    let pixels = read(&device, &queue, view.output().texture())?;
    let brightest = pixels
        .iter()
        .fold(0.0, |most: f32, pixel| most.max(pixel[1]));
    for row in pixels.chunks_exact(SIZE[0] as usize) {
        let line: String = row.iter().map(|p| shade(p[1] / brightest)).collect();
        println!("{line}");
    }
    println!("brightest: {brightest:.4} W/(m^2 sr)");
    Ok(())
}

/// A camera on the ground in a haze, and a sun overhead whose map covers 10 m by 10 m.
fn frame() -> Frame {
    let aspect = SIZE[0] as f32 / (2 * SIZE[1]) as f32; // Characters are twice as high as wide.
    let sun = Emitter::Directional {
        direction: [0.0, -1.0, 0.0],
        illuminance: [10.0; 3],
    };
    // Column-major: x to the right, z down the map, and height to depth, 1 at 10 m and 0 at -10 m.
    let clip_from_world = [
        [0.2, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.05, 0.0],
        [0.0, -0.2, 0.0, 0.0],
        [0.0, 0.0, 0.5, 1.0],
    ];
    Frame {
        camera: Camera::perspective(
            [0.0, 0.0, 6.0],
            [0.0; 3],
            [0.0, 1.0, 0.0],
            1.0,
            aspect,
            0.1,
            12.0,
        ),
        lights: vec![Light {
            emitter: sun,
            shadow: Some(ShadowProjection::Single {
                clip_from_world,
                reversed_depth: true,
            }),
            texture: None,
        }],
        medium: Medium {
            components: vec![MediumComponent {
                sigma_s: [0.05; 3],
                sigma_a: [0.005; 3],
                phase: Phase::HenyeyGreenstein { g: 0.4 },
            }],
        },
    }
}

async fn open() -> Option<(wgpu::Device, wgpu::Queue)> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&Default::default()).await.ok()?;
    adapter.request_device(&Default::default()).await.ok()
}

/// A depth buffer with made-up values, in a format that can be written from memory.
fn depth_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    size: [u32; 2],
    value: impl Fn(u32, u32) -> f32,
) -> wgpu::Texture {
    let texels: Vec<u16> = (0..size[0] * size[1])
        .map(|i| (65535.0 * value(i % size[0], i / size[0])) as u16)
        .collect();
    let descriptor = wgpu::TextureDescriptor {
        label: Some("made-up depth"),
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth16Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let order = TextureDataOrder::LayerMajor;
    device.create_texture_with_data(queue, &descriptor, order, bytemuck::cast_slice(&texels))
}

/// Shadow maps are viewed as arrays, of one layer or of a cube's six.
fn view_of(texture: &wgpu::Texture, array: bool) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: array.then_some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// The values of an `Rgba32Float` texture.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let bytes_per_row = 16 * texture.width();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(bytes_per_row * texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes_per_row),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    let (sender, receiver) = mpsc::channel();
    DownloadBuffer::read_buffer(device, queue, &buffer.slice(..), move |result| {
        // The receiver outlives the poll below.
        let _ = sender.send(result);
    });
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(bytemuck::pod_collect_to_vec(&receiver.recv()??))
}

/// A character as bright as a share of the brightest pixel.
fn shade(share: f32) -> char {
    const RAMP: [char; 8] = [' ', '.', ':', '-', '=', '+', '*', '#'];
    RAMP[(share * (RAMP.len() - 1) as f32).round() as usize]
}
