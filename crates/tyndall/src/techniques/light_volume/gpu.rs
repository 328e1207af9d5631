//! The GPU side: the boundary of the shadow volume drawn additively, then one full-screen pass a light.

use super::{
    check::check, extent::Extent, grow, list, panes, params::Params, resolve, split, surface,
    tree::Tree,
};
use crate::{
    error::PrepareError,
    gpu::{
        cache,
        pass::{LightPasses, Pass},
        pool::Owner,
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
    },
    inputs::CountValue,
    techniques::method::{GpuMethod, LightRequest},
};

/// The technique's shaders.
struct Programs {
    split: ComputeProgram,
    grow: ComputeProgram,
    list: list::Programs,
    surface: surface::Programs,
    panes: ComputeProgram,
    resolve: ScreenProgram,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            split: split::program(device, shared),
            grow: grow::program(device, shared),
            list: list::Programs::new(device, shared),
            surface: surface::Programs::new(device, shared),
            panes: panes::program(device, shared),
            resolve: resolve::program(device, shared),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        check(self, request)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let mut passes = Vec::new();
    let mut sum = scope.shared.bindings.no_light().clone();
    if let Some(extent) = extent(scope) {
        sum = surface::sum_texture(&programs.surface, scope);
        let bits = programs.surface.bits_of_sum();
        scope.count("bits of a sum,", CountValue::Known(bits));
        let mesh = Mesh::new(params, scope, extent);
        if let Some(tree) = mesh.tree.as_ref().filter(|_| !mesh.is_kept) {
            passes.push(mesh.tessellate(tree, programs, scope));
        }
        passes.push(mesh.draw(programs, scope, &sum));
    }
    let (panes, find_panes) = panes::pass(&programs.panes, scope);
    passes.extend(find_panes);
    let last = resolve::pass(&programs.resolve, &sum, &panes, scope);
    LightPasses::new(passes, last)
}

/// The light's mesh; `None` without shadow map.
fn extent(scope: &LightScope<'_>) -> Option<Extent> {
    let map = scope.inputs.shadow_map?.texture();
    Extent::new(scope.light, [map.width(), map.height()], scope.rays)
}

/// One light's mesh.
struct Mesh {
    extent: Extent,
    params: wgpu::Buffer,
    /// `None` where no cells are merged.
    tree: Option<Tree>,
    /// True where the frame before listed the same triangles.
    is_kept: bool,
}

impl Mesh {
    fn new(params: &Params, scope: &mut LightScope<'_>, extent: Extent) -> Self {
        let capacity = extent.capacity(&scope.device.limits());
        let uniform = extent.uniform(params.tolerance, capacity);
        let tree = (params.tolerance > 0.0).then(|| Tree::new(scope, &extent, capacity));
        let made_of = (
            scope.inputs.shadow_revision,
            scope.light.shadow,
            extent.cells,
            params.tolerance,
        );
        let key = (Owner::Light(scope.index), "light volume is made of");
        let is_kept = made_of.0.is_some() && scope.pool.is_as_noted(key, made_of);
        let mesh = Self {
            extent,
            params: scope.uniform("light volume params", &uniform),
            tree,
            is_kept,
        };
        mesh.count(scope);
        mesh
    }

    fn count(&self, scope: &mut LightScope<'_>) {
        let full = CountValue::Known(self.extent.full_triangles());
        scope.count("surface triangles, full,", full);
        if let Some(tree) = &self.tree {
            scope.count("surface triangles, adaptive,", tree.count());
        }
    }

    /// The dispatches that list the adaptive mesh's triangles.
    fn tessellate(&self, tree: &Tree, programs: &Programs, scope: &LightScope<'_>) -> Pass {
        let (params, faces) = (&self.params, self.extent.faces);
        let mut dispatches = vec![split::dispatch(&programs.split, params, tree, faces, scope)];
        let grow = grow::dispatches(&programs.grow, params, tree, faces, scope);
        dispatches.extend(grow);
        dispatches.extend(programs.list.dispatches(params, tree, faces, scope));
        Pass::compute(scope.pass_name("light volume tessellation"), dispatches)
    }

    /// The pass that sums up the jumps of visibility.
    fn draw(&self, programs: &Programs, scope: &LightScope<'_>, sum: &wgpu::TextureView) -> Pass {
        let (programs, params, tree) = (&programs.surface, &self.params, self.tree.as_ref());
        surface::pass(programs, params, &self.extent, tree, sum, scope)
    }
}
