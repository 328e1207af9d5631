//! Coloured glass seen from a light, peeled off layer by layer, nearest to the light first.

use tyndall::{
    frame::{Emitter, ShadowProjection},
    gpu::PassTimer,
};
use wgpu::{
    BindGroup, BindGroupLayout, Color, CommandEncoder, Device, RenderPipeline, TextureView,
};

use super::{
    mesh::DrawClass,
    pipeline::{ByDepth, Layouts, MeshPipeline, cleared, cleared_depth, far_depth},
    shaders,
    targets::{GLASS_FORMAT, GlassMapTarget, ShadowMapTarget},
    uploaded::UploadedScene,
    view::{ViewUniform, reversed_depth},
};
/// A tint of 1 as three 10-bit square roots.
const CLEAR_TINT: u32 = (1 << 30) - 1;

pub(super) struct GlassPipelines {
    group: BindGroupLayout,
    first: ByDepth<RenderPipeline>,
    further: ByDepth<RenderPipeline>,
}

impl GlassPipelines {
    pub(super) fn new(device: &Device, layouts: &Layouts) -> Self {
        let group = bind_group_layout(device);
        let layout = Layouts::pipeline(device, &[&layouts.view, &layouts.material, &group]);
        let module = shaders::module(device, shaders::GLASS);
        let pipeline = |label, first: bool| {
            ByDepth::new(|reversed_depth| {
                MeshPipeline {
                    label,
                    layout: &layout,
                    module: &module,
                    fragment: Some("glass_fragment"),
                    constants: &[
                        ("GLASS_FIRST_LAYER", first.into()),
                        ("GLASS_REVERSED_DEPTH", reversed_depth.into()),
                    ],
                    targets: &[Some(GLASS_FORMAT.into())],
                    reversed_depth,
                    writes_depth: true,
                }
                .create(device)
            })
        };
        Self {
            first: pipeline("glass first layer", true),
            further: pipeline("glass further layer", false),
            group,
        }
    }

    pub(super) fn record(
        &self,
        scene: &UploadedScene,
        encoder: &mut CommandEncoder,
        (target, shadow_map): (&GlassMapTarget, &ShadowMapTarget),
        (emitter, projection): (&Emitter, &ShadowProjection),
        mut timer: Option<&mut PassTimer>,
    ) {
        let reversed = reversed_depth(projection);
        let empty = Color {
            r: far_depth(reversed).to_bits().into(),
            g: CLEAR_TINT.into(),
            b: 0.0,
            a: 0.0,
        };
        let views = ViewUniform::of_light(emitter, projection);
        assert_eq!(
            (views.len(), views.len()),
            (
                shadow_map.faces.len(),
                target.layers.len() / target.layers_a_face
            ),
            "a glass map's targets must have the faces of its projection"
        );
        let faces = target.layers.chunks_exact(target.layers_a_face);
        for ((view, opaque), layers) in views.iter().zip(&shadow_map.faces).zip(faces) {
            let view = scene.view_bind_group(view);
            for (index, layer) in layers.iter().enumerate() {
                // The first layer ignores the one before it, but something must be bound.
                let before = &layers[index.checked_sub(1).unwrap_or(layers.len() - 1)];
                let group = self.bind_group(&scene.device, opaque, before);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("glass"),
                    color_attachments: &[cleared(layer, empty)],
                    depth_stencil_attachment: Some(cleared_depth(
                        &target.depth.view,
                        reversed,
                        wgpu::StoreOp::Discard,
                    )),
                    timestamp_writes: timer.as_deref_mut().and_then(|t| t.render_pass("glass")),
                    ..Default::default()
                });
                let pipeline = if index == 0 {
                    &self.first
                } else {
                    &self.further
                };
                pass.set_pipeline(pipeline.get(reversed));
                pass.set_bind_group(0, &view, &[]);
                pass.set_bind_group(2, &group, &[]);
                scene.draw(&mut pass, DrawClass::Translucent);
            }
        }
    }

    fn bind_group(&self, device: &Device, opaque: &TextureView, before: &TextureView) -> BindGroup {
        let entry = |binding, view| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("glass"),
            layout: &self.group,
            entries: &[entry(0, opaque), entry(1, before)],
        })
    }
}

fn bind_group_layout(device: &Device) -> BindGroupLayout {
    let entry = |binding, sample_type| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("glass"),
        entries: &[
            entry(0, wgpu::TextureSampleType::Depth),
            entry(1, wgpu::TextureSampleType::Uint),
        ],
    })
}
