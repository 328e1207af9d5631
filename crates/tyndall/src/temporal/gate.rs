//! Makes passes do nothing where nothing is stale, though they are recorded.

use super::buffers::Buffers;
use crate::gpu::{
    pass::{Dispatch, Pass, Vertices, Work, Workgroups},
    pool::Owner,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

/// Bytes of the arguments of one dispatch or draw.
const STRIDE: u64 = 16;

/// The gate's shaders.
pub(super) struct Programs {
    open: ComputeProgram,
    pass: ComputeProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |module, entry_point| {
            ComputeProgram::new(device, shared, module, entry_point).for_all_lights()
        };
        Self {
            open: program("temporal::gate_open", "gate_open"),
            pass: program("temporal::gate_pass", "gate_pass"),
        }
    }
}

/// These passes with sizes that the GPU takes or leaves, after the one that says which.
pub(super) fn gate(
    passes: Vec<Pass>,
    buffers: &Buffers,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let slots = passes.iter().map(Pass::parts).sum::<usize>().max(1) as u64;
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
    let key = (Owner::Light(scope.index), "reuse gate");
    let arguments = scope.pool.buffer(scope.device, key, STRIDE * slots, usage);
    let mut gate = Gate {
        arguments,
        sizes: Vec::new(),
        written: Vec::new(),
    };
    let placed: Vec<Placed> = passes.into_iter().map(|pass| gate.place(pass)).collect();
    let own = [
        &buffers.params,
        &buffers.state,
        &buffers.blocks,
        &gate.arguments,
    ];
    let own = own.map(|buffer| buffer.as_entire_binding());
    let sizes = scope.upload("reuse gate sizes", &gate.sizes);
    let open = [&own[..], &[sizes.as_entire_binding()]].concat();
    let open = scope.dispatch(&programs.open, &open, [1; 3]);
    let words: Vec<[u32; 4]> = gate.written.iter().map(|written| written.words).collect();
    let words = scope.blocks("reuse gate words", words);
    let pass_on = |index: usize| {
        let written = gate.written[index].buffer.as_entire_binding();
        let resources = [&own[..], &[written, words.binding(index as u32)]].concat();
        scope.dispatch(&programs.pass, &resources, [1; 3])
    };
    let mut gated = vec![Pass::compute(scope.pass_name("gate"), vec![open])];
    gated.extend(placed.into_iter().flat_map(|placed| placed.gated(&pass_on)));
    gated
}

/// Sizes of a light's passes.
struct Gate {
    arguments: wgpu::Buffer,
    /// Sizes that are known beforehand; zeros where an earlier pass writes them.
    sizes: Vec<[u32; 4]>,
    written: Vec<Written>,
}

/// A size that an earlier pass writes.
struct Written {
    buffer: wgpu::Buffer,
    /// The first word there, how many, and the first of the gate's.
    words: [u32; 4],
}

/// A pass whose sizes are the gate's.
struct Placed {
    pass: Pass,
    /// For each dispatch or draw, which of [`Gate::written`] it waits for.
    waits: Vec<Option<usize>>,
}

impl Placed {
    /// The pass, with dispatches that pass the sizes on that it waits for, each right before it is needed.
    fn gated(self, pass_on: &dyn Fn(usize) -> Dispatch) -> Vec<Pass> {
        let Self { pass, waits } = self;
        match pass.work {
            Work::Compute(dispatches) => {
                let pairs = dispatches.into_iter().zip(waits);
                let dispatches = pairs
                    .flat_map(|(dispatch, wait)| wait.map(pass_on).into_iter().chain([dispatch]));
                vec![Pass::compute(pass.name, dispatches.collect())]
            }
            work => {
                let before: Vec<Dispatch> = waits.into_iter().flatten().map(pass_on).collect();
                let name = format!("gate of {}", pass.name);
                let before = (!before.is_empty()).then(|| Pass::compute(name, before));
                before.into_iter().chain([Pass { work, ..pass }]).collect()
            }
        }
    }
}

impl Gate {
    fn place(&mut self, mut pass: Pass) -> Placed {
        let mut waits = Vec::new();
        match &mut pass.work {
            Work::Compute(dispatches) => {
                for dispatch in dispatches {
                    let (place, wait) = match &dispatch.workgroups {
                        Workgroups::Count([x, y, z]) => (self.known([*x, *y, *z, 0]), None),
                        Workgroups::Indirect(buffer, offset) => self.wait(buffer, *offset, 3),
                    };
                    dispatch.workgroups = Workgroups::Indirect(place.0, place.1);
                    waits.push(wait);
                }
            }
            Work::FullScreen(draws) => {
                for draw in draws {
                    draw.gate = Some(self.known([3, 1, 0, 0]));
                }
            }
            Work::Draw { draws, .. } => {
                for draw in draws {
                    let (place, wait) = match &draw.vertices {
                        Vertices::Direct {
                            vertices,
                            instances,
                        } => (self.known([*vertices, *instances, 0, 0]), None),
                        Vertices::Indirect(buffer, offset) => self.wait(buffer, *offset, 4),
                    };
                    draw.vertices = Vertices::Indirect(place.0, place.1);
                    waits.push(wait);
                }
            }
            Work::Stencil { .. } => {}
        }
        Placed { pass, waits }
    }

    /// A place for this size.
    fn known(&mut self, size: [u32; 4]) -> (wgpu::Buffer, u64) {
        let offset = STRIDE * self.sizes.len() as u64;
        self.sizes.push(size);
        (self.arguments.clone(), offset)
    }

    /// A place for a size that is written elsewhere.
    fn wait(
        &mut self,
        buffer: &wgpu::Buffer,
        offset: u64,
        words: u32,
    ) -> ((wgpu::Buffer, u64), Option<usize>) {
        let place = self.known([0; 4]);
        self.written.push(Written {
            buffer: buffer.clone(),
            words: [(offset / 4) as u32, words, (place.1 / 4) as u32, 0],
        });
        (place, Some(self.written.len() - 1))
    }
}
