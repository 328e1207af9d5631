//! The effect in somebody's renderer: created once a device, prepared and recorded once a frame.

use std::sync::Arc;

use crate::{
    camera::CameraRays,
    composite::Composite,
    error::PrepareError,
    frame::{Emitter, Frame, Light},
    gpu::{
        PassTimer,
        layout::{self, Absent},
        pipeline::LightPipelines,
        uniforms::{FrameUniform, LightUniform},
    },
    techniques::{Backends, Technique, ray_march},
    validate,
};

/// What is fixed for the life of an [`Effect`].
#[derive(Clone, Copy, Debug)]
pub struct EffectOptions {
    /// Format of the colour target that [`Effect::composite`] draws on; must be blendable.
    pub target_format: wgpu::TextureFormat,
    /// Format of [`EffectView::output`].
    pub output: OutputPrecision,
}

/// Format of the in-scattered light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPrecision {
    /// `Rgba16Float`, for pictures.
    Half,
    /// `Rgba32Float`, for measuring.
    Full,
}

impl OutputPrecision {
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Half => wgpu::TextureFormat::Rgba16Float,
            Self::Full => wgpu::TextureFormat::Rgba32Float,
        }
    }
}

/// Why an effect or a view of it could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CreateError {
    /// The picture is empty or larger than the device's textures.
    #[error("a view must be 1 to {limit} pixels a side, found {} x {}", size[0], size[1])]
    Size {
        /// What was asked for [pixels].
        size: [u32; 2],
        /// The device's limit [pixels].
        limit: u32,
    },
    /// The device cannot blend the target's format.
    #[error("the target format must be blendable on this device, found {format:?}")]
    NotBlendable {
        /// What was asked for.
        format: wgpu::TextureFormat,
    },
}

/// The caller's pictures of one frame.
#[derive(Clone, Copy)]
pub struct FrameInputs<'a> {
    /// The depth buffer (2-D, one sample, depth aspect), of the view's size, in the camera's convention.
    pub depth: &'a wgpu::TextureView,
    /// One entry a light of the frame, in the same order.
    pub lights: &'a [LightInputs<'a>],
}

/// The caller's pictures of one light.
#[derive(Clone, Copy, Default)]
pub struct LightInputs<'a> {
    /// The shadow map: a depth texture viewed as a 2-D array of 1 layer, or of 6 for a cube.
    pub shadow_map: Option<&'a wgpu::TextureView>,
    /// Coloured glass: an `Rg32Uint` 2-D array, layer `face * layers + layer`; a texel is the layer's depth in the
    /// shadow map's convention as the bits of an f32, and its tint as three 10-bit square roots (red lowest).
    pub glass: Option<&'a wgpu::TextureView>,
    /// The light's texture: 2-D, filterable, linear when read.
    pub texture: Option<&'a wgpu::TextureView>,
}

/// The effect's pipelines. Immutable, one a device.
pub struct Effect {
    output: OutputPrecision,
    frame_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    absent: Absent,
    sampler: wgpu::Sampler,
    ray_march: LightPipelines,
    composite: Composite,
}

/// What one camera needs: textures of its size, buffers, and the frame that was prepared last.
pub struct EffectView {
    size: [u32; 2],
    format: wgpu::TextureFormat,
    frame_uniform: wgpu::Buffer,
    params_uniform: wgpu::Buffer,
    light_uniforms: Vec<wgpu::Buffer>,
    /// The sum of the lights goes to and fro between two pictures; the second is made with the second light.
    sums: Vec<wgpu::TextureView>,
    prepared: Vec<LightPass>,
    composite: Option<wgpu::BindGroup>,
}

/// One light, ready to be recorded.
struct LightPass {
    name: String,
    pipeline: Arc<wgpu::RenderPipeline>,
    groups: [wgpu::BindGroup; 3],
    target: usize,
}

