//! The G-buffer of a camera: opaque surfaces, then the tint of the glass before them.

use tyndall::{frame::Camera, gpu::PassTimer};
use wgpu::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, Color, ColorTargetState, ColorWrites,
    CommandEncoder, Device, RenderPipeline,
};

use super::{
    mesh::DrawClass,
    pipeline::{ByDepth, Layouts, MeshPipeline, cleared, cleared_depth},
    shaders,
    targets::{
        BASE_COLOR_FORMAT, EMISSIVE_FORMAT, GBufferTargets, NORMAL_FORMAT, VIEW_TINT_FORMAT,
    },
    uploaded::UploadedScene,
    view::ViewUniform,
};

/// Multiplies the target's colour.
const MULTIPLY: BlendState = {
    let component = BlendComponent {
        src_factor: BlendFactor::Dst,
        dst_factor: BlendFactor::Zero,
        operation: BlendOperation::Add,
    };
    BlendState {
        color: component,
        alpha: component,
    }
};

pub(super) struct GBufferPipelines {
    opaque: ByDepth<RenderPipeline>,
    masked: ByDepth<RenderPipeline>,
    view_tint: ByDepth<RenderPipeline>,
}

impl GBufferPipelines {
    pub(super) fn new(device: &Device, layouts: &Layouts) -> Self {
        let layout = Layouts::pipeline(device, &[&layouts.view, &layouts.material]);
        let g_buffer = shaders::module(device, shaders::G_BUFFER);
        let surface = |label, masked: bool| {
            ByDepth::new(|reversed_depth| {
                MeshPipeline {
                    label,
                    layout: &layout,
                    module: &g_buffer,
                    fragment: Some("g_buffer_fragment"),
                    constants: &[("G_BUFFER_MASKED", masked.into())],
                    targets: &[NORMAL_FORMAT, BASE_COLOR_FORMAT, EMISSIVE_FORMAT]
                        .map(|format| Some(format.into())),
                    reversed_depth,
                    writes_depth: true,
                }
                .create(device)
            })
        };
        let tint = shaders::module(device, shaders::VIEW_TINT);
        Self {
            opaque: surface("g-buffer opaque", false),
            masked: surface("g-buffer masked", true),
            view_tint: ByDepth::new(|reversed_depth| {
                MeshPipeline {
                    label: "view tint",
                    layout: &layout,
                    module: &tint,
                    fragment: Some("view_tint_fragment"),
                    constants: &[],
                    targets: &[Some(ColorTargetState {
                        format: VIEW_TINT_FORMAT,
                        blend: Some(MULTIPLY),
                        write_mask: ColorWrites::ALL,
                    })],
                    reversed_depth,
                    writes_depth: false,
                }
                .create(device)
            }),
        }
    }

    pub(super) fn record(
        &self,
        scene: &UploadedScene,
        encoder: &mut CommandEncoder,
        targets: &GBufferTargets,
        camera: &Camera,
        mut timer: Option<&mut PassTimer>,
    ) {
        let reversed = camera.depth_range.is_reversed();
        let view = scene.view_bind_group(&ViewUniform::of_camera(camera));

        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("g-buffer"),
            color_attachments: &[&targets.normal, &targets.base_color, &targets.emissive]
                .map(|target| cleared(&target.view, Color::TRANSPARENT)),
            depth_stencil_attachment: Some(cleared_depth(
                &targets.depth.view,
                reversed,
                wgpu::StoreOp::Store,
            )),
            timestamp_writes: timer.as_deref_mut().and_then(|t| t.render_pass("g-buffer")),
            ..Default::default()
        });
        pass.set_bind_group(0, &view, &[]);
        pass.set_pipeline(self.opaque.get(reversed));
        scene.draw(&mut pass, DrawClass::Opaque);
        pass.set_pipeline(self.masked.get(reversed));
        scene.draw(&mut pass, DrawClass::Masked);
        drop(pass);

        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("view tint"),
            color_attachments: &[cleared(&targets.view_tint.view, Color::WHITE)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth.view,
                depth_ops: None,
                stencil_ops: None,
            }),
            timestamp_writes: timer.and_then(|t| t.render_pass("view tint")),
            ..Default::default()
        });
        pass.set_bind_group(0, &view, &[]);
        pass.set_pipeline(self.view_tint.get(reversed));
        scene.draw(&mut pass, DrawClass::Translucent);
    }
}
