//! Lit surfaces: the sky and emission first, then one light after the other added.

use tyndall::{
    LightInputs,
    camera::CameraRays,
    frame::{Frame, Light},
    gpu::PassTimer,
};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupEntry, BindGroupLayout, BindGroupLayoutEntry, BindingResource, BindingType,
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    CommandEncoder, Device, RenderPipeline, Sampler, TextureFormat, TextureFormatFeatureFlags,
    TextureSampleType, TextureView, TextureViewDimension,
};

use super::{
    binding::uniform_entry,
    error::GpuSceneError,
    pipeline::{Layouts, cleared},
    shaders::{self, Shader},
    targets::{Absent, GBufferTargets},
    uniforms::{ShadeLightUniform, ShadeViewUniform},
};

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

pub(super) struct ShadePipelines {
    view_layout: BindGroupLayout,
    light_layout: BindGroupLayout,
    base: RenderPipeline,
    light: RenderPipeline,
    picture_sampler: Sampler,
    absent: Absent,
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
        let view_layout = view_layout(device);
        let light_layout = light_layout(device);
        let pipeline = |shader, entry_point, groups: &[&BindGroupLayout], blend| {
            create_pipeline(device, shader, entry_point, groups, format, blend)
        };
        Ok(Self {
            base: pipeline(
                &shaders::SHADE_BASE,
                "shade_base_fragment",
                &[&view_layout],
                None,
            ),
            light: pipeline(
                &shaders::SHADE_LIGHT,
                "shade_light_fragment",
                &[&view_layout, &light_layout],
                Some(ADD),
            ),
            view_layout,
            light_layout,
            // Border colours are optional: the shader itself is black outside the texture.
            picture_sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("light texture"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            absent: Absent::new(device),
        })
    }

    pub(super) fn record(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        g_buffer: &GBufferTargets,
        (frame, lights): (&Frame, SurfaceLights<'_>),
        timer: Option<&mut PassTimer>,
    ) {
        let rays = CameraRays::new(&frame.camera, g_buffer.size());
        let view = self.view_group(device, &ShadeViewUniform::new(frame, &rays), g_buffer);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[cleared(target, wgpu::Color::TRANSPARENT)],
            timestamp_writes: timer.and_then(|t| t.render_pass("surfaces")),
            ..Default::default()
        });
        pass.set_bind_group(0, &view, &[]);
        pass.set_pipeline(&self.base);
        pass.draw(0..3, 0..1);
        pass.set_pipeline(&self.light);
        for (i, (light, inputs)) in frame.lights.iter().zip(lights.inputs).enumerate() {
            let visibility = lights.visibility.get(i).copied().flatten();
            let light = (light, inputs, visibility);
            pass.set_bind_group(1, &self.light_group(device, light, &rays), &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn view_group(
        &self,
        device: &Device,
        uniform: &ShadeViewUniform,
        g_buffer: &GBufferTargets,
    ) -> BindGroup {
        create_bind_group(
            device,
            &self.view_layout,
            bytemuck::bytes_of(uniform),
            &[
                &g_buffer.depth,
                &g_buffer.normal,
                &g_buffer.base_color,
                &g_buffer.emissive,
                &g_buffer.view_tint,
            ]
            .map(|target| BindingResource::TextureView(&target.view)),
        )
    }

    fn light_group(
        &self,
        device: &Device,
        (light, inputs, visibility): (&Light, &LightInputs<'_>, Option<&TextureView>),
        rays: &CameraRays,
    ) -> BindGroup {
        let mut uniform = ShadeLightUniform::new(light, inputs, rays.eye);
        uniform.visibility = visibility.is_some().into();
        let absent = &self.absent;
        create_bind_group(
            device,
            &self.light_layout,
            bytemuck::bytes_of(&uniform),
            &[
                BindingResource::TextureView(inputs.shadow_map.unwrap_or(&absent.shadow_map)),
                BindingResource::TextureView(inputs.glass.unwrap_or(&absent.glass)),
                BindingResource::TextureView(inputs.texture.unwrap_or(&absent.picture)),
                BindingResource::Sampler(&self.picture_sampler),
                BindingResource::TextureView(visibility.unwrap_or(&absent.picture)),
            ],
        )
    }
}

/// A uniform buffer of its own at binding 0, then the resources.
fn create_bind_group(
    device: &Device,
    layout: &BindGroupLayout,
    uniform: &[u8],
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let buffer = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("surfaces"),
        contents: uniform,
        usage: wgpu::BufferUsages::UNIFORM,
    });
    let resources = std::iter::once(buffer.as_entire_binding()).chain(resources.iter().cloned());
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

fn view_layout(device: &Device) -> BindGroupLayout {
    let float = TextureSampleType::Float { filterable: false };
    let dimension = TextureViewDimension::D2;
    create_layout(
        device,
        &[
            texture(TextureSampleType::Depth, dimension),
            texture(float, dimension),
            texture(float, dimension),
            texture(float, dimension),
            texture(float, dimension),
        ],
    )
}

fn light_layout(device: &Device) -> BindGroupLayout {
    create_layout(
        device,
        &[
            texture(TextureSampleType::Depth, TextureViewDimension::D2Array),
            texture(TextureSampleType::Uint, TextureViewDimension::D2Array),
            texture(
                TextureSampleType::Float { filterable: true },
                TextureViewDimension::D2,
            ),
            BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            texture(
                TextureSampleType::Float { filterable: false },
                TextureViewDimension::D2,
            ),
        ],
    )
}

fn texture(sample_type: TextureSampleType, view_dimension: TextureViewDimension) -> BindingType {
    BindingType::Texture {
        sample_type,
        view_dimension,
        multisampled: false,
    }
}

/// A uniform buffer at binding 0, then these.
fn create_layout(device: &Device, bindings: &[BindingType]) -> BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT;
    let mut entries = vec![uniform_entry(visibility)];
    entries.extend(
        (1..)
            .zip(bindings)
            .map(|(binding, &ty)| BindGroupLayoutEntry {
                binding,
                visibility,
                ty,
                count: None,
            }),
    );
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("surfaces"),
        entries: &entries,
    })
}

fn create_pipeline(
    device: &Device,
    shader: &Shader,
    entry_point: &str,
    groups: &[&BindGroupLayout],
    format: TextureFormat,
    blend: Option<BlendState>,
) -> RenderPipeline {
    let module = shader.module(device);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(shader.name),
        layout: Some(&Layouts::pipeline(device, groups)),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("shade_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(ColorTargetState {
                format,
                blend,
                write_mask: ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
