//! The GPU side: the boundary of the shadow volume drawn additively, then one full-screen pass a light.

use std::num::NonZeroU64;

use glam::Mat4;

use super::{
    extent::Extent,
    params::{INFO, Params},
    tessellation::{Square, Step},
};
use crate::{
    error::PrepareError,
    frame::ShadowProjection,
    gpu::{
        cache,
        pass::{LightPasses, Pass, Vertices, Work},
        program::{ComputeProgram, Raster, ScreenProgram, Stencil},
        scope::{LightScope, Shared},
    },
    inputs::CountValue,
    shader::block,
    techniques::method::{GpuMethod, LightRequest},
};

block! {
    /// The shaders' `LightVolumeParams`.
    pub(crate) struct ParamsUniform = "LightVolumeParams" in "tyndall::techniques::light_volume::mesh", checked by light_volume_params_is_laid_out_as_in_wgsl {
        pub(crate) world_from_clip: [[f32; 4]; 4],
        pub(crate) far_plane: [f32; 4],
        pub(crate) cells: [u32; 2],
        pub(crate) pitch: u32,
        pub(crate) rows: u32,
        pub(crate) tolerance: f32,
        pub(crate) capacity: u32,
        pub(crate) mirrored: u32,
        pub(crate) pad: u32,
    }
}

/// The technique's shaders.
pub(crate) struct Programs {
    split: ComputeProgram,
    grow: ComputeProgram,
    list: ComputeProgram,
    choose: ComputeProgram,
    leaf: ScreenProgram,
    strip: ScreenProgram,
    side: ScreenProgram,
    panes: ComputeProgram,
    resolve: ScreenProgram,
    /// What the jumps are summed up in.
    sum: wgpu::TextureFormat,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
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
        let compute =
            |module, entry_point| ComputeProgram::new(device, shared, module, entry_point);
        let list = "techniques::light_volume::list";
        use wgpu::PrimitiveTopology::{TriangleList, TriangleStrip};
        Self {
            split: compute("techniques::light_volume::split", "light_volume_split"),
            grow: compute("techniques::light_volume::grow", "light_volume_grow"),
            list: compute(list, "light_volume_list"),
            choose: compute(list, "light_volume_choose"),
            leaf: surface(LEAF, TriangleList),
            strip: surface("light_volume_strip", TriangleStrip),
            side: surface("light_volume_side", TriangleList),
            panes: compute("techniques::light_volume::panes", "light_volume_find_panes"),
            resolve: ScreenProgram::new(
                device,
                shared,
                "techniques::light_volume::resolve",
                "light_volume_resolve",
            ),
            sum,
        }
    }
}

/// The vertex stage of the adaptive mesh.
const LEAF: &str = "light_volume_leaf";

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
        sum = sum_picture(programs.sum, scope);
        let bits = if programs.sum == wgpu::TextureFormat::Rgba32Float {
            32
        } else {
            16
        };
        scope.count("bits of a sum,", CountValue::Known(bits));
        let mesh = Mesh::new(params, scope, extent);
        if let Some(tree) = mesh.tree.as_ref().filter(|_| !mesh.is_kept) {
            passes.push(mesh.tessellate(tree, programs, scope));
        }
        passes.push(mesh.draw(programs, scope, &sum));
    }
    let panes = panes(programs, scope, &mut passes);
    let resources = [
        wgpu::BindingResource::TextureView(&sum),
        panes.as_entire_binding(),
    ];
    let last = scope.full_screen(&programs.resolve, "light volume resolve", &resources);
    LightPasses::new(passes, last)
}

/// The most texels a side that a triangle's name has bits for.
const MAX_SIDE: u32 = 4096;

