//! Lit surfaces: the sky and emission first, then one light after the other added.

use std::sync::{Mutex, PoisonError};

use tyndall::{
    LightInputs,
    frame::{Frame, Light},
    gpu::{Bindings, PassTimer},
    shader::Linked,
};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupEntry, BindGroupLayout, BindGroupLayoutEntry, BindingType, BlendComponent,
    BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites, CommandEncoder, Device,
    PipelineCompilationOptions, PipelineLayout, Queue, RenderPipeline, ShaderModule, TextureFormat,
    TextureFormatFeatureFlags, TextureSampleType, TextureView, TextureViewDimension,
};

use super::{
    binding::uniform_entry,
    error::GpuSceneError,
    pipeline::{Layouts, cleared},
    shaders,
    targets::GBufferTargets,
    uniforms::{ShadeLightUniform, ShadeUniform},
};
use crate::shading::RECT_SAMPLES;

/// Adds to the target's colour.
const ADD: BlendState = {
    let component = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    };
    BlendState {
        color: component,
        alpha: component,
    }
};

/// The lights' inputs for surfaces: one entry a light of the frame, in the same order.
#[derive(Clone, Copy)]
pub struct SurfaceLights<'a> {
    /// A light without a shadow map, glass or texture is unshadowed, untinted or white.
    pub inputs: &'a [LightInputs<'a>],
    /// Factors on each pixel's direct light (rgb), of the G-buffer's size: for a rectangular light the texture of
    /// [`tyndall::EffectView::surface_light_visibility`]. Lights that the slice does not reach have none.
    pub visibility: &'a [Option<&'a TextureView>],
}

