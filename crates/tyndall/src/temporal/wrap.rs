//! The passes about a technique's last one.

use std::mem::offset_of;

use super::{
    blocks::Pyramid,
    buffers::Buffers,
    change, decide,
    frame::Frame,
    gate::gate,
    history::Placed,
    options::{ReuseMask, ReuseShow},
    programs::Programs,
    reproject, restore,
    reuse::{MAX_DISPATCHES, ParamsUniform, State},
    show, stencil, sum, tiles,
};
use crate::{
    gpu::{
        pass::{LightPasses, Pass},
        scope::LightScope,
    },
    inputs::CountValue,
    mesh::Occluder,
    passes::occluder::{self as volumes, Names},
    shader::constant,
};

/// Adds to a technique's passes those that find the stale pixels, before its last one, and one that adds the kept light to
/// the lights before. Where the mask doesn't depend on the passes before the last one, it comes first, and they do nothing
/// where nothing is stale.
pub(super) fn wrap(
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
    let pyramid = Pyramid::new(scope);
    let buffers = buffers(frame, &pyramid, witness.as_ref(), programs, scope);
    let find = find(frame, &pyramid, witness.as_ref(), &buffers, programs, scope);
    passes.push(find);
    if !gated.is_empty() {
        passes.extend(gate(gated, &buffers, &programs.gate, scope));
    }
    if let Some(stencil) = scope.stencil.clone() {
        passes.push(stencil::pass(&programs.stencil, stencil, &buffers, scope));
    }
    if frame.reprojection(scope.light).is_some() {
        passes.push(restore::pass(&programs.restore, &buffers, scope));
    }
    passes.push(own.last);
    let last = add(frame, &buffers, sum, programs, scope);
    let (buffer, offset) = (buffers.state, offset_of!(State, stale) as u64);
    scope.count("stale pixels,", CountValue::Written { buffer, offset });
    LightPasses {
        before: passes,
        last,
        witness: None,
        visibility: own.visibility,
    }
}

/// Finds the shadow volumes of what moved on the screen: the last pass's witness then.
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

fn buffers(
    frame: &Frame<'_>,
    pyramid: &Pyramid,
    witness: Option<&wgpu::Buffer>,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Buffers {
    let tiles = tiles::workgroups(&programs.tiles, scope.size);
    let levels = pyramid.levels.iter().enumerate();
    let of_level =
        |(k, side): (usize, &[u32; 2])| programs.change.workgroups(k, *side, pyramid.faces);
    let dispatches = std::iter::once(tiles).chain(levels.map(of_level));
    let params = ParamsUniform::new(frame, pyramid, dispatches, witness.is_some(), scope);
    Buffers::new(frame, pyramid, &params, witness, scope)
}

/// Creates the dispatches that leave the pixels' ages.
fn find(
    frame: &Frame<'_>,
    pyramid: &Pyramid,
    witness: Option<&wgpu::Buffer>,
    buffers: &Buffers,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Pass {
    let numbers = (0..MAX_DISPATCHES as u32).map(|k| [k, 0, 0, 0]).collect();
    let numbers = scope.blocks("reuse levels", numbers);
    let mut dispatches = vec![decide::dispatch(&programs.decide, buffers, scope)];
    if let Some(before) = frame.reprojection(scope.light) {
        let program = &programs.reproject;
        dispatches.push(reproject::dispatch(program, before, buffers, scope));
    }
    let levels = pyramid.levels.len();
    let change = change::dispatches(levels, &numbers, &programs.change, buffers, scope);
    dispatches.extend(change);
    dispatches.push(tiles::dispatch(&programs.tiles, witness, buffers, scope));
    Pass::compute(scope.pass_name("find stale pixels"), dispatches)
}

/// Creates the pass that adds a light's kept in-scatter, or what is shown of its reuse, to the lights before. It draws on
/// the first of `sum`; the second is bind group 0 with the lights before.
fn add(
    frame: &Frame<'_>,
    buffers: &Buffers,
    (sum, with_lights_before): (wgpu::TextureView, wgpu::BindGroup),
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Pass {
    scope.frame_group = with_lights_before;
    let shown = match frame.reuse.show {
        ReuseShow::Light => return sum::pass(&programs.sum, sum, scope),
        ReuseShow::Mask => constant("SHOW_MASK"),
        ReuseShow::Age => constant("SHOW_AGE"),
    };
    show::pass(&programs.show, shown, sum, buffers, scope)
}
