//! Passes as data, in the order they run.

use super::PassTimer;

/// A pass with a name that timings and captures show.
pub(crate) struct Pass {
    pub(crate) name: String,
    pub(crate) work: Work,
}

/// The passes of one light, in the order they run.
pub(crate) struct LightPasses {
    /// All but the last: they read the frame and the light, and write resources that the last one reads.
    pub(crate) before: Vec<Pass>,
    /// Writes the light's in-scatter to the scope's target, pixel by pixel.
    pub(crate) last: Pass,
    /// Buffer that the last pass reads at its own tile (see `passes/occluder/tile.wesl`) and that may change where neither
    /// depth nor shadow map do.
    pub(crate) witness: Option<wgpu::Buffer>,
    /// Share of the light that reaches each pixel's surface, where it was asked for and the technique computes it.
    pub(crate) visibility: Option<wgpu::TextureView>,
}

impl LightPasses {
    /// Passes whose last one reads nothing but the frame, the light and what those before it wrote.
    pub(crate) fn new(before: Vec<Pass>, last: Pass) -> Self {
        Self {
            before,
            last,
            witness: None,
            visibility: None,
        }
    }
}

/// The work of a pass.
pub(crate) enum Work {
    /// Dispatches, each of which sees what the ones before it wrote.
    Compute(Vec<Dispatch>),
    /// Triangles that cover their targets, whose former content is lost.
    FullScreen(Vec<FullScreen>),
    /// Draws one after the other, onto a cleared texture.
    Draw {
        target: wgpu::TextureView,
        draws: Vec<Draw>,
    },
    /// A triangle over the whole of a stencil, 0 before, that leaves 1 where it is not discarded.
    Stencil {
        stencil: wgpu::TextureView,
        draw: Draw,
    },
}

/// One dispatch.
pub(crate) struct Dispatch {
    pub(crate) pipeline: wgpu::ComputePipeline,
    /// Bind groups 0, 1 and so on.
    pub(crate) groups: Vec<wgpu::BindGroup>,
    pub(crate) workgroups: Workgroups,
}

/// The number of workgroups of a dispatch.
pub(crate) enum Workgroups {
    Count([u32; 3]),
    /// Three numbers that an earlier pass wrote to a buffer, at this offset \[bytes].
    Indirect(wgpu::Buffer, u64),
}

impl From<[u32; 3]> for Workgroups {
    fn from(count: [u32; 3]) -> Self {
        Self::Count(count)
    }
}

/// One full-screen draw.
pub(crate) struct FullScreen {
    pub(crate) pipeline: wgpu::RenderPipeline,
    /// Bind groups 0, 1 and so on.
    pub(crate) groups: Vec<wgpu::BindGroup>,
    pub(crate) target: wgpu::TextureView,
    /// If there is one, the target keeps its content, and is drawn on only where this is 1.
    pub(crate) stencil: Option<wgpu::TextureView>,
    /// If there is one, the draw's arguments are read from this buffer at this offset \[bytes], and the target keeps its
    /// content.
    pub(crate) gate: Option<(wgpu::Buffer, u64)>,
}

/// One draw.
pub(crate) struct Draw {
    pub(crate) pipeline: wgpu::RenderPipeline,
    /// Bind groups 0, 1 and so on.
    pub(crate) groups: Vec<wgpu::BindGroup>,
    pub(crate) vertices: Vertices,
}

/// The number of vertices of a draw.
pub(crate) enum Vertices {
    /// So many vertices, so many times.
    Direct { vertices: u32, instances: u32 },
    /// Arguments in a buffer, at this offset \[bytes].
    Indirect(wgpu::Buffer, u64),
}

impl Pass {
    /// Dispatches or draws in it.
    pub(crate) fn parts(&self) -> usize {
        match &self.work {
            Work::Compute(dispatches) => dispatches.len(),
            Work::FullScreen(draws) => draws.len(),
            Work::Draw { draws, .. } => draws.len(),
            Work::Stencil { .. } => 1,
        }
    }

