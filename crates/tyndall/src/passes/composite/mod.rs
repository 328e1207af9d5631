//! Draws the image behind the medium: background * transmittance + in-scattered light, `composite.wesl`.

use crate::gpu::{program::Raster, scope::Shared};

/// Two draws in the caller's pass: attenuate what is there, then add the light.
pub(crate) struct Composite {
    attenuate: wgpu::RenderPipeline,
    in_scatter: wgpu::RenderPipeline,
}

impl Composite {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared, target: wgpu::TextureFormat) -> Self {
        use wgpu::BlendFactor::{Dst, One, Zero};
        let shader = shared.shaders.get(device, "passes::composite::composite");
        let [frame_layout, _] = shared.bindings.layouts();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("composite"),
            bind_group_layouts: &[Some(frame_layout)],
            immediate_size: 0,
        });
        let component = |src_factor, dst_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor,
            operation: wgpu::BlendOperation::Add,
        };
        let pipeline = |entry_point, color| {
            let target = wgpu::ColorTargetState {
                format: target,
                blend: Some(wgpu::BlendState {
                    color,
                    alpha: component(Zero, One),
                }),
                write_mask: wgpu::ColorWrites::ALL,
            };
            let raster = Raster::full_screen(target);
            raster.pipeline(device, &shader.module, entry_point, &layout, &[])
        };
        Self {
            attenuate: pipeline("composite_attenuate", component(Dst, Zero)),
            in_scatter: pipeline("composite_in_scatter", component(One, One)),
        }
    }

    /// Draws with a frame bind group whose lights are the finished sum.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, frame: &wgpu::BindGroup) {
        pass.set_bind_group(0, frame, &[]);
        for pipeline in [&self.attenuate, &self.in_scatter] {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
    }
}