/// Refuses what the mesh cannot hold.
fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        index,
        light,
        inputs,
        ..
    } = *request;
    let refuse = |what: String| {
        Err(PrepareError::Unsupported {
            technique: INFO.name,
            what: format!("{what} (lights[{index}])"),
        })
    };
    if light.texture.is_some() {
        return refuse("light textures".into());
    }
    let (Some(map), Some(projection)) = (inputs.shadow_map, &light.shadow) else {
        return Ok(());
    };
    let size = [map.texture().width(), map.texture().height()];
    if size.iter().any(|n| *n > MAX_SIDE) {
        return refuse(format!(
            "shadow maps of more than {MAX_SIDE} texels a side, found {size:?}"
        ));
    }
    if let ShadowProjection::Single {
        clip_from_world, ..
    } = *projection
        && Mat4::from_cols_array_2d(&clip_from_world)
            .as_dmat4()
            .determinant()
            == 0.0
    {
        return refuse("a shadow projection without an inverse".into());
    }
    let bytes = Square::of_map(size).splits_bytes(light.faces());
    if params.tolerance > 0.0 && bytes > limits.max_storage_buffer_binding_size {
        return refuse(format!(
            "merging within `max_storage_buffer_binding_size` {}, for the map takes {bytes} bytes",
            limits.max_storage_buffer_binding_size
        ));
    }
    Ok(())
}

/// What the light's mesh spans; `None` without shadow map.
fn extent(scope: &LightScope<'_>) -> Option<Extent> {
    let map = scope.inputs.shadow_map?.texture();
    Extent::new(scope.light, [map.width(), map.height()], scope.rays)
}

