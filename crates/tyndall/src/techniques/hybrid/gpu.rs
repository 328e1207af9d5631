//! The GPU side: whether the eye is shaded, the bounds, the light.

use bytemuck::{Pod, Zeroable};

use super::{Params, Show};
use crate::{
    effect::{CountValue, LightInputs},
    error::PrepareError,
    gpu::{
        layout,
        pass::{Pass, Vertices, Work},
        program::{ComputeProgram, Raster, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, MARCH, STRETCH},
    },
    occluder::{
        Occluder,
        gpu::{Names, VOLUME, VolumePrograms, Volumes, check_list, own},
    },
};

const BOUNDS: &str = include_str!("bounds.wgsl");
const EYE: &str = include_str!("eye.wgsl");
const EYE_BOUNDS: &str = include_str!("eye_bounds.wgsl");
/// The pass that writes the light.
pub(crate) const HYBRID: &str = include_str!("hybrid.wgsl");

/// Shares of the ray's length; every device blends this format.
const BOUNDS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// `HybridParams` of `hybrid.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ParamsUniform {
    pub(crate) steps: u32,
    pub(crate) bounds: u32,
    pub(crate) show: u32,
    pad: u32,
}

const NAMES: Names = Names {
    places: "hybrid places",
    params: "hybrid occluders",
    list: "hybrid list",
    arguments: "hybrid arguments",
};

/// Refuses lists of silhouettes that the device cannot bind.
pub(crate) fn check(
    limits: &wgpu::Limits,
    index: usize,
    inputs: &LightInputs<'_>,
) -> Result<(), PrepareError> {
    check_list(limits, index, inputs.occluders.unwrap_or_default())
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
        let eye_bounds_own = [layout::storage(0, true)];
        let eye_own = [&own()[..], &[layout::storage(4, false)]].concat();
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
            volumes: VolumePrograms::new(
                device,
                shared,
                &farthest,
                BOUNDS,
                ["bounds_of_boundary", "bounds_of_far_cap"],
            ),
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
        let volumes = Volumes::new(&NAMES, occluders, scope);
        let eye = scope.storage("hybrid eye in shadow", 4);
        passes.push(eye_pass(&volumes, &eye, programs, scope));
        passes.push(volumes.list("list silhouettes", &programs.volumes, scope));
        let whole = Vertices::Direct {
            vertices: 3,
            instances: 1,
        };
        let from_eye = scope.draw_mesh(&programs.eye_bounds, &[eye.as_entire_binding()], whole);
        let boundaries = volumes.draws(&programs.volumes, scope);
        passes.push(Pass {
            name: scope.pass_name("shadow volumes"),
            work: Work::Draw {
                target: bounds.clone(),
                draws: std::iter::once(from_eye).chain(boundaries).collect(),
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
    volumes: &Volumes<'_>,
    eye: &wgpu::Buffer,
    programs: &Programs,
    scope: &LightScope<'_>,
) -> Pass {
    let mut dispatches = Vec::new();
    for (run, mesh, _) in volumes.runs() {
        let own = [eye.as_entire_binding()];
        let resources = [&volumes.resources(run, &mesh.triangles)[..], &own].concat();
        if run == 0 {
            dispatches.push(scope.dispatch(&programs.eye_clear, &resources, [1; 3]));
        }
        let groups = volumes.workgroups(run, mesh.triangles());
        dispatches.push(scope.dispatch(&programs.eye, &resources, groups));
    }
    Pass::compute(scope.pass_name("eye in shadow"), dispatches)
}
