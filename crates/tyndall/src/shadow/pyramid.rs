//! Nearest and farthest depth over squares of a shadow map's texels, on the GPU: `pyramid.wgsl`.

use crate::gpu::{
    layout,
    pass::{Pass, Work},
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

/// What a shader needs that reads a pyramid.
pub(crate) const PYRAMID: &str = include_str!("pyramid.wgsl");
const BUILD: &str = include_str!("pyramid_build.wgsl");

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;

/// The shaders that build one: its first level, and any other.
pub(crate) struct Programs {
    first: ScreenProgram,
    next: ScreenProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [layout::uniform::<[u32; 4]>(0), layout::texels(1)];
        let program = |first: bool| {
            ScreenProgram::new(
                device,
                shared,
                "pyramid",
                &[PYRAMID, BUILD],
                "pyramid_build",
                &own,
            )
            .writing(FORMAT)
            .with("PYRAMID_FIRST", f64::from(u8::from(first)))
        };
        Self {
            first: program(true),
            next: program(false),
        }
    }
}

/// The pyramid of a light's shadow map, as an array of faces, and the pass that builds it.
pub(crate) fn build(
    programs: &Programs,
    scope: &mut LightScope<'_>,
    map: &wgpu::Texture,
) -> (wgpu::TextureView, Pass) {
    // Powers of two are halved without a rest; what lies beyond the map repeats its border.
    let half = |n: u32| (n.next_power_of_two() / 2).max(1);
    let size = wgpu::Extent3d {
        width: half(map.width()),
        height: half(map.height()),
        depth_or_array_layers: map.depth_or_array_layers(),
    };
    let levels = size.width.max(size.height).ilog2() + 1;
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let texture = scope.texture("shadow map pyramid", size, levels, FORMAT, usage);
    let mut draws = Vec::new();
    for layer in 0..size.depth_or_array_layers {
        let face = scope.uniform(FACES[layer as usize], &[layer, 0, 0, 0]);
        let mut above = scope.shared.absent.light.clone();
        for level in 0..levels {
            let target = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            });
            let program = if level == 0 {
                &programs.first
            } else {
                &programs.next
            };
            let resources = [
                face.as_entire_binding(),
                wgpu::BindingResource::TextureView(&above),
            ];
            draws.push(scope.draw(program, &resources, target.clone()));
            above = target;
        }
    }
    let whole = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let pass = Pass {
        name: scope.pass_name("shadow map pyramid"),
        work: Work::FullScreen(draws),
    };
    (whole, pass)
}

/// Names of the uniforms that say which face is drawn.
const FACES: [&str; 6] = [
    "pyramid face 0",
    "pyramid face 1",
    "pyramid face 2",
    "pyramid face 3",
    "pyramid face 4",
    "pyramid face 5",
];