    /// A pass of dispatches.
    pub(crate) fn compute(name: String, dispatches: Vec<Dispatch>) -> Self {
        Self {
            name,
            work: Work::Compute(dispatches),
        }
    }

    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, timer: Option<&mut PassTimer>) {
        match &self.work {
            Work::Compute(dispatches) => {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some(&self.name),
                    timestamp_writes: timer.and_then(|t| t.compute_pass(&self.name)),
                });
                for dispatch in dispatches {
                    pass.set_pipeline(&dispatch.pipeline);
                    for (i, group) in dispatch.groups.iter().enumerate() {
                        pass.set_bind_group(i as u32, group, &[]);
                    }
                    match &dispatch.workgroups {
                        Workgroups::Count([x, y, z]) => pass.dispatch_workgroups(*x, *y, *z),
                        Workgroups::Indirect(buffer, offset) => {
                            pass.dispatch_workgroups_indirect(buffer, *offset);
                        }
                    }
                }
            }
            Work::FullScreen(draws) => {
                let stamps = timer.and_then(|t| t.render_pass(&self.name));
                for (i, draw) in draws.iter().enumerate() {
                    let (first, last) = (i == 0, i + 1 == draws.len());
                    let of_whole = stamps.clone().filter(|_| first || last);
                    let stamps = of_whole.map(|s| wgpu::RenderPassTimestampWrites {
                        beginning_of_pass_write_index: s
                            .beginning_of_pass_write_index
                            .filter(|_| first),
                        end_of_pass_write_index: s.end_of_pass_write_index.filter(|_| last),
                        ..s
                    });
                    draw.record(&self.name, encoder, stamps);
                }
            }
            Work::Stencil { stencil, draw } => {
                let stamps = timer.and_then(|t| t.render_pass(&self.name));
                let cleared = Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0),
                    store: wgpu::StoreOp::Store,
                });
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some(&self.name),
                    depth_stencil_attachment: Some(stencil_attachment(stencil, cleared)),
                    timestamp_writes: stamps,
                    ..Default::default()
                });
                set(&mut pass, &draw.pipeline, &draw.groups);
                pass.set_stencil_reference(1);
                pass.draw(0..3, 0..1);
            }
            Work::Draw { target, draws } => {
                let stamps = timer.and_then(|t| t.render_pass(&self.name));
                let mut pass = begin(&self.name, encoder, target, Onto::Cleared, stamps);
                for draw in draws {
                    set(&mut pass, &draw.pipeline, &draw.groups);
                    match &draw.vertices {
                        Vertices::Direct {
                            vertices,
                            instances,
                        } => pass.draw(0..*vertices, 0..*instances),
                        Vertices::Indirect(buffer, offset) => pass.draw_indirect(buffer, *offset),
                    }
                }
            }
        }
    }
}

fn stencil_attachment(
    view: &wgpu::TextureView,
    stencil_ops: Option<wgpu::Operations<u32>>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: None,
        stencil_ops,
    }
}

/// The content that a render pass draws onto.
#[derive(Clone, Copy)]
enum Onto<'a> {
    /// None: the target is cleared.
    Cleared,
    /// The target's.
    Kept,
    /// The target's, through a stencil.
    Stencilled(&'a wgpu::TextureView),
}

fn begin<'e>(
    name: &str,
    encoder: &'e mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    onto: Onto<'_>,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(name),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: match onto {
                    Onto::Cleared => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    Onto::Kept | Onto::Stencilled(_) => wgpu::LoadOp::Load,
                },
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: match onto {
            Onto::Stencilled(stencil) => Some(stencil_attachment(stencil, None)),
            Onto::Cleared | Onto::Kept => None,
        },
        timestamp_writes,
        ..Default::default()
    })
}

fn set(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    groups: &[wgpu::BindGroup],
) {
    pass.set_pipeline(pipeline);
    for (i, group) in groups.iter().enumerate() {
        pass.set_bind_group(i as u32, group, &[]);
    }
}

impl FullScreen {
    fn record(
        &self,
        name: &str,
        encoder: &mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let onto = match (&self.stencil, &self.gate) {
            (Some(stencil), _) => Onto::Stencilled(stencil),
            (None, Some(_)) => Onto::Kept,
            (None, None) => Onto::Cleared,
        };
        let mut pass = begin(name, encoder, &self.target, onto, timestamp_writes);
        set(&mut pass, &self.pipeline, &self.groups);
        pass.set_stencil_reference(1);
        match &self.gate {
            None => pass.draw(0..3, 0..1),
            Some((buffer, offset)) => pass.draw_indirect(buffer, *offset),
        }
    }
}
