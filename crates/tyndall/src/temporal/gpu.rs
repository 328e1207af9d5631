//! The passes about a technique's last one.

use std::sync::Arc;

use super::{
    gate::{self, gate},
    history::{Generations, Placed, Viewpoint},
    options::{Reuse, ReuseMask, ReuseShow},
};
use crate::{
    error::PrepareError,
    frame::{Emitter, Light},
    gpu::{
        cache, limits,
        pass::{Dispatch, Draw, FullScreen, LightPasses, Pass, Vertices, Work, Workgroups},
        pool::Owner,
        program::{ComputeProgram, ScreenProgram, Stencil},
        scope::{LightScope, Shared},
        uniforms::CameraUniform,
    },
    inputs::CountValue,
    mesh::Occluder,
    passes::occluder::{self as volumes, Names, VolumePrograms, check_list},
    shader::block,
    techniques::{LightRequest, Reach},
};

block! {
    /// The shaders' `ReuseParams`.
    pub(crate) struct ParamsUniform = "ReuseParams" in "tyndall::temporal::reuse", checked by reuse_params_is_laid_out_as_in_wgsl {
        pub(crate) pixels: [u32; 2],
        pub(crate) map: [u32; 2],
        pub(crate) faces: u32,
        pub(crate) generation: u32,
        pub(crate) frames: u32,
        pub(crate) mask: u32,
        pub(crate) margin: f32,
        pub(crate) reach: u32,
        pub(crate) has_witness: u32,
        pub(crate) levels: u32,
        pub(crate) kin: u32,
        pad: [u32; 3],
        pub(crate) dispatches: [[u32; 4]; MAX_DISPATCHES],
    }
}

block! {
    /// The shaders' `Reproject`.
    struct ReprojectUniform = "Reproject" in "tyndall::temporal::reproject", checked by reproject_is_laid_out_as_in_wgsl {
        camera: CameraUniform,
        eye: [f32; 3],
        tolerance: f32,
        rounding: f32,
        pad: [f32; 3],
    }
}

const MAX_DISPATCHES: usize = 16;
/// Where the sizes of what takes over another camera's picture stand, behind those of the others: a dispatch's and a
/// draw's [bytes].
const REPROJECT_GROUPS: u64 = 12 * MAX_DISPATCHES as u64;
const RESTORE_VERTICES: u64 = REPROJECT_GROUPS + 12;
/// `ReuseState`: seven words.
const STATE_BYTES: u64 = 28;
/// Where the number of stale pixels stands in it.
const STALE: u64 = 8;
/// Texels of a finest block's side, pixels of a tile's, invocations of a workgroup's.
const SIDE: u32 = 8;

/// The shaders of temporal reuse.
pub(crate) struct Programs {
    decide: ComputeProgram,
    change_finest: ComputeProgram,
    change_coarser: ComputeProgram,
    reproject: ComputeProgram,
    tiles: ComputeProgram,
    stencil: ScreenProgram,
    restore: ScreenProgram,
    sum: ScreenProgram,
    show: ScreenProgram,
    touched: Arc<VolumePrograms>,
    gate: gate::Programs,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let compute =
            |module, entry_point| ComputeProgram::new(device, shared, module, entry_point);
        let screen = |module, entry_point| {
            ScreenProgram::new(device, shared, module, entry_point).for_all_lights()
        };
        Self {
            decide: compute("temporal::decide", "decide").for_all_lights(),
            change_finest: compute("temporal::change", "change_finest"),
            change_coarser: compute("temporal::change", "change_coarser"),
            reproject: compute("temporal::reproject", "reproject_tile"),
            tiles: compute("temporal::tiles", "tiles"),
            stencil: screen("temporal::stencil", "stencil"),
            restore: screen("temporal::restore", "restore"),
            sum: screen("temporal::sum", "reuse_sum"),
            show: screen("temporal::show", "reuse_show"),
            touched: shared.programs(device),
            gate: gate::Programs::new(device, shared),
        }
    }
}

/// Refuses what cannot be kept.
pub(crate) fn check(reuse: &Reuse, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        size: [width, height],
        index,
        light,
        inputs,
    } = *request;
    if let Some(tolerance) = reuse.reproject.filter(|t| !(t.is_finite() && *t > 0.0)) {
        return Err(PrepareError::OutOfRange {
            field: "reuse.reproject".to_owned(),
            expected: "a finite number > 0",
            found: tolerance.to_string(),
        });
    }
    if reuse.mask == ReuseMask::Geometry && inputs.occluders.is_none() {
        return Err(PrepareError::Missing {
            field: format!("inputs.lights[{index}].occluders"),
            reason: "the mask is drawn from what moves",
        });
    }
    if reuse.mask == ReuseMask::Geometry {
        // What moved stands there twice.
        let occluders = inputs.occluders.unwrap_or_default();
        check_list(limits, index, &occluders.repeat(2))?;
    }
    let texels = inputs.shadow_map.map_or(0, |map| {
        let size = map.texture().size();
        u64::from(size.width) * u64::from(size.height) * u64::from(light.faces())
    });
    // The map takes a word a texel, depth and age one a pixel each, what is found in another camera's picture four.
    let pixel = if reuse.reproject.is_some() { 16 } else { 4 };
    let needed = (4 * texels).max(pixel * u64::from(width) * u64::from(height));
    let of = format!("temporal reuse (lights[{index}])");
    limits::check_storage(limits, &of, &[("memory", needed)])
}

