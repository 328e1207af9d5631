//! The trees of the shadow map and of coloured glass, each made of a pyramid.

use std::sync::Arc;

use super::buffers::Buffers;
use crate::{
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    passes::pyramid::{self, Source},
    shader::constant,
};

pub(super) struct Rectify {
    pyramid: Arc<pyramid::Programs>,
    map: ComputeProgram,
    glass: ComputeProgram,
}

impl Rectify {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = || {
            let module = "techniques::min_max::rectify";
            ComputeProgram::new(device, shared, module, "min_max_rectify")
        };
        Self {
            pyramid: shared.programs(device),
            map: program(),
            glass: program().with("RECTIFY_GLASS", 1.0),
        }
    }

    /// The passes that make the trees of all textures the light sees.
    pub(super) fn passes(&self, scope: &mut LightScope<'_>, buffers: &Buffers) -> Vec<Pass> {
        let inputs = scope.inputs;
        let sources = [
            (Source::ShadowMap, inputs.shadow_map, &buffers.nodes),
            (Source::Glass, inputs.glass, &buffers.glass_nodes),
        ];
        let mut passes = Vec::new();
        for (source, view, nodes) in sources {
            if let Some(view) = view {
                let size = [view.texture().width(), view.texture().height()];
                passes.extend(self.trees(scope, buffers, source, size, nodes));
            }
        }
        passes
    }

    /// The passes that make trees of a texture of `size` texels a face.
    fn trees(
        &self,
        scope: &mut LightScope<'_>,
        buffers: &Buffers,
        source: Source,
        size: [u32; 2],
        nodes: &wgpu::Buffer,
    ) -> [Pass; 2] {
        let faces = scope.light.faces();
        let (pyramid, build) = pyramid::build(&self.pyramid, scope, source, size, faces);
        let (program, name) = match source {
            Source::ShadowMap => (&self.map, "shadow trees"),
            Source::Glass => (&self.glass, "glass trees"),
        };
        let resources = [
            buffers.grid.as_entire_binding(),
            wgpu::BindingResource::TextureView(&pyramid),
            nodes.as_entire_binding(),
        ];
        let grid = &buffers.epipolar;
        let threads = grid.samples.div_ceil(constant("RECTIFY_LEAVES"));
        let workgroups = program.workgroups([threads, grid.slices, 1]);
        [build, scope.compute(program, name, &resources, workgroups)]
    }
}
