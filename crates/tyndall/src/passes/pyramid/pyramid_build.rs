//! The passes that build a pyramid level by level.

use crate::{
    gpu::{
        cache,
        pass::{Pass, Work},
        program::ScreenProgram,
        scope::{LightScope, Shared},
    },
    shader::constant,
};

/// The texture that a pyramid is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The shadow map.
    ShadowMap,
    /// The layers of glass that tint.
    Glass,
}

impl Source {
    fn name(self) -> &'static str {
        match self {
            Self::ShadowMap => "shadow map pyramid",
            Self::Glass => "glass pyramid",
        }
    }

    /// Depths alone, or depths and a tint.
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::ShadowMap => wgpu::TextureFormat::Rg32Float,
            Self::Glass => wgpu::TextureFormat::Rgba32Float,
        }
    }
}

/// The shaders that build pyramids of either source.
pub(crate) struct Programs {
    of_map: Levels,
    of_glass: Levels,
}

/// The shaders of a pyramid's first level, and of any other.
struct Levels {
    first: ScreenProgram,
    next: ScreenProgram,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |from: &str, format| {
            let module = "passes::pyramid::pyramid_build";
            ScreenProgram::new(device, shared, module, "pyramid_build")
                .writing(format)
                .with("PYRAMID_SOURCE", constant(from).into())
        };
        let levels = |from: &str, source: Source| Levels {
            first: program(from, source.format()),
            next: program("PYRAMID_FROM_PYRAMID", source.format()),
        };
        Self {
            of_map: levels("PYRAMID_FROM_MAP", Source::ShadowMap),
            of_glass: levels("PYRAMID_FROM_GLASS", Source::Glass),
        }
    }
}

/// A pyramid as an array of a light's faces, and the pass that builds it from a texture of `size` texels a face.
pub(crate) fn build(
    programs: &Programs,
    scope: &mut LightScope<'_>,
    source: Source,
    size: [u32; 2],
    faces: u32,
) -> (wgpu::TextureView, Pass) {
    // Powers of two are halved without a rest; texels beyond the texture repeat its border.
    let [width, height] = size.map(|n| (n.next_power_of_two() / 2).max(1));
    let extent = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: faces,
    };
    let levels = width.max(height).ilog2() + 1;
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let texture = scope.texture(source.name(), extent, levels, source.format(), usage);
    let programs = match source {
        Source::ShadowMap => &programs.of_map,
        Source::Glass => &programs.of_glass,
    };
    let mut draws = Vec::new();
    for layer in 0..faces {
        let face = scope.uniform(FACES[layer as usize], &[layer, 0, 0, 0]);
        let mut above = scope.shared.bindings.no_light().clone();
        for level in 0..levels {
            let target = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            });
            let program = match level {
                0 => &programs.first,
                _ => &programs.next,
            };
            let resources = [
                face.as_entire_binding(),
                wgpu::BindingResource::TextureView(&above),
            ];
            draws.push(scope.draw(program, &resources, target.clone()));
            above = target;
        }
    }
    let all = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let pass = Pass {
        name: scope.pass_name(source.name()),
        work: Work::FullScreen(draws),
    };
    (all, pass)
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
