//! Nearest and farthest depth over squares of a shadow map's texels, on the GPU: `pyramid.wgsl`.

use bytemuck::{Pod, Zeroable};

use crate::gpu::{
    layout,
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

/// What a shader needs that reads a pyramid.
pub(crate) const PYRAMID: &str = include_str!("pyramid.wgsl");
const REDUCE: &str = include_str!("pyramid_reduce.wgsl");

/// Levels, from 2 x 2 texels on.
const LEVELS: usize = 12;
/// Levels a dispatch makes.
const LEVELS_A_DISPATCH: u32 = 6;
/// Texels a side of the level it reads that a workgroup takes.
const TILE: u32 = 64;

/// `Pyramid` of `pyramid.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct PyramidUniform {
    pub(crate) levels: [[u32; 4]; LEVELS],
    pub(crate) faces: u32,
    pub(crate) first: u32,
    pad: [u32; 2],
}

impl PyramidUniform {
    /// Of a map of so many texels and faces.
    pub(crate) fn new([width, height]: [u32; 2], faces: u32) -> Self {
        let mut first = 0;
        let levels = std::array::from_fn(|i| {
            let [w, h] = [width, height].map(|n| n.div_ceil(2 << i));
            let level = [first, w, h, w * h];
            first += faces * w * h;
            level
        });
        Self {
            levels,
            faces,
            first: 0,
            pad: [0; 2],
        }
    }

    /// Bytes of its texels.
    pub(crate) fn bytes(&self) -> u64 {
        let [first, w, h, _] = self.levels[LEVELS - 1];
        (u64::from(first) + u64::from(w * h * self.faces)) * 8
    }
}

/// A pyramid on the GPU.
pub(crate) struct Pyramid {
    pub(crate) uniform: wgpu::Buffer,
    pub(crate) texels: wgpu::Buffer,
}

/// The shader that builds one.
pub(crate) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    let own = [
        layout::uniform::<PyramidUniform>(0),
        layout::storage(1, false),
    ];
    ComputeProgram::new(
        device,
        shared,
        "pyramid",
        &[PYRAMID, REDUCE],
        "pyramid_reduce",
        &own,
    )
}

/// The pyramid of a light's shadow map, and the pass that builds it.
pub(crate) fn build(
    program: &ComputeProgram,
    scope: &mut LightScope<'_>,
    map: &wgpu::Texture,
) -> (Pyramid, Pass) {
    let size = [map.width(), map.height()];
    let fine = PyramidUniform::new(size, map.depth_or_array_layers());
    let coarse = PyramidUniform {
        first: LEVELS_A_DISPATCH,
        ..fine
    };
    let texels = scope.storage("pyramid texels", fine.bytes());
    let uniforms = [
        scope.uniform("pyramid fine", &fine),
        scope.uniform("pyramid coarse", &coarse),
    ];
    let dispatches = [&fine, &coarse]
        .into_iter()
        .zip(&uniforms)
        .map(|(level, uniform)| {
            let [x, y] = size.map(|n| n.div_ceil(TILE << level.first));
            let resources = [uniform.as_entire_binding(), texels.as_entire_binding()];
            scope.dispatch(program, &resources, [x, y, level.faces])
        });
    let pass = Pass::compute(scope.pass_name("shadow map pyramid"), dispatches.collect());
    let [uniform, _] = uniforms;
    (Pyramid { uniform, texels }, pass)
}
