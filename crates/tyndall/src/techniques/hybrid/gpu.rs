//! The GPU side: whether the eye is shaded, the bounds, the light.

use bytemuck::{Pod, Zeroable};

use super::{Params, Show};
use crate::{
    effect::CountValue,
    gpu::{
        layout,
        pass::{Pass, Vertices, Work},
        program::{ComputeProgram, Raster, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, MARCH, STRETCH},
    },
    occluder::{
        Occluder,
        gpu::{Places, VOLUME, VolumePrograms, draws, own},
    },
};

const BOUNDS: &str = include_str!("bounds.wgsl");
const EYE: &str = include_str!("eye.wgsl");
const EYE_BOUNDS: &str = include_str!("eye_bounds.wgsl");
/// The pass that writes the light.
pub(crate) const HYBRID: &str = include_str!("hybrid.wgsl");

/// Shares of the ray's length; every device blends this format.
const BOUNDS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Triangles that a workgroup of `eye.wgsl` tests.
const EYE_GROUP: u32 = 64;
/// The most workgroups a row has.
const EYE_COLUMNS: u32 = 32_768;

/// `HybridParams` of `hybrid.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ParamsUniform {
    pub(crate) steps: u32,
    pub(crate) bounds: u32,
    pub(crate) show: u32,
    pad: u32,
}

/// `EyeParams` of `eye.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct EyeUniform {
    first_place: u32,
    triangles: u32,
    columns: u32,
    pad: u32,
}

/// The technique's shaders.
pub(crate) struct Programs {
    volumes: VolumePrograms,
    eye_clear: ComputeProgram,
    eye: ComputeProgram,
    eye_bounds: ScreenProgram,
    hybrid: ScreenProgram,
}

const FARTHEST: wgpu::BlendState = {
    let larger = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Max,
    };
    wgpu::BlendState {
        color: larger,
        alpha: larger,
    }
};

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let farthest = Raster::full_screen(wgpu::ColorTargetState {
            format: BOUNDS_FORMAT,
            blend: Some(FARTHEST),
            write_mask: wgpu::ColorWrites::ALL,
        });
        let boundary = |label, vertex, fragment| {
            let raster = Raster {
                vertex,
                ..farthest.clone()
            };
            ScreenProgram::new(device, shared, label, &[VOLUME, BOUNDS], fragment, &own())
                .drawing(raster)
        };
        let eye_bounds_own = [layout::storage(0, true)];
        let eye_own = [
            &own()[..],
            &[layout::storage(3, false), layout::uniform::<EyeUniform>(4)],
        ]
        .concat();
        let eye = |entry_point| {
            let modules = [VOLUME, EYE];
            ComputeProgram::new(
                device,
                shared,
                "hybrid eye",
                &modules,
                entry_point,
                &eye_own,
            )
        };
        let hybrid_own = [
            layout::uniform::<ParamsUniform>(0),
            layout::texels(1),
            layout::airlight(2),
        ];
        let modules = [AIRLIGHT, STRETCH, MARCH, HYBRID];
        Self {
            volumes: VolumePrograms {
                wall: boundary("hybrid walls", "occluder_wall", "bounds_of_boundary"),
                cap: boundary("hybrid caps", "occluder_cap", "bounds_of_boundary"),
                far_cap: boundary("hybrid far caps", "occluder_far_cap", "bounds_of_far_cap"),
            },
            eye_clear: eye("eye_clear"),
            eye: eye("eye_triangle"),
            eye_bounds: ScreenProgram::new(
                device,
                shared,
                "hybrid eye bounds",
                &[EYE_BOUNDS],
                "eye_bounds",
                &eye_bounds_own,
            )
            .drawing(farthest),
            hybrid: ScreenProgram::new(device, shared, "hybrid", &modules, "hybrid", &hybrid_own),
        }
    }
}