fn sum_picture(format: wgpu::TextureFormat, scope: &mut LightScope<'_>) -> wgpu::TextureView {
    let size = wgpu::Extent3d {
        width: scope.size[0],
        height: scope.size[1],
        depth_or_array_layers: 1,
    };
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let key = (None, "light volume jumps");
    scope
        .pool
        .texture(scope.device, key, size, 1, format, usage)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// Side of the blocks of a glass map that are walked or passed over as one [texels].
const BLOCK: u32 = 32;

/// The buffer of `panes.wgsl`, and the pass that fills it where there is glass.
fn panes(programs: &Programs, scope: &mut LightScope<'_>, passes: &mut Vec<Pass>) -> wgpu::Buffer {
    let blocks = scope.inputs.glass.map(|glass| {
        let texture = glass.texture();
        let side = |n: u32| n.div_ceil(BLOCK);
        [
            side(texture.width()),
            side(texture.height()),
            scope.light.faces(),
        ]
    });
    let count: u64 = blocks.unwrap_or([1; 3]).map(u64::from).iter().product();
    let key = (Some(scope.index), "light volume panes");
    let usage = wgpu::BufferUsages::STORAGE;
    let buffer = scope.pool.buffer(scope.device, key, 4 * count, usage);
    if let Some(blocks) = blocks {
        let resources = [buffer.as_entire_binding()];
        passes.push(scope.compute(&programs.panes, "light volume panes", &resources, blocks));
    }
    buffer
}

/// What draws one light's mesh.
struct Mesh {
    extent: Extent,
    params: wgpu::Buffer,
    /// `None` where no cells are merged.
    tree: Option<Tree>,
    /// Whether the frame before listed the same triangles.
    is_kept: bool,
}

/// The adaptive mesh.
struct Tree {
    square: Square,
    splits: wgpu::Buffer,
    steps: wgpu::Buffer,
    triangles: wgpu::Buffer,
    counts: wgpu::Buffer,
}

/// `LightVolumeCounts` of `list.wgsl`: two draws' arguments, and two numbers.
const COUNTS_BYTES: u64 = 40;
/// Where the full mesh's arguments stand in it.
const FULL_DRAW: u64 = 16;
/// Where the number of triangles stands in it.
const TRIANGLES: u64 = 36;

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
        let key = (Some(scope.index), "light volume is made of");
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
            let (buffer, offset) = (tree.counts.clone(), TRIANGLES);
            let adaptive = CountValue::Written { buffer, offset };
            scope.count("surface triangles, adaptive,", adaptive);
        }
    }

    /// The dispatches that list the adaptive mesh's triangles.
    fn tessellate(&self, tree: &Tree, programs: &Programs, scope: &LightScope<'_>) -> Pass {
        let (square, faces) = (tree.square, self.extent.faces);
        let own = [
            self.params.as_entire_binding(),
            tree.splits.as_entire_binding(),
        ];
        let words = [square.pitch().div_ceil(64), square.rows(), faces];
        let mut dispatches = vec![scope.dispatch(&programs.split, &own, words)];
        for (i, (_, [columns, rows])) in square.steps().into_iter().enumerate() {
            let step = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &tree.steps,
                offset: i as u64 * STEP_STRIDE,
                size: NonZeroU64::new(size_of::<Step>() as u64),
            });
            let resources = [own[0].clone(), own[1].clone(), step];
            let groups = [columns.div_ceil(8), rows.div_ceil(8), faces];
            dispatches.push(scope.dispatch(&programs.grow, &resources, groups));
        }
        let list = [
            own[0].clone(),
            own[1].clone(),
            tree.triangles.as_entire_binding(),
            tree.counts.as_entire_binding(),
        ];
        dispatches.push(scope.dispatch(&programs.list, &list, words));
        dispatches.push(scope.dispatch(&programs.choose, &list, [1; 3]));
        Pass {
            name: scope.pass_name("light volume tessellation"),
            work: Work::Compute(dispatches),
        }
    }

    /// The pass that sums up the jumps of visibility.
    fn draw(&self, programs: &Programs, scope: &LightScope<'_>, sum: &wgpu::TextureView) -> Pass {
        let own = [self.params.as_entire_binding()];
        let [columns, rows] = self.extent.cells;
        let mut draws = match &self.tree {
            None => {
                let strips = Vertices::Direct {
                    vertices: 2 * (columns + 1),
                    instances: rows * self.extent.faces,
                };
                vec![scope.draw_mesh(&programs.strip, &own, strips)]
            }
            Some(tree) => {
                let list = tree.triangles.as_entire_binding();
                let leaf = [own[0].clone(), list];
                let arguments = |offset| Vertices::Indirect(tree.counts.clone(), offset);
                vec![
                    scope.draw_mesh(&programs.leaf, &leaf, arguments(0)),
                    scope.draw_mesh(&programs.strip, &own, arguments(FULL_DRAW)),
                ]
            }
        };
        if self.extent.faces == 1 {
            let sides = Vertices::Direct {
                vertices: 9 * 2 * (columns + rows),
                instances: 1,
            };
            draws.push(scope.draw_mesh(&programs.side, &own, sides));
        }
        Pass {
            name: scope.pass_name("light volume"),
            work: Work::Draw {
                target: sum.clone(),
                draws,
            },
        }
    }
}

/// Offsets of uniform buffers are multiples of this, by WebGPU's default limits.
const STEP_STRIDE: u64 = 256;

impl Tree {
    fn new(scope: &mut LightScope<'_>, extent: &Extent, capacity: u32) -> Self {
        let square = Square::new(extent.cells);
        let steps = square.steps();
        let mut bytes = vec![0; steps.len() * STEP_STRIDE as usize];
        for ((step, _), slot) in steps.iter().zip(bytes.chunks_mut(STEP_STRIDE as usize)) {
            slot[..size_of::<Step>()].copy_from_slice(bytemuck::bytes_of(step));
        }
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let storage = wgpu::BufferUsages::STORAGE;
        let arguments = storage | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC;
        let mut buffer = |name, size, usage| {
            let key = (Some(scope.index), name);
            scope.pool.buffer(scope.device, key, size, usage)
        };
        let tree = Self {
            square,
            splits: buffer(
                "light volume splits",
                square.splits_bytes(extent.faces),
                storage,
            ),
            steps: buffer("light volume steps", bytes.len() as u64, uniform),
            triangles: buffer("light volume triangles", 4 * u64::from(capacity), storage),
            counts: buffer("light volume counts", COUNTS_BYTES, arguments),
        };
        scope.queue.write_buffer(&tree.steps, 0, &bytes);
        tree
    }
}

