//! Draws the boundary of the shadow volume additively.

use super::{extent::Extent, tree::Tree};
use crate::{
    gpu::{
        pass::{Draw, Pass, Vertices, Work},
        pool::Owner,
        program::{Raster, ScreenProgram, Stencil},
        scope::{LightScope, Shared},
    },
    shader::constant,
};

pub(super) struct Programs {
    leaf: ScreenProgram,
    strip: ScreenProgram,
    side: ScreenProgram,
    /// Format of the texture that the jumps are summed up in.
    sum: wgpu::TextureFormat,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let sum = sum_format(device.features());
        let surface = |vertex, topology| {
            let raster = Raster {
                vertex,
                topology,
                target: wgpu::ColorTargetState {
                    format: sum,
                    blend: Some(ADD),
                    write_mask: wgpu::ColorWrites::ALL,
                },
                stencil: Stencil::Absent,
            };
            let module = "techniques::light_volume::surface";
            ScreenProgram::new(device, shared, module, "light_volume_surface").drawing(raster)
        };
        use wgpu::PrimitiveTopology::{TriangleList, TriangleStrip};
        Self {
            leaf: surface("light_volume_leaf", TriangleList),
            strip: surface("light_volume_strip", TriangleStrip),
            side: surface("light_volume_side", TriangleList),
            sum,
        }
    }

    /// Bits of one of the sum's numbers.
    pub(super) fn bits_of_sum(&self) -> u64 {
        if self.sum == wgpu::TextureFormat::Rgba32Float {
            32
        } else {
            16
        }
    }
}

const ADD: wgpu::BlendState = {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState {
        color: add,
        alpha: add,
    }
};

/// 32-bit floats where the device blends them.
fn sum_format(features: wgpu::Features) -> wgpu::TextureFormat {
    if features.contains(wgpu::Features::FLOAT32_BLENDABLE) {
        wgpu::TextureFormat::Rgba32Float
    } else {
        wgpu::TextureFormat::Rgba16Float
    }
}

/// The texture that the jumps are summed up in.
pub(super) fn sum_texture(programs: &Programs, scope: &mut LightScope<'_>) -> wgpu::TextureView {
    let size = wgpu::Extent3d {
        width: scope.size[0],
        height: scope.size[1],
        depth_or_array_layers: 1,
    };
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let key = (Owner::View, "light volume jumps");
    scope
        .pool
        .texture(scope.device, key, size, 1, programs.sum, usage)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// Creates the pass that sums up the jumps of visibility.
pub(super) fn pass(
    programs: &Programs,
    params: &wgpu::Buffer,
    extent: &Extent,
    tree: Option<&Tree>,
    sum: &wgpu::TextureView,
    scope: &LightScope<'_>,
) -> Pass {
    let mut draws = match tree {
        None => vec![strips(programs, params, extent, scope)],
        Some(tree) => adaptive(programs, params, tree, scope).into(),
    };
    if extent.faces == 1 {
        draws.push(sides(programs, params, extent, scope));
    }
    Pass {
        name: scope.pass_name("light volume"),
        work: Work::Draw {
            target: sum.clone(),
            draws,
        },
    }
}

/// The full mesh.
fn strips(
    programs: &Programs,
    params: &wgpu::Buffer,
    extent: &Extent,
    scope: &LightScope<'_>,
) -> Draw {
    let [columns, rows] = extent.cells;
    let vertices = Vertices::Direct {
        vertices: 2 * (columns + 1),
        instances: rows * extent.faces,
    };
    scope.draw_mesh(&programs.strip, &[params.as_entire_binding()], vertices)
}

/// The listed triangles, or the full mesh where there are too many.
fn adaptive(
    programs: &Programs,
    params: &wgpu::Buffer,
    tree: &Tree,
    scope: &LightScope<'_>,
) -> [Draw; 2] {
    let own = [params, &tree.triangles].map(|buffer| buffer.as_entire_binding());
    [
        scope.draw_mesh(&programs.leaf, &own, tree.listed()),
        scope.draw_mesh(&programs.strip, &own[..1], tree.full()),
    ]
}

/// The sides and the far cap of a single map.
fn sides(
    programs: &Programs,
    params: &wgpu::Buffer,
    extent: &Extent,
    scope: &LightScope<'_>,
) -> Draw {
    let [columns, rows] = extent.cells;
    let vertices = Vertices::Direct {
        vertices: constant("LIGHT_VOLUME_SIDE_VERTICES") * 2 * (columns + rows),
        instances: 1,
    };
    scope.draw_mesh(&programs.side, &[params.as_entire_binding()], vertices)
}
