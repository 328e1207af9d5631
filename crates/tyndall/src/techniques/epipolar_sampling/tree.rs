//! Stage 7: the min/max trees of all slices.

use super::{
    resources::{Resources, buffer},
    sizes::Sizes,
};
use crate::{
    gpu::{
        pass::{Dispatch, Pass},
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::{block, constant},
};

block! {
    /// The shaders' `TreeParams`.
    pub(crate) struct TreeUniform = "TreeParams" in "tyndall::techniques::epipolar_sampling::tree", checked by tree_params_is_laid_out_as_in_wgsl {
        pub(crate) base: u32,
        pad: [u32; 3],
    }
}

/// Names of the dispatches' uniforms, enough for the highest tree.
const NAMES: [&str; 4] = ["tree 0", "tree 4", "tree 8", "tree 12"];

pub(super) struct Tree(ComputeProgram);

impl Tree {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::tree";
        Self(ComputeProgram::new(device, shared, module, "sampling_tree"))
    }

    /// The dispatches that build all trees, from the leaves up.
    pub(super) fn pass(&self, scope: &mut LightScope<'_>, sizes: &Sizes, r: &Resources) -> Pass {
        let levels = constant("SAMPLING_TREE_LEVELS");
        let starts = (0..sizes.levels).step_by(levels as usize);
        let dispatch = |(base, name): (u32, &'static str)| -> Dispatch {
            let uniform = scope.uniform(name, &TreeUniform { base, pad: [0; 3] });
            let subtrees = (sizes.columns >> base).div_ceil(1 << levels);
            let rows = sizes.slices * sizes.charts;
            let resources = [
                buffer(&r.params),
                buffer(&uniform),
                buffer(&r.traces),
                buffer(&r.nodes),
            ];
            let workgroups = self.0.workgroups([subtrees, rows, 1]);
            scope.dispatch(&self.0, &resources, workgroups)
        };
        let dispatches = starts.zip(NAMES).map(dispatch).collect();
        Pass::compute(scope.pass_name("min/max tree"), dispatches)
    }
}