impl Effect {
    /// Lays out every pipeline. Those that depend on the kind of light are compiled when the first such light is
    /// prepared, and kept.
    ///
    /// # Errors
    /// Where the device cannot blend the target format.
    pub fn new(device: &wgpu::Device, options: &EffectOptions) -> Result<Self, CreateError> {
        let format = options.target_format;
        let features = format.guaranteed_format_features(device.features());
        if !features
            .flags
            .contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
        {
            return Err(CreateError::NotBlendable { format });
        }
        let frame_layout = layout::frame(device);
        let light_layout = layout::light(device);
        let output = options.output.format();
        Ok(Self {
            output: options.output,
            ray_march: ray_march::gpu::pipelines(device, &frame_layout, &light_layout, output),
            composite: Composite::new(device, &frame_layout, format),
            frame_layout,
            light_layout,
            absent: Absent::new(device),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("tyndall light texture"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        })
    }

    /// Makes the textures of a camera of this size [pixels].
    ///
    /// # Errors
    /// Where the size is zero or beyond the device's textures.
    pub fn create_view(
        &self,
        device: &wgpu::Device,
        size: [u32; 2],
    ) -> Result<EffectView, CreateError> {
        let limit = device.limits().max_texture_dimension_2d;
        if size.iter().any(|n| !(1..=limit).contains(n)) {
            return Err(CreateError::Size { size, limit });
        }
        let format = self.output.format();
        Ok(EffectView {
            size,
            format,
            frame_uniform: uniform_buffer::<FrameUniform>(device, "tyndall frame"),
            params_uniform: uniform_buffer::<ray_march::gpu::ParamsUniform>(
                device,
                "tyndall params",
            ),
            light_uniforms: Vec::new(),
            sums: vec![sum_texture(device, size, format)],
            prepared: Vec::new(),
            composite: None,
        })
    }

    /// All that can fail: checks the frame and its inputs, and uploads what the passes read.
    ///
    /// # Errors
    /// Where the frame or an input is out of range, missing or of the wrong kind, or the technique cannot do it on
    /// the GPU. The view then still holds the frame that was prepared before.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        view: &mut EffectView,
        inputs: &FrameInputs<'_>,
        frame: &Frame,
    ) -> Result<(), PrepareError> {
        validate::frame(frame)?;
        validate::technique(frame, Backends::Gpu)?;
        validate::gpu_inputs(frame, inputs, view.size)?;
        let Technique::RayMarch(params) = &frame.technique else {
            return Err(PrepareError::Unsupported {
                technique: frame.technique.info().name,
                what: "its work on the GPU".into(),
            });
        };
        let rays = CameraRays::new(&frame.camera, view.size);
        let uniform = FrameUniform::new(frame, &rays, view.size);
        queue.write_buffer(&view.frame_uniform, 0, bytemuck::bytes_of(&uniform));
        let params = ray_march::gpu::ParamsUniform::new(params);
        queue.write_buffer(&view.params_uniform, 0, bytemuck::bytes_of(&params));

        // With no light at all, a black one still writes the transmittance.
        let black = (BLACK, LightInputs::default());
        let lights: Vec<(Light, LightInputs<'_>)> = if frame.lights.is_empty() {
            vec![black]
        } else {
            frame
                .lights
                .iter()
                .copied()
                .zip(inputs.lights.iter().copied())
                .collect()
        };
        view.grow(device, lights.len());
        let mut passes = Vec::with_capacity(lights.len());
        for (i, (light, light_inputs)) in lights.iter().enumerate() {
            let layers = light_inputs.glass.map(|glass| glass_layers(light, glass));
            let (uniform, variant) = LightUniform::new(light, rays.eye, layers);
            queue.write_buffer(&view.light_uniforms[i], 0, bytemuck::bytes_of(&uniform));
            let before = match i {
                0 => &self.absent.light,
                _ => &view.sums[(i - 1) % 2],
            };
            passes.push(LightPass {
                name: format!("ray march light {i}"),
                pipeline: self.ray_march.get(device, variant),
                groups: [
                    self.frame_group(device, view, inputs.depth, before),
                    self.light_group(device, &view.light_uniforms[i], light_inputs),
                    params_group(device, self.ray_march.params(), &view.params_uniform),
                ],
                target: i % 2,
            });
        }
        view.prepared = passes;
        view.composite = Some(self.frame_group(device, view, inputs.depth, view.output()));
        Ok(())
    }

