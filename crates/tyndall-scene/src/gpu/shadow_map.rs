//! Shadow maps: the depth of the first opaque surface seen from a light, as [`shadow_fit`](crate::shadow_fit) says.

use tyndall::{
    frame::{Emitter, ShadowProjection},
    gpu::PassTimer,
};
use wgpu::{CommandEncoder, Device, RenderPipeline};

use super::{
    mesh::DrawClass,
    pipeline::{ByDepth, Layouts, MeshPipeline, cleared_depth},
    shaders,
    targets::ShadowMapTarget,
    uploaded::UploadedScene,
    view::{ViewUniform, reversed_depth},
};

pub(super) struct ShadowMapPipelines {
    opaque: ByDepth<RenderPipeline>,
    masked: ByDepth<RenderPipeline>,
}

impl ShadowMapPipelines {
    pub(super) fn new(device: &Device, layouts: &Layouts) -> Self {
        let module = shaders::module(device, shaders::SHADOW_MAP);
        let opaque = Layouts::pipeline(device, &[&layouts.view]);
        let masked = Layouts::pipeline(device, &[&layouts.view, &layouts.material]);
        let pipeline = |label, layout, fragment| {
            ByDepth::new(|reversed_depth| {
                MeshPipeline {
                    label,
                    layout,
                    module: &module,
                    fragment: Some(fragment),
                    constants: &[(
                        "SHADOW_MAP_TOWARDS_LIGHT",
                        if reversed_depth { 1.0 } else { -1.0 },
                    )],
                    targets: &[],
                    reversed_depth,
                    writes_depth: true,
                }
                .create(device)
            })
        };
        Self {
            opaque: pipeline("shadow map opaque", &opaque, "shadow_map_opaque_fragment"),
            masked: pipeline("shadow map masked", &masked, "shadow_map_masked_fragment"),
        }
    }

    pub(super) fn record(
        &self,
        scene: &UploadedScene,
        encoder: &mut CommandEncoder,
        target: &ShadowMapTarget,
        (emitter, projection): (&Emitter, &ShadowProjection),
        mut timer: Option<&mut PassTimer>,
    ) {
        let reversed = reversed_depth(projection);
        let views = ViewUniform::of_light(emitter, projection);
        assert_eq!(
            views.len(),
            target.faces.len(),
            "a shadow map's target must have the faces of its projection"
        );
        for (view, face) in views.iter().zip(&target.faces) {
            let view = scene.view_bind_group(view);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadow map"),
                depth_stencil_attachment: Some(cleared_depth(face, reversed, wgpu::StoreOp::Store)),
                timestamp_writes: timer
                    .as_deref_mut()
                    .and_then(|t| t.render_pass("shadow map")),
                ..Default::default()
            });
            pass.set_bind_group(0, &view, &[]);
            pass.set_pipeline(self.opaque.get(reversed));
            scene.draw_plain(&mut pass, DrawClass::Opaque);
            pass.set_pipeline(self.masked.get(reversed));
            scene.draw(&mut pass, DrawClass::Masked);
        }
    }
}