/// What a frame knows of a light's reuse before the light's passes are made.
pub(crate) struct Frame<'a> {
    pub(crate) reuse: Reuse,
    pub(crate) generations: Generations,
    pub(crate) reach: Reach,
    /// Where the frame recorded last was seen from.
    pub(crate) before: Option<Viewpoint>,
    /// What moved, for the geometry's mask.
    pub(crate) moved: &'a [Placed],
}

impl Frame<'_> {
    /// What may be wrong with a pixel of another camera's picture, where any is kept at all: pixels have to be computed
    /// each on its own, and the light's shadows be asked at any point.
    fn reprojection(&self, light: &Light) -> Option<(Viewpoint, f32)> {
        let is_fit = matches!(self.reach, Reach::Pixels(_))
            && !matches!(light.emitter, Emitter::Rect { .. });
        self.before.zip(self.reuse.reproject).filter(|_| is_fit)
    }
}

/// Buffers of one light.
pub(super) struct Buffers {
    pub(super) params: wgpu::Buffer,
    pub(super) state: wgpu::Buffer,
    dispatches: wgpu::Buffer,
    pub(super) blocks: wgpu::Buffer,
    map_seen: wgpu::Buffer,
    depth_seen: wgpu::Buffer,
    age: wgpu::Buffer,
    witness_seen: wgpu::Buffer,
    found: wgpu::Buffer,
}

/// Numbers of blocks of each level's side, finest first; none without a map.
fn levels(map: [u32; 2]) -> Vec<[u32; 2]> {
    if map.contains(&0) {
        return Vec::new();
    }
    let mut levels = vec![map.map(|n| n.div_ceil(SIDE))];
    while let Some(last) = levels.last().filter(|last| **last != [1; 2]) {
        levels.push(last.map(|n| n.div_ceil(2)));
    }
    levels
}

impl Buffers {
    fn new(frame: &Frame<'_>, witness: Option<&wgpu::Buffer>, scope: &mut LightScope<'_>) -> Self {
        let map = scope.inputs.shadow_map.map(|map| map.texture().size());
        let map = map.map_or([0; 2], |size| [size.width, size.height]);
        let faces = if map == [0; 2] {
            0
        } else {
            scope.light.faces()
        };
        let levels = levels(map);
        let params = params(frame, (map, faces), &levels, witness.is_some(), scope);
        let blocks: u64 = levels
            .iter()
            .map(|[w, h]| u64::from(*w) * u64::from(*h))
            .sum();
        let texels = u64::from(map[0]) * u64::from(map[1]) * u64::from(faces);
        let pixels = u64::from(scope.size[0]) * u64::from(scope.size[1]);
        let witnessed = witness.map_or(8, wgpu::Buffer::size);
        let found = if frame.reuse.reproject.is_some() {
            pixels
        } else {
            1
        };
        let state = {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            let key = (Owner::Light(scope.index), "reuse state");
            scope.pool.buffer(scope.device, key, STATE_BYTES, usage)
        };
        Self {
            params: scope.uniform("reuse params", &params),
            state,
            // One more, and a draw's four words.
            dispatches: scope.indirect("reuse dispatches", MAX_DISPATCHES as u64 + 3),
            blocks: scope.kept_storage("reuse blocks", 8 * (blocks * u64::from(faces)).max(1)),
            map_seen: scope.kept_storage("reuse shadow map", 4 * texels.max(1)),
            depth_seen: scope.kept_storage("reuse depth", 4 * pixels),
            age: scope.kept_storage("reuse age", 4 * pixels),
            witness_seen: scope.kept_storage("reuse witness", witnessed),
            found: scope.kept_storage("reuse found", 16 * found),
        }
    }
}

