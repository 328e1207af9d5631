//! Finds what blocks of the glass map hold: their range of depths, and their tint.

use crate::{
    gpu::{
        pass::Pass,
        pool::Owner,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::{block, constant},
};

block! {
    /// The shaders' `LightVolumePanes`.
    struct Panes = "LightVolumePanes" in "tyndall::techniques::light_volume::panes", checked by light_volume_panes_is_laid_out_as_in_wgsl {
        glass: [f32; 2],
        map: [f32; 2],
        tint: u32,
        pad: u32,
    }
}

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    let module = "techniques::light_volume::panes";
    ComputeProgram::new(device, shared, module, "light_volume_find_panes")
}

/// The blocks' buffer, and the pass that fills it where there is glass.
pub(super) fn pass(
    program: &ComputeProgram,
    scope: &mut LightScope<'_>,
) -> (wgpu::Buffer, Option<Pass>) {
    let blocks = scope.inputs.glass.map(|glass| {
        let texture = glass.texture();
        let side = |n: u32| n.div_ceil(constant("LIGHT_VOLUME_BLOCK"));
        [
            side(texture.width()),
            side(texture.height()),
            scope.light.faces(),
        ]
    });
    let count: u64 = blocks.unwrap_or([1; 3]).map(u64::from).iter().product();
    let key = (Owner::Light(scope.index), "light volume panes");
    let usage = wgpu::BufferUsages::STORAGE;
    let bytes = size_of::<Panes>() as u64 * count;
    let buffer = scope.pool.buffer(scope.device, key, bytes, usage);
    let pass = blocks.map(|blocks| {
        let resources = [buffer.as_entire_binding()];
        scope.compute(program, "light volume panes", &resources, blocks)
    });
    (buffer, pass)
}
