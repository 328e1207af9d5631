//! Shaders that read a light, and their pipelines: one a kind of light, compiled when the first such light is prepared.

use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

use super::{
    scope::Shared,
    shader::{self, FRAME_MODULES, LIGHT_MODULES},
    uniforms::LightVariant,
};

/// What a stencil is kept in.
pub(crate) const STENCIL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Stencil8;

/// What a render pipeline does with a stencil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Stencil {
    /// There is none.
    Absent,
    /// Draws where it is 1.
    Tested,
    /// Writes it, and no picture.
    Written,
}

impl Stencil {
    fn state(self) -> Option<wgpu::DepthStencilState> {
        let (compare, pass_op, write_mask) = match self {
            Self::Absent => return None,
            Self::Tested => (
                wgpu::CompareFunction::Equal,
                wgpu::StencilOperation::Keep,
                0,
            ),
            Self::Written => (
                wgpu::CompareFunction::Always,
                wgpu::StencilOperation::Replace,
                0xff,
            ),
        };
        let face = wgpu::StencilFaceState {
            compare,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op,
        };
        Some(wgpu::DepthStencilState {
            format: STENCIL_FORMAT,
            depth_write_enabled: None,
            depth_compare: None,
            stencil: wgpu::StencilState {
                front: face,
                back: face,
                read_mask: 0xff,
                write_mask,
            },
            bias: wgpu::DepthBiasState::default(),
        })
    }
}

/// Where a render pipeline's triangles come from and go to.
#[derive(Clone)]
pub(crate) struct Raster {
    /// Entry point of the vertex stage.
    pub(crate) vertex: &'static str,
    pub(crate) topology: wgpu::PrimitiveTopology,
    pub(crate) target: wgpu::ColorTargetState,
    pub(crate) stencil: Stencil,
}

impl Raster {
    /// One triangle over the whole of the target.
    pub(crate) fn full_screen(target: wgpu::ColorTargetState) -> Self {
        Self {
            vertex: "frame_full_screen",
            topology: wgpu::PrimitiveTopology::TriangleList,
            target,
            stencil: Stencil::Absent,
        }
    }

    /// A pipeline that draws so; vertices come from shaders alone, both sides are drawn, no depth.
    pub(crate) fn pipeline(
        &self,
        device: &wgpu::Device,
        label: &str,
        module: &wgpu::ShaderModule,
        entry_point: &str,
        layout: &wgpu::PipelineLayout,
        constants: &[(&str, f64)],
    ) -> wgpu::RenderPipeline {
        let target = [Some(self.target.clone())];
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants,
            ..Default::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(self.vertex),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry_point),
                compilation_options,
                targets: if self.stencil == Stencil::Written {
                    &[]
                } else {
                    &target
                },
            }),
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                ..Default::default()
            },
            depth_stencil: self.stencil.state(),
            multisample: wgpu::MultisampleState::default(),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A shader over bind groups 0 (frame), 1 (light) and 2 (its own).
pub(crate) struct Recipe {
    label: &'static str,
    entry_point: &'static str,
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    own: wgpu::BindGroupLayout,
    /// How a render pass draws.
    raster: Raster,
    /// Whether lights of different kinds need pipelines of their own.
    reads_light: bool,
    /// Overrides besides the light's.
    constants: Vec<(&'static str, f64)>,
}

/// A kind of pipeline.
pub(crate) trait Pipeline: Clone {
    fn make(
        device: &wgpu::Device,
        recipe: &Recipe,
        constants: &[(&str, f64)],
        stencil: Stencil,
    ) -> Self;
}

impl Pipeline for wgpu::ComputePipeline {
    fn make(
        device: &wgpu::Device,
        recipe: &Recipe,
        constants: &[(&str, f64)],
        _stencil: Stencil,
    ) -> Self {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(recipe.label),
            layout: Some(&recipe.layout),
            module: &recipe.module,
            entry_point: Some(recipe.entry_point),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            cache: None,
        })
    }
}

impl Pipeline for wgpu::RenderPipeline {
    fn make(
        device: &wgpu::Device,
        recipe: &Recipe,
        constants: &[(&str, f64)],
        stencil: Stencil,
    ) -> Self {
        let raster = Raster {
            stencil,
            ..recipe.raster.clone()
        };
        raster.pipeline(
            device,
            recipe.label,
            &recipe.module,
            recipe.entry_point,
            &recipe.layout,
            constants,
        )
    }
}

/// A shader and the pipelines made of it.
pub(crate) struct Program<P> {
    recipe: Recipe,
    made: Mutex<HashMap<(LightVariant, Stencil), P>>,
}

/// A program of dispatches.
pub(crate) type ComputeProgram = Program<wgpu::ComputePipeline>;
/// A program that draws a picture.
pub(crate) type ScreenProgram = Program<wgpu::RenderPipeline>;

impl<P: Pipeline> Program<P> {
    /// `wgsl` is what stands behind the modules of frame and light; `own` lays out bind group 2; a full-screen program
    /// writes the effect's output.
    pub(crate) fn new(
        device: &wgpu::Device,
        shared: &Shared,
        label: &'static str,
        wgsl: &[&str],
        entry_point: &'static str,
        own: &[wgpu::BindGroupLayoutEntry],
    ) -> Self {
        let own = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: own,
        });
        let groups = [
            Some(&shared.frame_layout),
            Some(&shared.light_layout),
            Some(&own),
        ];
        let recipe = Recipe {
            label,
            entry_point,
            module: shader::create(device, label, &[FRAME_MODULES, LIGHT_MODULES, wgsl]),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &groups,
                immediate_size: 0,
            }),
            own,
            raster: Raster::full_screen(shared.output.into()),
            reads_light: true,
            constants: Vec::new(),
        };
        Self {
            recipe,
            made: Mutex::default(),
        }
    }

    /// The same, but full-screen passes write this format.
    pub(crate) fn writing(mut self, format: wgpu::TextureFormat) -> Self {
        self.recipe.raster.target = format.into();
        self
    }

    /// The same, but drawing so.
    pub(crate) fn drawing(mut self, raster: Raster) -> Self {
        self.recipe.raster = raster;
        self
    }

    /// The same with another override.
    pub(crate) fn with(mut self, name: &'static str, value: f64) -> Self {
        self.recipe.constants.push((name, value));
        self
    }

    /// Of a shader that does not read the light: one pipeline does for all.
    pub(crate) fn for_all_lights(mut self) -> Self {
        self.recipe.reads_light = false;
        self
    }

    /// Bind group 2 of these resources, at bindings 0, 1 and so on.
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(resources.iter().cloned())
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.recipe.label),
            layout: &self.recipe.own,
            entries: &entries,
        })
    }

    /// The pipeline for this kind of light.
    pub(crate) fn get(&self, device: &wgpu::Device, variant: LightVariant) -> P {
        self.with_stencil(device, variant, Stencil::Absent)
    }

    /// The same for passes with a stencil.
    pub(crate) fn with_stencil(
        &self,
        device: &wgpu::Device,
        variant: LightVariant,
        stencil: Stencil,
    ) -> P {
        let variant = if self.recipe.reads_light {
            variant
        } else {
            LightVariant::default()
        };
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            let mut constants = variant.constants().to_vec();
            constants.extend(&self.recipe.constants);
            P::make(device, &self.recipe, &constants, stencil)
        };
        made.entry((variant, stencil)).or_insert_with(make).clone()
    }
}