fn params(
    frame: &Frame<'_>,
    (map, faces): ([u32; 2], u32),
    levels: &[[u32; 2]],
    has_witness: bool,
    scope: &LightScope<'_>,
) -> ParamsUniform {
    let tiles = scope.size.map(|n| n.div_ceil(SIDE).div_ceil(SIDE));
    let groups = levels.iter().map(|side| {
        let [columns, rows] = side.map(|n| n.div_ceil(SIDE));
        [columns, rows, faces, 0]
    });
    let mut dispatches = [[0; 4]; MAX_DISPATCHES];
    let all = std::iter::once([tiles[0], tiles[1], 1, 0]).chain(groups);
    for (slot, groups) in dispatches.iter_mut().zip(all) {
        *slot = groups;
    }
    let (reach, margin) = match frame.reach {
        Reach::Pixels(margin) => (0, margin),
        Reach::Image => (1, 0.0),
    };
    ParamsUniform {
        pixels: scope.size,
        map,
        faces,
        generation: frame.generations.exact,
        frames: frame.reuse.frames.unwrap_or(u32::MAX),
        mask: match frame.reuse.mask {
            ReuseMask::Change => 0,
            ReuseMask::Geometry => 1,
        },
        margin,
        reach,
        has_witness: u32::from(has_witness),
        levels: levels.len() as u32,
        kin: match frame.reprojection(scope.light) {
            Some(_) => frame.generations.ignoring_camera,
            None => 0,
        },
        pad: [0; 3],
        dispatches,
    }
}

/// A technique's passes with those that find what is stale before the last one, and one that adds the kept light to the
/// lights before. Where the mask doesn't depend on the passes before the last one, it comes first, and they do nothing
/// where nothing is stale.
pub(crate) fn wrap(
    own: LightPasses,
    frame: &Frame<'_>,
    sum: (wgpu::TextureView, wgpu::BindGroup),
    scope: &mut LightScope<'_>,
) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let mut witness = own.witness;
    let (mut passes, gated) = match witness {
        Some(_) => (own.before, Vec::new()),
        None => (Vec::new(), own.before),
    };
    if frame.reuse.mask == ReuseMask::Geometry {
        let (touch, tiles) = touch(frame.moved, programs, scope);
        passes.extend(touch);
        witness = Some(tiles);
    }
    let buffers = Buffers::new(frame, witness.as_ref(), scope);
    passes.push(find(frame, witness.as_ref(), &buffers, programs, scope));
    if !gated.is_empty() {
        passes.extend(gate(gated, &buffers, &programs.gate, scope));
    }
    if let Some(stencil) = scope.stencil.clone() {
        passes.push(mark(&buffers, stencil, programs, scope));
    }
    if frame.reprojection(scope.light).is_some() {
        passes.push(restore(&buffers, programs, scope));
    }
    passes.push(own.last);
    let last = add(frame, &buffers, sum, programs, scope);
    let (buffer, offset) = (buffers.state, STALE);
    scope.count("stale pixels,", CountValue::Written { buffer, offset });
    LightPasses {
        before: passes,
        last,
        witness: None,
        visibility: own.visibility,
    }
}

