//! The adaptive mesh on the device, against its twin.

use tyndall_testkit::device::device_or_skip;

use super::{params::Params, twin::Face};
use crate::{
    CountValue, Effect, EffectOptions, FrameInputs, LightInputs, OutputPrecision,
    frame::{Camera, Emitter, Frame, Light, Medium, ShadowProjection},
    gpu::pass::Pass,
    techniques::{Technique, TechniqueChoice},
};

/// A depth texture that holds 0.5 everywhere.
fn flat(device: &wgpu::Device, queue: &wgpu::Queue, size: [u32; 2]) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &texture.create_view(&Default::default()),
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.5),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    queue.submit([encoder.finish()]);
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

#[test]
fn flat_maps_are_merged_as_by_the_twin_and_kept_while_they_stay() {
    let Some(gpu) = device_or_skip("the adaptive mesh") else {
        return;
    };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let options = EffectOptions {
        target_format: wgpu::TextureFormat::Rgba16Float,
        output: OutputPrecision::Full,
    };
    let effect = Effect::new(device, &options).expect("a blendable target");
    let mut view = effect.create_view(device, [4, 4]).expect("a good size");
    let depth = flat(device, queue, [4, 4]);
    let depth = depth.texture().create_view(&Default::default());
    let frame = Frame {
        camera: Camera::perspective(
            [0.0; 3],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            1.0,
            1.0,
            0.1,
            9.0,
        ),
        lights: vec![Light {
            emitter: Emitter::Directional {
                direction: [0.0, 0.0, 1.0],
                illuminance: [1.0; 3],
            },
            shadow: Some(ShadowProjection::Single {
                clip_from_world: glam::Mat4::IDENTITY.to_cols_array_2d(),
                reversed_depth: true,
            }),
            texture: None,
        }],
        medium: Medium {
            components: Vec::new(),
        },
    };
    let techniques = TechniqueChoice::from(Technique::LightVolume(Params::default()));
    for size in [[64, 64], [100, 60]] {
        let map = flat(device, queue, size);
        let twin = Face::new(size.map(|n| n + 1), 0.0, 0).triangles().len() as u32;
        // Frames: the map's revision, whether it is recorded, and whether its mesh is listed anew.
        for (revision, is_recorded, is_listed) in [
            (None, true, true),
            (Some(1), true, true),
            (Some(1), true, false),
            (Some(2), false, true),
            (Some(2), true, true),
            (Some(2), true, false),
            (None, true, true),
        ] {
            let light = LightInputs {
                shadow_map: Some(&map),
                shadow_revision: revision,
                ..LightInputs::default()
            };
            let inputs = FrameInputs {
                depth: &depth,
                lights: &[light],
            };
            effect
                .prepare(device, queue, &mut view, &inputs, &frame, &techniques)
                .expect("a good frame");
            let listing = |pass: &Pass| pass.name.contains("tessellation");
            assert_eq!(view.passes().iter().any(listing), is_listed, "{revision:?}");
            if !is_recorded {
                continue;
            }
            let mut encoder = device.create_command_encoder(&Default::default());
            effect.record(&mut encoder, &mut view, None);
            queue.submit([encoder.finish()]);
            let count = view.counts().iter().find(|c| c.name.contains("adaptive"));
            let Some(CountValue::Written { buffer, offset }) = count.map(|c| &c.value) else {
                unreachable!("the adaptive mesh is counted on the device");
            };
            let counts: Vec<u32> = gpu.read_buffer(buffer).expect("readable");
            assert_eq!(counts[*offset as usize / 4], twin, "{size:?}, {revision:?}");
        }
    }
}
