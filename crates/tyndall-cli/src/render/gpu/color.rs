//! The engine's colour target.

use tyndall::gpu::PassTimer;
use wgpu::{CommandEncoder, Device, Texture, TextureFormat, TextureUsages, TextureView};

/// The engine's colour texture.
pub(super) struct ColorTarget {
    pub(super) texture: Texture,
    pub(super) view: TextureView,
}

impl ColorTarget {
    pub(super) fn new(device: &Device, [width, height]: [u32; 2], format: TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("colour target"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        Self { texture, view }
    }

    pub(super) fn bytes(&self) -> u64 {
        let texel = self.texture.format().block_copy_size(None).unwrap_or(0);
        u64::from(self.texture.width()) * u64::from(self.texture.height()) * u64::from(texel)
    }

    /// The pass that composites on what is there.
    pub(super) fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut CommandEncoder,
        timer: Option<&mut PassTimer>,
    ) -> wgpu::RenderPass<'encoder> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("composite"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            timestamp_writes: timer.and_then(|timer| timer.render_pass("composite")),
            ..Default::default()
        })
    }
}