/// Finds where the shadows of what moved are on the screen: the last pass's witness then.
fn touch(
    moved: &[Placed],
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> ([Pass; 3], wgpu::Buffer) {
    let occluders: Vec<Occluder<'_>> = moved.iter().map(Placed::as_occluder).collect();
    volumes::passes(&NAMES, &occluders, &programs.touched, scope)
}

const NAMES: Names = Names {
    places: "reuse places",
    params: "reuse occluders",
    list: "reuse list",
    counts: "reuse counts",
    eye: "reuse eye in shadow",
    tiles: "reuse what moved",
};

/// The dispatches that leave the pixels' ages.
fn find(
    frame: &Frame<'_>,
    witness: Option<&wgpu::Buffer>,
    buffers: &Buffers,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Pass {
    let levels: Vec<[u32; 4]> = (0..MAX_DISPATCHES as u32).map(|k| [k, 0, 0, 0]).collect();
    let levels = scope.blocks("reuse levels", levels);
    let [params, state, blocks] =
        [&buffers.params, &buffers.state, &buffers.blocks].map(|b| b.as_entire_binding());
    let count = scope.inputs.shadow_map.map_or(0, |map| {
        let size = map.texture().size();
        self::levels([size.width, size.height]).len()
    });
    let indirect =
        |index: usize| Workgroups::Indirect(buffers.dispatches.clone(), 12 * index as u64);
    let decide = [
        params.clone(),
        state.clone(),
        buffers.dispatches.as_entire_binding(),
    ];
    let mut dispatches = vec![scope.dispatch(&programs.decide, &decide, [1; 3])];
    if let Some(before) = frame.reprojection(scope.light) {
        dispatches.push(reproject(before, buffers, programs, scope));
    }
    for level in 0..count {
        let resources = [
            params.clone(),
            blocks.clone(),
            buffers.map_seen.as_entire_binding(),
            levels.binding(level as u32),
        ];
        let program = if level == 0 {
            &programs.change_finest
        } else {
            &programs.change_coarser
        };
        dispatches.push(scope.dispatch(program, &resources, indirect(1 + level)));
    }
    let absent = scope.storage("reuse no witness", 8);
    let witness = witness.unwrap_or(&absent);
    let tiles = [
        params,
        state,
        blocks,
        buffers.depth_seen.as_entire_binding(),
        buffers.age.as_entire_binding(),
        buffers.witness_seen.as_entire_binding(),
        witness.as_entire_binding(),
        buffers.found.as_entire_binding(),
    ];
    dispatches.push(scope.dispatch(&programs.tiles, &tiles, indirect(0)));
    Pass::compute(scope.pass_name("find stale pixels"), dispatches)
}

/// What is found in the picture of the frame before, which another camera took.
fn reproject(
    (before, tolerance): (Viewpoint, f32),
    buffers: &Buffers,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Dispatch {
    let uniform = ReprojectUniform {
        camera: before.camera,
        eye: (before.eye - scope.rays.eye).as_vec3().to_array(),
        tolerance,
        rounding: match scope.shared.output {
            wgpu::TextureFormat::Rgba16Float => 0.5_f32.powi(11),
            _ => 0.5_f32.powi(24),
        },
        pad: [0.0; 3],
    };
    let uniform = scope.uniform("reuse reproject", &uniform);
    let kept = scope.target.clone();
    let resources = [
        buffers.params.as_entire_binding(),
        uniform.as_entire_binding(),
        buffers.state.as_entire_binding(),
        wgpu::BindingResource::TextureView(&kept),
        buffers.depth_seen.as_entire_binding(),
        buffers.age.as_entire_binding(),
        buffers.found.as_entire_binding(),
    ];
    let groups = Workgroups::Indirect(buffers.dispatches.clone(), REPROJECT_GROUPS);
    scope.dispatch(&programs.reproject, &resources, groups)
}

/// Draws what was found there.
fn restore(buffers: &Buffers, programs: &Programs, scope: &LightScope<'_>) -> Pass {
    let resources = [&buffers.params, &buffers.found].map(|b| b.as_entire_binding());
    let draw = scope.draw(&programs.restore, &resources, scope.target.clone());
    let gate = Some((buffers.dispatches.clone(), RESTORE_VERTICES));
    of_draw(scope.pass_name("reproject"), FullScreen { gate, ..draw })
}

/// The stencil of the pixels that are stale.
fn mark(
    buffers: &Buffers,
    stencil: wgpu::TextureView,
    programs: &Programs,
    scope: &LightScope<'_>,
) -> Pass {
    let resources = [&buffers.params, &buffers.state, &buffers.age].map(|b| b.as_entire_binding());
    let program = &programs.stencil;
    let draw = Draw {
        pipeline: program.with_stencil(scope.device, scope.variant, Stencil::Written),
        groups: scope.groups(program.bind(scope.device, &resources)),
        vertices: Vertices::Direct {
            vertices: 3,
            instances: 1,
        },
    };
    Pass {
        name: scope.pass_name("mark stale pixels"),
        work: Work::Stencil { stencil, draw },
    }
}

/// Creates the pass that adds a light's kept in-scatter, or what is shown of its reuse, to the lights before. `sum` is
/// what it draws on, and bind group 0 with the lights before.
fn add(
    frame: &Frame<'_>,
    buffers: &Buffers,
    (sum, with_lights_before): (wgpu::TextureView, wgpu::BindGroup),
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Pass {
    let kept = scope.target.clone();
    scope.frame_group = with_lights_before;
    let own = [wgpu::BindingResource::TextureView(&kept)];
    let what = match frame.reuse.show {
        ReuseShow::Light => {
            let draw = scope.draw(&programs.sum, &own, sum);
            return of_draw(scope.pass_name("add light"), draw);
        }
        ReuseShow::Mask => 1,
        ReuseShow::Age => 2,
    };
    let what = scope.uniform("reuse show", &[what, 0u32, 0, 0]);
    let [kept] = own;
    let own = [
        buffers.params.as_entire_binding(),
        buffers.state.as_entire_binding(),
        buffers.age.as_entire_binding(),
        kept,
        what.as_entire_binding(),
    ];
    let draw = scope.draw(&programs.show, &own, sum);
    of_draw(scope.pass_name("show reuse"), draw)
}

fn of_draw(name: String, draw: FullScreen) -> Pass {
    Pass {
        name,
        work: Work::FullScreen(vec![draw]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_at_one_block_and_fit_the_dispatches() {
        for (map, expected) in [
            ([0, 0], vec![]),
            ([1, 1], vec![[1, 1]]),
            ([64, 20], vec![[8, 3], [4, 2], [2, 1], [1, 1]]),
        ] {
            assert_eq!(levels(map), expected);
        }
        assert!(levels([16_384; 2]).len() < MAX_DISPATCHES);
    }
}
