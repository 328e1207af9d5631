//! Common parts of the pipelines that draw the scene's triangles.

use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupLayout, ColorTargetState, CompareFunction, DepthStencilState, Device,
    PipelineCompilationOptions, PipelineLayout, RenderPipeline, ShaderModule,
};

use super::{
    binding::uniform_entry, material::Materials, mesh::VERTEX_LAYOUTS, targets::DEPTH_FORMAT,
    view::ViewUniform,
};

/// The bind-group layouts of everything that draws triangles.
pub(super) struct Layouts {
    pub(super) view: BindGroupLayout,
    pub(super) material: BindGroupLayout,
}

impl Layouts {
    pub(super) fn new(device: &Device) -> Self {
        Self {
            view: device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("view"),
                entries: &[uniform_entry(wgpu::ShaderStages::VERTEX_FRAGMENT)],
            }),
            material: Materials::layout(device),
        }
    }

    /// A pipeline layout with these groups.
    pub(super) fn pipeline(device: &Device, groups: &[&BindGroupLayout]) -> PipelineLayout {
        let groups: Vec<_> = groups.iter().copied().map(Some).collect();
        device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        })
    }

    /// Group 0: one view, in a buffer of its own, so that any number of views can be recorded before a submission.
    pub(super) fn view_bind_group(&self, device: &Device, view: &ViewUniform) -> BindGroup {
        let buffer = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("view"),
            contents: bytemuck::bytes_of(view),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout: &self.view,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: buffer.as_entire_binding(),
            }],
        })
    }
}

/// One thing for depth buffers with 0 at the near plane and one for those with 1 there.
pub(super) struct ByDepth<T> {
    standard: T,
    reversed: T,
}

impl<T> ByDepth<T> {
    pub(super) fn new(make: impl Fn(bool) -> T) -> Self {
        Self {
            standard: make(false),
            reversed: make(true),
        }
    }

    pub(super) fn get(&self, reversed: bool) -> &T {
        if reversed {
            &self.reversed
        } else {
            &self.standard
        }
    }
}

/// The depth that a cleared depth buffer holds.
pub(super) fn far_depth(reversed: bool) -> f32 {
    if reversed { 0.0 } else { 1.0 }
}

/// A pipeline that draws the scene's triangles: both sides of each, with `mesh_vertex`.
pub(super) struct MeshPipeline<'a> {
    pub(super) label: &'a str,
    pub(super) layout: &'a PipelineLayout,
    pub(super) module: &'a ShaderModule,
    /// The fragment stage's entry point; `None` writes depth alone.
    pub(super) fragment: Option<&'a str>,
    pub(super) constants: &'a [(&'a str, f64)],
    pub(super) targets: &'a [Option<ColorTargetState>],
    pub(super) reversed_depth: bool,
    pub(super) writes_depth: bool,
}

impl MeshPipeline<'_> {
    pub(super) fn create(&self, device: &Device) -> RenderPipeline {
        let compare = if self.reversed_depth {
            CompareFunction::Greater
        } else {
            CompareFunction::Less
        };
        let compilation_options = PipelineCompilationOptions {
            constants: self.constants,
            ..Default::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some("mesh_vertex"),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &VERTEX_LAYOUTS,
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(self.writes_depth),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: self.fragment.map(|entry_point| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(entry_point),
                compilation_options,
                targets: self.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A colour attachment that is cleared first.
pub(super) fn cleared(
    view: &wgpu::TextureView,
    color: wgpu::Color,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(color),
            store: wgpu::StoreOp::Store,
        },
    })
}

/// A depth attachment that is cleared to the far plane first.
pub(super) fn cleared_depth(
    view: &wgpu::TextureView,
    reversed_depth: bool,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(far_depth(reversed_depth)),
            store,
        }),
        stencil_ops: None,
    }
}
