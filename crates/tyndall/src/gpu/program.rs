//! Shaders that read a light, and their pipelines: one a kind of light, compiled when the first such light is prepared.

use std::{
    collections::HashMap,
    sync::{
        Arc, Mutex, OnceLock, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use super::{shader::Shader, shared::Shared, uniforms::LightVariant};

/// Format of stencils.
pub(crate) const STENCIL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Stencil8;

/// A render pipeline's use of a stencil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Stencil {
    /// There is none.
    Absent,
    /// Draws where it is 1.
    Tested,
    /// Writes it, and no colour.
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

/// A render pipeline's vertices, and its target.
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

    /// Creates the pipeline: no vertex buffers, culling or depth.
    pub(crate) fn pipeline(
        &self,
        device: &wgpu::Device,
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
            label: Some(entry_point),
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
    entry_point: &'static str,
    shader: Arc<Shader>,
    shared: [wgpu::BindGroupLayout; 2],
    /// The settings of a render pipeline.
    raster: Raster,
    /// True where lights of different kinds need pipelines of their own.
    reads_light: bool,
    /// Overrides besides the light's.
    constants: Vec<(&'static str, f64)>,
    /// The effect's count of pipelines.
    pipelines: Arc<AtomicUsize>,
}

/// Layouts of what the entry points of a recipe bind themselves.
struct Own {
    /// Binding numbers of group 2, in order.
    bindings: Vec<u32>,
    group: wgpu::BindGroupLayout,
    pipeline: wgpu::PipelineLayout,
}

impl Recipe {
    /// The variant but for what the shader does not read, so that one pipeline does for all that differ in nothing else.
    fn needed(&self, variant: LightVariant) -> LightVariant {
        let reads_medium = self.shader.reflection.has_override("MEDIUM_PHASES");
        let phases = if reads_medium { variant.phases } else { 0 };
        let light = if self.reads_light {
            variant
        } else {
            LightVariant::default()
        };
        LightVariant { phases, ..light }
    }

    fn own(&self, device: &wgpu::Device) -> Own {
        let entry_points = [self.entry_point, self.raster.vertex];
        let entries = self.shader.reflection.bindings_of(2, &entry_points);
        let group = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(self.entry_point),
            entries: &entries,
        });
        let [frame, light] = &self.shared;
        let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.entry_point),
            bind_group_layouts: &[Some(frame), Some(light), Some(&group)],
            immediate_size: 0,
        });
        Own {
            bindings: entries.iter().map(|entry| entry.binding).collect(),
            group,
            pipeline,
        }
    }
}

/// A kind of pipeline.
pub(crate) trait Pipeline: Clone {
    fn make(
        device: &wgpu::Device,
        recipe: &Recipe,
        layout: &wgpu::PipelineLayout,
        constants: &[(&str, f64)],
        stencil: Stencil,
    ) -> Self;
}

impl Pipeline for wgpu::ComputePipeline {
    fn make(
        device: &wgpu::Device,
        recipe: &Recipe,
        layout: &wgpu::PipelineLayout,
        constants: &[(&str, f64)],
        _stencil: Stencil,
    ) -> Self {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(recipe.entry_point),
            layout: Some(layout),
            module: &recipe.shader.module,
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
        layout: &wgpu::PipelineLayout,
        constants: &[(&str, f64)],
        stencil: Stencil,
    ) -> Self {
        let raster = Raster {
            stencil,
            ..recipe.raster.clone()
        };
        raster.pipeline(
            device,
            &recipe.shader.module,
            recipe.entry_point,
            layout,
            constants,
        )
    }
}

/// A shader's entry point and the pipelines made of it.
pub(crate) struct Program<P> {
    recipe: Recipe,
    own: OnceLock<Own>,
    made: Mutex<HashMap<(LightVariant, Stencil), P>>,
}

/// A program of dispatches.
pub(crate) type ComputeProgram = Program<wgpu::ComputePipeline>;
/// A program that draws.
pub(crate) type ScreenProgram = Program<wgpu::RenderPipeline>;

impl<P: Pipeline> Program<P> {
    /// The entry point of a module of the package, by its path without the package's name. A full-screen program writes
    /// the effect's output.
    pub(crate) fn new(
        device: &wgpu::Device,
        shared: &Shared,
        module: &'static str,
        entry_point: &'static str,
    ) -> Self {
        let recipe = Recipe {
            entry_point,
            shader: shared.shaders.get(device, module),
            shared: shared.bindings.layouts().map(Clone::clone),
            raster: Raster::full_screen(shared.output.into()),
            reads_light: true,
            constants: Vec::new(),
            pipelines: Arc::clone(&shared.pipelines),
        };
        Self {
            recipe,
            own: OnceLock::new(),
            made: Mutex::default(),
        }
    }

    /// Has full-screen passes write this format.
    pub(crate) fn writing(mut self, format: wgpu::TextureFormat) -> Self {
        self.recipe.raster.target = format.into();
        self
    }

    /// Has the pipeline draw so.
    pub(crate) fn drawing(mut self, raster: Raster) -> Self {
        self.recipe.raster = raster;
        self
    }

    /// Sets an override.
    pub(crate) fn with(mut self, name: &'static str, value: f64) -> Self {
        self.recipe.constants.push((name, value));
        self
    }

    /// The program with more overrides.
    pub(crate) fn with_all(mut self, constants: &[(&'static str, f64)]) -> Self {
        self.recipe.constants.extend(constants);
        self
    }

    /// Says that the shader does not read the light: one pipeline serves all.
    pub(crate) fn for_all_lights(mut self) -> Self {
        self.recipe.reads_light = false;
        self
    }

    /// Bind group 2 of these resources, in the order of their bindings from 0 on. Those that the entry point does not read
    /// are left out.
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let own = self.own(device);
        let entry = |binding: &u32| {
            let resource = resources.get(*binding as usize)?.clone();
            let binding = *binding;
            Some(wgpu::BindGroupEntry { binding, resource })
        };
        let entries: Vec<_> = own.bindings.iter().filter_map(entry).collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.recipe.entry_point),
            layout: &own.group,
            entries: &entries,
        })
    }

    fn own(&self, device: &wgpu::Device) -> &Own {
        self.own.get_or_init(|| self.recipe.own(device))
    }

    /// Workgroups that take so many invocations in x, y and z.
    ///
    /// # Panics
    /// Panics if the entry point is of no compute shader.
    pub(crate) fn workgroups(&self, invocations: [u32; 3]) -> [u32; 3] {
        let size = self
            .recipe
            .shader
            .reflection
            .workgroup_size(self.recipe.entry_point);
        let size = size.expect("a compute shader");
        std::array::from_fn(|axis| invocations[axis].div_ceil(size[axis]))
    }

    /// The pipeline for this kind of light.
    pub(crate) fn get(&self, device: &wgpu::Device, variant: LightVariant) -> P {
        self.with_stencil(device, variant, Stencil::Absent)
    }

    /// The pipeline for this kind of light, in passes with a stencil.
    pub(crate) fn with_stencil(
        &self,
        device: &wgpu::Device,
        variant: LightVariant,
        stencil: Stencil,
    ) -> P {
        let variant = self.recipe.needed(variant);
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            let mut constants = variant.constants().to_vec();
            constants.extend(&self.recipe.constants);
            constants.retain(|(name, _)| self.recipe.shader.reflection.has_override(name));
            let layout = &self.own(device).pipeline;
            self.recipe.pipelines.fetch_add(1, Ordering::Relaxed);
            P::make(device, &self.recipe, layout, &constants, stencil)
        };
        made.entry((variant, stencil)).or_insert_with(make).clone()
    }
}
