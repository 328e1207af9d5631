//! The GPU's techniques against their CPU twins, and the composite against its formula.

mod common;

use common::{SIZE, crowd, gpu as on, stages, steps, technique};
use tyndall::{CreateError, FrameInputs, camera::CameraRays, techniques::Value};
use tyndall_testkit::{device::device_or_skip, metrics::compare};

/// Same steps, same map; what differs is f32 against f64: texels and depths at a border that fall to the other side.
#[test]
fn marching_agrees_with_the_cpu() {
    let Some(gpu) = device_or_skip("ray march on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in stages().into_iter().chain([crowd()]) {
        for spacing in ["equal", "equiangular"] {
            let spacing = ("spacing", Value::Word(spacing.into()));
            let march = technique("ray-march", &[steps(128), spacing.clone()]);
            let ours = on::on_gpu(gpu, &effect, &stage, march.clone());
            let error = compare(&ours, &stage.on_cpu(march))
                .expect("same size")
                .rel_mae;
            // Largest measured on lavapipe: 8e-4.
            assert!(error < 2e-3, "{}, {spacing:?}: {error}", stage.name);
        }
    }
}

#[test]
fn alpha_is_the_mean_transmittance() {
    let Some(gpu) = device_or_skip("transmittance on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    let mut stage = crowd();
    stage.frame.lights.clear();
    stage.lights.clear();
    let rays = CameraRays::new(&stage.frame.camera, SIZE);
    let optics = tyndall::physics::medium::Optics::new(&stage.frame.medium);
    let output = on::output(gpu, &effect, &stage, technique("ray-march", &[steps(1)]));
    for (i, pixel) in output.iter().enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let ray = rays.ray(x, y, stage.depth[i]);
        let mean = optics.transmittance(ray.length).element_sum() / 3.0;
        assert_eq!(pixel[..3], [0.0; 3]);
        assert!(
            (f64::from(pixel[3]) - mean).abs() < 1e-5,
            "{pixel:?} {mean}"
        );
    }
}

#[test]
fn composite_attenuates_and_adds_per_channel() {
    let Some(gpu) = device_or_skip("composite on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    let stage = crowd();
    let uploaded = on::Uploaded::new(gpu, &stage);
    let lights = uploaded.light_inputs();
    let inputs = FrameInputs {
        depth: &uploaded.depth,
        lights: &lights,
    };
    let mut view = effect.create_view(&gpu.device, SIZE).expect("a good size");
    effect
        .prepare(&gpu.device, &gpu.queue, &mut view, &inputs, &stage.frame)
        .expect("a good stage");
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: SIZE[0],
            height: SIZE[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: on::TARGET,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let background = wgpu::Color {
        r: 1.0,
        g: 2.0,
        b: 4.0,
        a: 0.5,
    };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    effect.record(&mut encoder, &mut view, None);
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(background),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        effect.composite(&mut pass, &view);
    }
    gpu.queue.submit([encoder.finish()]);
    let composed: Vec<[u16; 4]> = gpu.read_texture(&target).expect("readable");
    let in_scatter: Vec<[f32; 4]> = gpu.read_texture(view.output().texture()).expect("readable");

    let rays = CameraRays::new(&stage.frame.camera, SIZE);
    let optics = tyndall::physics::medium::Optics::new(&stage.frame.medium);
    for (i, (found, light)) in composed.iter().zip(&in_scatter).enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let left = optics
            .transmittance(rays.ray(x, y, stage.depth[i]).length)
            .to_array();
        for channel in 0..3 {
            let exact = [1.0, 2.0, 4.0][channel] * left[channel] + f64::from(light[channel]);
            let found = half::f16::from_bits(found[channel]).to_f64();
            // Two roundings to 11 bits, which some drivers do by cutting off.
            assert!(
                (found - exact).abs() < 2.2e-3 * exact,
                "{channel}: {found} {exact}"
            );
        }
        assert_eq!(half::f16::from_bits(found[3]).to_f32(), 0.5);
    }
}

#[test]
fn what_cannot_be_made_is_refused() {
    let Some(gpu) = device_or_skip("refusals on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    let limit = gpu.device.limits().max_texture_dimension_2d;
    for size in [[0, 4], [4, limit + 1]] {
        let refused = effect.create_view(&gpu.device, size).err();
        assert_eq!(refused, Some(CreateError::Size { size, limit }));
    }
    let stage = crowd();
    let uploaded = on::Uploaded::new(gpu, &stage);
    let lights = uploaded.light_inputs();
    let mut view = effect
        .create_view(&gpu.device, [8, 8])
        .expect("a good size");
    let mut refusal = |lights: &[tyndall::LightInputs<'_>], technique| {
        let frame = tyndall::frame::Frame {
            technique,
            ..stage.frame.clone()
        };
        let inputs = FrameInputs {
            depth: &uploaded.depth,
            lights,
        };
        effect
            .prepare(&gpu.device, &gpu.queue, &mut view, &inputs, &frame)
            .expect_err("refused")
            .to_string()
    };
    assert_eq!(
        refusal(&lights, technique("ray-march", &[])),
        "`inputs.depth` must be a texture of the view's size, found [48, 36]"
    );
    assert_eq!(
        refusal(&lights, technique("reference", &[])),
        "technique `reference` cannot do its work on the GPU"
    );
}