/// The passes of one light.
pub(crate) fn passes(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let inputs = scope.inputs;
    // Outside the volumes pictures and glass still tint.
    let is_plain = inputs.glass.is_none() && scope.light.texture.is_none();
    let occluders = inputs.occluders.filter(|_| is_plain);
    let uniform = ParamsUniform {
        steps: params.steps,
        bounds: match occluders {
            None => 0,
            Some([]) => 1,
            Some(_) => 2,
        },
        show: match params.show {
            Show::Light => 0,
            Show::Bounds => 1,
        },
        pad: 0,
    };
    let uniform = scope.uniform("hybrid params", &uniform);
    let mut bounds = scope.shared.absent.light.clone();
    let mut passes = Vec::new();
    if let Some(occluders) = occluders.filter(|occluders| !occluders.is_empty()) {
        count(occluders, scope);
        bounds = bounds_picture(scope);
        let places = Places::new("hybrid places", occluders, scope);
        let eye = scope.storage("hybrid eye in shadow", 4);
        passes.push(eye_pass(occluders, &places, &eye, programs, scope));
        let whole = Vertices::Direct {
            vertices: 3,
            instances: 0..1,
        };
        let from_eye = scope.draw_mesh(&programs.eye_bounds, &[eye.as_entire_binding()], whole);
        let volumes = draws(occluders, &places, &programs.volumes, scope);
        passes.push(Pass {
            name: scope.pass_name("shadow volumes"),
            work: Work::Draw {
                target: bounds.clone(),
                draws: std::iter::once(from_eye).chain(volumes).collect(),
            },
        });
        scope.witness = Some(bounds.clone());
    }
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        wgpu::BindingResource::TextureView(&bounds),
        wgpu::BindingResource::TextureView(&airlight),
    ];
    passes.push(scope.full_screen(&programs.hybrid, "hybrid", &resources));
    passes
}

fn count(occluders: &[Occluder<'_>], scope: &mut LightScope<'_>) {
    let edges = occluders.iter().map(|o| u64::from(o.mesh.edges())).sum();
    scope.count("edges of shadow volumes,", CountValue::Known(edges));
}

fn bounds_picture(scope: &mut LightScope<'_>) -> wgpu::TextureView {
    let size = wgpu::Extent3d {
        width: scope.size[0],
        height: scope.size[1],
        depth_or_array_layers: 1,
    };
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    scope
        .texture("hybrid bounds", size, 1, BOUNDS_FORMAT, usage)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// Asks whether the eye is in a shadow.
fn eye_pass(
    occluders: &[Occluder<'_>],
    places: &Places,
    eye: &wgpu::Buffer,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Pass {
    let uniforms: Vec<EyeUniform> = (0..)
        .zip(occluders)
        .map(|(first_place, occluder)| {
            let triangles = occluder.mesh.triangles();
            EyeUniform {
                first_place,
                triangles,
                columns: triangles.div_ceil(EYE_GROUP).clamp(1, EYE_COLUMNS),
                pad: 0,
            }
        })
        .collect();
    let blocks = scope.blocks("hybrid eye params", uniforms);
    let dispatches = (0..).zip(occluders).map(|(i, occluder)| {
        let EyeUniform {
            triangles, columns, ..
        } = blocks.values[i as usize];
        let rows = triangles.div_ceil(EYE_GROUP).div_ceil(columns);
        let resources = [
            places.as_entire_binding(),
            occluder.mesh.corners.as_entire_binding(),
            occluder.mesh.triangles.as_entire_binding(),
            eye.as_entire_binding(),
            blocks.binding(i),
        ];
        let clear = (i == 0).then(|| scope.dispatch(&programs.eye_clear, &resources, [1; 3]));
        let test = scope.dispatch(&programs.eye, &resources, [columns, rows, 1]);
        clear.into_iter().chain([test])
    });
    let dispatches = dispatches.flatten().collect();
    Pass::compute(scope.pass_name("eye in shadow"), dispatches)
}