    /// Records the passes of the frame that was prepared last; none before the first.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &mut EffectView,
        mut timer: Option<&mut PassTimer>,
    ) {
        for light in &view.prepared {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(&light.name),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view.sums[light.target],
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                timestamp_writes: timer.as_mut().and_then(|t| t.render_pass(&light.name)),
                ..Default::default()
            });
            pass.set_pipeline(&light.pipeline);
            for (i, group) in light.groups.iter().enumerate() {
                pass.set_bind_group(i as u32, group, &[]);
            }
            pass.draw(0..3, 0..1);
        }
    }

    /// Draws target * transmittance + in-scatter in the caller's pass, exactly per channel. The pass has one colour
    /// target of [`EffectOptions::target_format`] and of the view's size, no depth and one sample; its alpha stays.
    pub fn composite(&self, pass: &mut wgpu::RenderPass<'_>, view: &EffectView) {
        if let Some(frame) = &view.composite {
            self.composite.draw(pass, frame);
        }
    }

    fn frame_group(
        &self,
        device: &wgpu::Device,
        view: &EffectView,
        depth: &wgpu::TextureView,
        lights_before: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tyndall frame"),
            layout: &self.frame_layout,
            entries: &[
                buffer_entry(0, &view.frame_uniform),
                texture_entry(1, depth),
                texture_entry(2, lights_before),
            ],
        })
    }

    fn light_group(
        &self,
        device: &wgpu::Device,
        uniform: &wgpu::Buffer,
        inputs: &LightInputs<'_>,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tyndall light"),
            layout: &self.light_layout,
            entries: &[
                buffer_entry(0, uniform),
                texture_entry(1, inputs.shadow_map.unwrap_or(&self.absent.shadow_map)),
                texture_entry(2, inputs.glass.unwrap_or(&self.absent.glass)),
                texture_entry(3, inputs.texture.unwrap_or(&self.absent.picture)),
                wgpu::BindGroupEntry {
                    binding: 4,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
            ],
        })
    }
}

impl EffectView {
    /// In-scattered radiance [W/(m^2 sr)] in rgb, mean transmittance to the surface in a; of the frame recorded last.
    /// The view may be another one after `prepare` with another number of lights.
    pub fn output(&self) -> &wgpu::TextureView {
        let last = self.prepared.last().map_or(0, |pass| pass.target);
        &self.sums[last]
    }

    /// Width and height [pixels].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Bytes of the textures and buffers this view holds.
    pub fn bytes(&self) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(0));
        let picture = u64::from(self.size[0]) * u64::from(self.size[1]) * texel;
        let buffers = [&self.frame_uniform, &self.params_uniform]
            .into_iter()
            .chain(&self.light_uniforms);
        picture * self.sums.len() as u64 + buffers.map(wgpu::Buffer::size).sum::<u64>()
    }

    /// Makes what this many lights need.
    fn grow(&mut self, device: &wgpu::Device, lights: usize) {
        while self.light_uniforms.len() < lights {
            self.light_uniforms
                .push(uniform_buffer::<LightUniform>(device, "tyndall light"));
        }
        if lights > 1 && self.sums.len() == 1 {
            self.sums.push(sum_texture(device, self.size, self.format));
        }
    }
}

/// Stands in where a frame has no light.
const BLACK: Light = Light {
    emitter: Emitter::Directional {
        direction: [0.0, -1.0, 0.0],
        illuminance: [0.0; 3],
    },
    shadow: None,
    texture: None,
};

/// Layers a face of a glass texture.
fn glass_layers(light: &Light, glass: &wgpu::TextureView) -> u32 {
    glass.texture().depth_or_array_layers() / validate::faces(light)
}

fn uniform_buffer<T>(device: &wgpu::Device, label: &str) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn sum_texture(
    device: &wgpu::Device,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("tyndall in-scatter"),
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn params_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    params: &wgpu::Buffer,
) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("tyndall params"),
        layout,
        entries: &[buffer_entry(0, params)],
    })
}

fn buffer_entry(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: buffer.as_entire_binding(),
    }
}

fn texture_entry(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    }
}
