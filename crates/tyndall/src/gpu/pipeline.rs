//! Full-screen pipelines: one a kind of light, compiled when the first light of that kind is prepared.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use super::{
    shader::{self, FRAME_MODULES, LIGHT_MODULES},
    uniforms::LightVariant,
};

/// A full-screen pipeline that writes `target`.
pub(crate) fn full_screen(
    device: &wgpu::Device,
    label: &str,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    layout: &wgpu::PipelineLayout,
    target: wgpu::ColorTargetState,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("frame_full_screen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            targets: &[Some(target)],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

/// The pipelines of a full-screen pass that computes one light.
pub(crate) struct LightPipelines {
    label: &'static str,
    entry_point: &'static str,
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    params: wgpu::BindGroupLayout,
    output: wgpu::TextureFormat,
    made: Mutex<HashMap<LightVariant, Arc<wgpu::RenderPipeline>>>,
}

impl LightPipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        label: &'static str,
        wgsl: &str,
        entry_point: &'static str,
        [frame, light]: [&wgpu::BindGroupLayout; 2],
        params: wgpu::BindGroupLayout,
        output: wgpu::TextureFormat,
    ) -> Self {
        Self {
            label,
            entry_point,
            module: shader::create(device, label, &[FRAME_MODULES, LIGHT_MODULES, &[wgsl]]),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(frame), Some(light), Some(&params)],
                immediate_size: 0,
            }),
            params,
            output,
            made: Mutex::default(),
        }
    }

    /// Layout of bind group 2, the pass's own parameters.
    pub(crate) fn params(&self) -> &wgpu::BindGroupLayout {
        &self.params
    }

    /// The pipeline for this kind of light.
    pub(crate) fn get(
        &self,
        device: &wgpu::Device,
        variant: LightVariant,
    ) -> Arc<wgpu::RenderPipeline> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            Arc::new(full_screen(
                device,
                self.label,
                &self.module,
                self.entry_point,
                &self.layout,
                self.output.into(),
                &variant.constants(),
            ))
        };
        Arc::clone(made.entry(variant).or_insert_with(make))
    }
}
