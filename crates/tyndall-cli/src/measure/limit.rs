//! The limit: no technique that looks at all of its input can be faster than reading the depth buffer and the shadow map
//! once and writing the output once. One pass a light does just that.

use tyndall::gpu::PassTimer;
use wgpu::{BindGroup, CommandEncoder, Device, RenderPipeline, TextureFormat, TextureView};

use crate::render::gpu::World;

/// The pass, ready to be recorded any number of times.
pub(super) struct Limit {
    pipeline: RenderPipeline,
    /// One a light with a shadow map.
    lights: Vec<BindGroup>,
    output: TextureView,
}

impl Limit {
    pub(super) fn new(device: &Device, world: &World) -> Self {
        let format = TextureFormat::Rgba32Float;
        let pipeline = pipeline(device, format);
        let depth = world.g_buffer().depth();
        let lights = world.light_inputs(None);
        let maps = lights.iter().filter_map(|light| light.shadow_map);
        Self {
            lights: maps
                .map(|map| bind(device, &pipeline, world.g_buffer().depth_view(), map))
                .collect(),
            output: output(device, depth.size(), format),
            pipeline,
        }
    }

    pub(super) fn record(&self, encoder: &mut CommandEncoder, mut timer: Option<&mut PassTimer>) {
        for light in &self.lights {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("limit"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.output,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                timestamp_writes: timer.as_deref_mut().and_then(|t| t.render_pass("limit")),
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, light, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    /// Whether there is anything to read.
    pub(super) fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }
}

fn pipeline(device: &Device, format: TextureFormat) -> RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("limit.wgsl"));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("limit"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("limit_full_screen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("limit_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

fn bind(
    device: &Device,
    pipeline: &RenderPipeline,
    depth: &TextureView,
    shadow_map: &TextureView,
) -> BindGroup {
    let entry = |binding, view| wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("limit"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[entry(0, depth), entry(1, shadow_map)],
    })
}

fn output(device: &Device, size: wgpu::Extent3d, format: TextureFormat) -> TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("limit"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

#[cfg(test)]
mod tests {
    use tyndall_scene::gpu::readback;

    use super::*;
    use crate::{
        backend::Backend,
        measure::tests::{gpu_or_skip, shot_frame},
        render::{Needs, gpu::DeviceShot},
    };

    #[test]
    fn every_texel_of_the_depth_buffer_and_the_shadow_map_is_read_once() {
        let Some(Backend::Gpu(gpu)) = gpu_or_skip("the limit") else {
            return;
        };
        let shot_frame = shot_frame();
        let shot = DeviceShot::new(&shot_frame, &gpu, Needs::IN_SCATTER).unwrap();
        let limit = Limit::new(&gpu.device, &shot.world);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        shot.draw(&shot_frame, &mut encoder, None);
        limit.record(&mut encoder, None);
        gpu.queue.submit([encoder.finish()]);
        let output = readback::texture_f32(&gpu.device, &gpu.queue, limit.output.texture());
        let output = output.unwrap();
        let read = shot.world.read(&gpu).unwrap();
        let map = &read.lights[0].shadow_map.as_ref().unwrap().depth;
        let sum = |values: &[f32]| values.iter().copied().map(f64::from).sum::<f64>();
        let (found, expected) = (sum(&output) / 4.0, sum(&read.depth) + sum(map));
        eprintln!("found {found}, expected {expected}");
        assert!(expected > 1e3);
        // lavapipe: 2.4e-9, for the sums of a pixel are rounded to f32.
        assert!((found / expected - 1.0).abs() < 5e-9);
    }
}
