//! The shaders of temporal reuse.

use std::sync::Arc;

use super::{change, decide, gate, reproject, restore, show, stencil, sum, tiles};
use crate::{
    gpu::{
        cache,
        program::{ComputeProgram, ScreenProgram},
        scope::Shared,
    },
    passes::occluder::VolumePrograms,
};

pub(super) struct Programs {
    pub(super) decide: ComputeProgram,
    pub(super) change: change::Programs,
    pub(super) reproject: ComputeProgram,
    pub(super) tiles: ComputeProgram,
    pub(super) stencil: ScreenProgram,
    pub(super) restore: ScreenProgram,
    pub(super) sum: ScreenProgram,
    pub(super) show: ScreenProgram,
    /// Those that find the shadow volumes of what moved.
    pub(super) touched: Arc<VolumePrograms>,
    pub(super) gate: gate::Programs,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            decide: decide::program(device, shared),
            change: change::Programs::new(device, shared),
            reproject: reproject::program(device, shared),
            tiles: tiles::program(device, shared),
            stencil: stencil::program(device, shared),
            restore: restore::program(device, shared),
            sum: sum::program(device, shared),
            show: show::program(device, shared),
            touched: shared.programs(device),
            gate: gate::Programs::new(device, shared),
        }
    }
}