/// Values of the overrides of a kind of light.
type Constants = Vec<(&'static str, f64)>;

pub(super) struct ShadePipelines {
    /// Groups 0 and 2.
    bindings: Bindings,
    /// Group 1.
    surface_layout: BindGroupLayout,
    /// Group 3.
    light_layout: BindGroupLayout,
    base: RenderPipeline,
    light: LightPipelines,
}

/// A pipeline a kind of light, made when the first such light is drawn.
struct LightPipelines {
    linked: Linked,
    module: ShaderModule,
    layout: PipelineLayout,
    format: TextureFormat,
    made: Mutex<Vec<(Constants, RenderPipeline)>>,
}

impl LightPipelines {
    fn get(&self, device: &Device, constants: Constants) -> RenderPipeline {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = made.iter().find(|(of, _)| *of == constants) {
            return found.clone();
        }
        let pipeline = ShadePipeline {
            module: &self.module,
            entry_point: "shade_light_fragment",
            layout: &self.layout,
            constants: &constants,
            format: self.format,
            blend: Some(ADD),
        }
        .create(device);
        made.push((constants, pipeline.clone()));
        pipeline
    }
}

impl ShadePipelines {
    pub(super) fn new(device: &Device, format: TextureFormat) -> Result<Self, GpuSceneError> {
        let features = format.guaranteed_format_features(device.features());
        if !features
            .flags
            .contains(TextureFormatFeatureFlags::BLENDABLE)
        {
            return Err(GpuSceneError::TargetFormat { format });
        }
        let bindings = Bindings::new(device);
        let [frame, light] = bindings.layouts();
        // Normal, base colour, emission, view tint.
        let surface_layout = create_layout(device, 4);
        // Visibility.
        let light_layout = create_layout(device, 1);
        let layout = |groups: &[&BindGroupLayout]| Layouts::pipeline(device, groups);
        let base = ShadePipeline {
            module: &shaders::module(device, shaders::SHADE_BASE),
            entry_point: "shade_base_fragment",
            layout: &layout(&[frame, &surface_layout]),
            constants: &[],
            format,
            blend: None,
        }
        .create(device);
        let light = LightPipelines {
            linked: shaders::link(shaders::SHADE_LIGHT),
            module: shaders::module(device, shaders::SHADE_LIGHT),
            layout: layout(&[frame, &surface_layout, light, &light_layout]),
            format,
            made: Mutex::default(),
        };
        Ok(Self {
            base,
            light,
            surface_layout,
            light_layout,
            bindings,
        })
    }

    pub(super) fn record(
        &self,
        (device, queue): (&Device, &Queue),
        encoder: &mut CommandEncoder,
        target: &TextureView,
        g_buffer: &GBufferTargets,
        (frame, lights): (&Frame, SurfaceLights<'_>),
        timer: Option<&mut PassTimer>,
    ) {
        let (size, depth) = (g_buffer.size(), Some(&g_buffer.depth.view));
        let bindings = &self.bindings;
        let frame_group = bindings.frame_group(device, queue, frame, size, depth);
        let surface_group = self.surface_group(device, frame, g_buffer);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[cleared(target, wgpu::Color::TRANSPARENT)],
            timestamp_writes: timer.and_then(|t| t.render_pass("surfaces")),
            ..Default::default()
        });
        pass.set_pipeline(&self.base);
        pass.set_bind_group(0, &frame_group, &[]);
        pass.set_bind_group(1, &surface_group, &[]);
        pass.draw(0..3, 0..1);
        for (i, (light, inputs)) in frame.lights.iter().zip(lights.inputs).enumerate() {
            let visibility = lights.visibility.get(i).copied().flatten();
            let mut constants = Bindings::light_constants(&self.light.linked, light, inputs);
            // As uniforms they would have lavapipe 22.3 crash.
            constants.push(("SHADE_RECT_SAMPLES", RECT_SAMPLES.into()));
            constants.push(("SHADE_IS_SEEN", visibility.is_some().into()));
            let light_group = bindings.light_group(device, frame, i, inputs);
            let own_group = self.light_group(device, light, visibility, g_buffer);
            pass.set_pipeline(&self.light.get(device, constants));
            pass.set_bind_group(2, &light_group, &[]);
            pass.set_bind_group(3, &own_group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    /// Group 1: the G-buffer but for its depth.
    fn surface_group(
        &self,
        device: &Device,
        frame: &Frame,
        g_buffer: &GBufferTargets,
    ) -> BindGroup {
        create_bind_group(
            device,
            &self.surface_layout,
            bytemuck::bytes_of(&ShadeUniform::new(frame)),
            &[
                &g_buffer.normal.view,
                &g_buffer.base_color.view,
                &g_buffer.emissive.view,
                &g_buffer.view_tint.view,
            ],
        )
    }

    /// Group 3: a rectangle's edges, and the visibility.
    fn light_group(
        &self,
        device: &Device,
        light: &Light,
        visibility: Option<&TextureView>,
        g_buffer: &GBufferTargets,
    ) -> BindGroup {
        let uniform = ShadeLightUniform::new(light);
        // Something must be bound where there is no visibility, and is not read.
        let seen = visibility.unwrap_or(&g_buffer.view_tint.view);
        create_bind_group(
            device,
            &self.light_layout,
            bytemuck::bytes_of(&uniform),
            &[seen],
        )
    }
}

/// A uniform buffer of its own at binding 0, then the textures.
fn create_bind_group(
    device: &Device,
    layout: &BindGroupLayout,
    uniform: &[u8],
    textures: &[&TextureView],
) -> BindGroup {
    let buffer = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("surfaces"),
        contents: uniform,
        usage: wgpu::BufferUsages::UNIFORM,
    });
    let textures = textures
        .iter()
        .map(|view| wgpu::BindingResource::TextureView(view));
    let resources = std::iter::once(buffer.as_entire_binding()).chain(textures);
    let entries: Vec<BindGroupEntry<'_>> = (0..)
        .zip(resources)
        .map(|(binding, resource)| BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("surfaces"),
        layout,
        entries: &entries,
    })
}

/// A uniform buffer at binding 0, then so many textures of floats.
fn create_layout(device: &Device, textures: u32) -> BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT;
    let mut entries = vec![uniform_entry(visibility)];
    entries.extend((1..=textures).map(|binding| BindGroupLayoutEntry {
        binding,
        visibility,
        ty: BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: false },
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("surfaces"),
        entries: &entries,
    })
}

/// A triangle over the whole image.
struct ShadePipeline<'a> {
    module: &'a ShaderModule,
    entry_point: &'a str,
    layout: &'a PipelineLayout,
    constants: &'a [(&'static str, f64)],
    format: TextureFormat,
    blend: Option<BlendState>,
}

impl ShadePipeline<'_> {
    fn create(&self, device: &Device) -> RenderPipeline {
        let compilation_options = PipelineCompilationOptions {
            constants: self.constants,
            ..Default::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.entry_point),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some("frame_full_screen"),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(self.entry_point),
                compilation_options,
                targets: &[Some(ColorTargetState {
                    format: self.format,
                    blend: self.blend,
                    write_mask: ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