#[cfg(test)]
mod tests {
    use tyndall_testkit::device::device_or_skip;

    use super::super::twin::Face;
    use crate::{
        CountValue, Effect, EffectOptions, FrameInputs, LightInputs, OutputPrecision,
        frame::{Camera, Emitter, Frame, Light, Medium, ShadowProjection},
        techniques::{Technique, TechniqueChoice},
    };

    /// A depth texture that holds 0.5 everywhere.
    fn flat(device: &wgpu::Device, queue: &wgpu::Queue, size: [u32; 2]) -> wgpu::TextureView {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Depth32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &texture.create_view(&Default::default()),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.5),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        queue.submit([encoder.finish()]);
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        })
    }

    #[test]
    fn flat_maps_are_merged_as_by_the_twin_and_kept_while_they_stay() {
        let Some(gpu) = device_or_skip("the adaptive mesh") else {
            return;
        };
        let (device, queue) = (&gpu.device, &gpu.queue);
        let options = EffectOptions {
            target_format: wgpu::TextureFormat::Rgba16Float,
            output: OutputPrecision::Full,
        };
        let effect = Effect::new(device, &options).expect("a blendable target");
        let mut view = effect.create_view(device, [4, 4]).expect("a good size");
        let depth = flat(device, queue, [4, 4]);
        let depth = depth.texture().create_view(&Default::default());
        let frame = Frame {
            camera: Camera::perspective(
                [0.0; 3],
                [0.0, 0.0, -1.0],
                [0.0, 1.0, 0.0],
                1.0,
                1.0,
                0.1,
                9.0,
            ),
            lights: vec![Light {
                emitter: Emitter::Directional {
                    direction: [0.0, 0.0, 1.0],
                    illuminance: [1.0; 3],
                },
                shadow: Some(ShadowProjection::Single {
                    clip_from_world: glam::Mat4::IDENTITY.to_cols_array_2d(),
                    reversed_depth: true,
                }),
                texture: None,
            }],
            medium: Medium {
                components: Vec::new(),
            },
        };
        let techniques = TechniqueChoice::from(Technique::LightVolume(super::Params::default()));
        for size in [[64, 64], [100, 60]] {
            let map = flat(device, queue, size);
            let twin = Face::new(size.map(|n| n + 1), 0.0, 0).triangles().len() as u32;
            // Frames: the map's revision, whether it is recorded, and whether its mesh is listed anew.
            for (revision, is_recorded, is_listed) in [
                (None, true, true),
                (Some(1), true, true),
                (Some(1), true, false),
                (Some(2), false, true),
                (Some(2), true, true),
                (Some(2), true, false),
                (None, true, true),
            ] {
                let light = LightInputs {
                    shadow_map: Some(&map),
                    shadow_revision: revision,
                    ..LightInputs::default()
                };
                let inputs = FrameInputs {
                    depth: &depth,
                    lights: &[light],
                };
                effect
                    .prepare(device, queue, &mut view, &inputs, &frame, &techniques)
                    .expect("a good frame");
                let listing = |pass: &super::Pass| pass.name.contains("tessellation");
                assert_eq!(view.passes().iter().any(listing), is_listed, "{revision:?}");
                if !is_recorded {
                    continue;
                }
                let mut encoder = device.create_command_encoder(&Default::default());
                effect.record(&mut encoder, &mut view, None);
                queue.submit([encoder.finish()]);
                let count = view.counts().iter().find(|c| c.name.contains("adaptive"));
                let Some(CountValue::Written { buffer, offset }) = count.map(|c| &c.value) else {
                    unreachable!("the adaptive mesh is counted on the device");
                };
                let counts: Vec<u32> = gpu.read_buffer(buffer).expect("readable");
                assert_eq!(counts[*offset as usize / 4], twin, "{size:?}, {revision:?}");
            }
        }
    }
}
