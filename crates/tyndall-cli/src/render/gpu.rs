//! The pipeline on the GPU: an engine in small that hands tyndall its depth buffer and its shadow maps.

use std::sync::{Arc, Mutex, PoisonError};

use tyndall::{
    Effect, EffectOptions, EffectView, FrameInputs, LightInputs, OutputPrecision, gpu::PassTimer,
};
use tyndall_scene::gpu::{
    GBufferTargets, GlassMapTarget, SceneRenderer, ShadowMapTarget, readback, upload_light_texture,
};
use wgpu::{CommandEncoder, Device, Queue, Texture, TextureFormat, TextureUsages, TextureView};

use super::{Needs, Rendered, backend::Gpu, depth_layer, rgb};
use crate::{failure::Failure, layer::Layer, picture::Picture, progress::Stages, setup::Setup};

/// More passes than this go untimed.
const TIMED_PASSES: u32 = 256;

pub(super) fn render(
    setup: &Setup,
    gpu: &Gpu,
    needs: Needs,
    layers: &[Layer],
    stages: &mut Stages,
) -> Result<Rendered, Failure> {
    let errors = DeviceErrors::watch(&gpu.device);
    let pipeline = stages.run("build pipelines and upload", |_| {
        Pipeline::new(setup, gpu, needs)
    });
    let mut pipeline = errors.else_result(pipeline)?;
    let rendered = stages.run("render", |_| pipeline.render(setup, needs, layers));
    errors.else_result(rendered)
}

/// The first error that the device reports outside any call's result.
struct DeviceErrors(Arc<Mutex<Option<String>>>);

impl DeviceErrors {
    fn watch(device: &Device) -> Self {
        let first = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&first);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
            slot.get_or_insert_with(|| error.to_string());
        }));
        Self(first)
    }

    /// The error that was reported, which is why the result failed if it did; the result where there is none.
    fn else_result<T>(&self, result: Result<T, Failure>) -> Result<T, Failure> {
        match &*self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(message) => Err(Failure::Device(anyhow::anyhow!(
                "the device failed: {message}"
            ))),
            None => result,
        }
    }
}

/// Everything that is made once and would hold for any number of frames.
struct Pipeline {
    device: Device,
    queue: Queue,
    renderer: SceneRenderer,
    effect: Effect,
    view: EffectView,
    g_buffer: GBufferTargets,
    color: ColorTarget,
    lights: Vec<LightTargets>,
    timer: Option<PassTimer>,
}

impl Pipeline {
    fn new(setup: &Setup, gpu: &Gpu, needs: Needs) -> Result<Self, Failure> {
        let Gpu { device, queue, .. } = gpu;
        let format = target_format(device);
        let renderer = SceneRenderer::new(device, queue, &setup.scene, format);
        let renderer = renderer.map_err(Failure::device)?;
        let options = EffectOptions {
            target_format: format,
            output: OutputPrecision::Full,
        };
        let effect = Effect::new(device, &options).map_err(Failure::device)?;
        let view = effect.create_view(device, setup.size);
        let lights = (0..setup.lights.len())
            .map(|index| LightTargets::new(setup, index, gpu, &renderer, needs))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            view: view.map_err(Failure::device)?,
            g_buffer: GBufferTargets::new(device, setup.size).map_err(Failure::device)?,
            color: ColorTarget::new(device, setup.size, format),
            timer: PassTimer::new(device, TIMED_PASSES),
            device: device.clone(),
            queue: queue.clone(),
            renderer,
            effect,
            lights,
        })
    }

    fn render(
        &mut self,
        setup: &Setup,
        needs: Needs,
        layers: &[Layer],
    ) -> Result<Rendered, Failure> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.draw_light_maps(setup, &mut encoder);
        self.draw_camera(setup, needs, &mut encoder);
        if needs.in_scatter {
            self.draw_in_scatter(setup, &mut encoder)?;
        }
        self.queue.submit([encoder.finish()]);
        // The composite draws on the surface, so that is read first.
        let surface = self.read_if(layers.contains(&Layer::Surface), &self.color.texture)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        if layers.contains(&Layer::Final) {
            let mut pass = self.color.begin_pass(&mut encoder, self.timer.as_mut());
            self.effect.composite(&mut pass, &self.view);
        }
        let timestamps = self.resolve_timestamps(&mut encoder);
        self.queue.submit([encoder.finish()]);
        let composited = self.read_if(layers.contains(&Layer::Final), &self.color.texture)?;
        let in_scatter = self.view.output().texture();
        let in_scatter = self.read_if(layers.contains(&Layer::Inscatter), in_scatter)?;
        let reads_depth = |layer| matches!(layer, &Layer::Depth | &Layer::Transmittance);
        let depth = self.read_if(layers.iter().any(reads_depth), self.g_buffer.depth())?;
        let picture = |layer| match layer {
            Layer::Surface => picture(setup.size, &surface),
            Layer::Inscatter => picture(setup.size, &in_scatter),
            Layer::Final => picture(setup.size, &composited),
            Layer::Depth | Layer::Transmittance => depth_layer(layer, setup, &depth),
        };
        Ok(Rendered {
            layers: layers
                .iter()
                .map(|&layer| (layer, picture(layer)))
                .collect(),
            passes: self.passes(timestamps)?,
            bytes: self.bytes(),
        })
    }

    fn draw_light_maps(&mut self, setup: &Setup, encoder: &mut CommandEncoder) {
        for (light, targets) in setup.frame.lights.iter().zip(&self.lights) {
            let (Some(projection), Some(shadow_map)) = (&light.shadow, &targets.shadow_map) else {
                continue;
            };
            let (renderer, emitter) = (&self.renderer, &light.emitter);
            let timer = self.timer.as_mut();
            renderer.shadow_map(encoder, shadow_map, emitter, projection, timer);
            if let Some(glass) = &targets.glass {
                let timer = self.timer.as_mut();
                renderer.glass_map(encoder, glass, shadow_map, emitter, projection, timer);
            }
        }
    }

    fn draw_camera(&mut self, setup: &Setup, needs: Needs, encoder: &mut CommandEncoder) {
        let (renderer, targets, frame) = (&self.renderer, &self.g_buffer, &setup.frame);
        renderer.g_buffer(encoder, targets, &frame.camera, self.timer.as_mut());
        if needs.surface {
            let lights = light_inputs(&self.lights);
            let (color, timer) = (&self.color.view, self.timer.as_mut());
            renderer.shade(encoder, color, targets, frame, &lights, timer);
        }
    }

    fn draw_in_scatter(
        &mut self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
    ) -> Result<(), Failure> {
        let inputs = FrameInputs {
            depth: self.g_buffer.depth_view(),
            lights: &light_inputs(&self.lights),
        };
        let (device, queue, view) = (&self.device, &self.queue, &mut self.view);
        self.effect
            .prepare(device, queue, view, &inputs, &setup.frame)
            .map_err(Failure::input)?;
        self.effect
            .record(encoder, &mut self.view, self.timer.as_mut());
        Ok(())
    }

    fn read_if(&self, wanted: bool, texture: &Texture) -> Result<Vec<f32>, Failure> {
        if !wanted {
            return Ok(Vec::new());
        }
        readback::texture_f32(&self.device, &self.queue, texture).map_err(Failure::device)
    }

    fn resolve_timestamps(&self, encoder: &mut CommandEncoder) -> Option<wgpu::Buffer> {
        let timer = self.timer.as_ref()?;
        let size = timer.resolved_bytes();
        let buffer = |label, usage| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let resolved = buffer("timestamps", usage);
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let mappable = buffer("timestamps to read", usage);
        timer.resolve(encoder, &resolved);
        encoder.copy_buffer_to_buffer(&resolved, 0, &mappable, 0, size);
        Some(mappable)
    }

    /// Each pass's name and milliseconds.
    fn passes(&self, timestamps: Option<wgpu::Buffer>) -> Result<Vec<(String, f64)>, Failure> {
        let (Some(timer), Some(buffer)) = (&self.timer, timestamps) else {
            return Ok(Vec::new());
        };
        let bytes = readback::map(&self.device, &buffer).map_err(Failure::device)?;
        let period = f64::from(self.queue.get_timestamp_period()) * 1e-6;
        let (ticks, _) = bytes.as_chunks::<8>();
        let milliseconds = ticks.chunks_exact(2).map(|pass| {
            let [begin, end] = [pass[0], pass[1]].map(u64::from_le_bytes);
            end.saturating_sub(begin) as f64 * period
        });
        Ok(timer.names().iter().cloned().zip(milliseconds).collect())
    }

    fn bytes(&self) -> Vec<(&'static str, u64)> {
        vec![
            ("effect", self.view.bytes()),
            ("G-buffer", self.g_buffer.bytes()),
            ("colour target", self.color.bytes()),
            (
                "light maps",
                self.lights.iter().map(LightTargets::bytes).sum(),
            ),
        ]
    }
}

/// What belongs to one light.
struct LightTargets {
    shadow_map: Option<ShadowMapTarget>,
    glass: Option<GlassMapTarget>,
    texture: Option<TextureView>,
}

impl LightTargets {
    fn new(
        setup: &Setup,
        index: usize,
        gpu: &Gpu,
        renderer: &SceneRenderer,
        needs: Needs,
    ) -> Result<Self, Failure> {
        let Gpu { device, queue, .. } = gpu;
        let (light, extra) = (&setup.frame.lights[index], &setup.lights[index]);
        let projection = light.shadow.as_ref().filter(|_| needs.light_maps);
        let shadow_map = projection
            .map(|projection| ShadowMapTarget::new(device, projection, extra.map_size))
            .transpose()
            .map_err(Failure::device)?;
        let glass = shadow_map
            .as_ref()
            .filter(|_| renderer.has_tinted_glass())
            .map(|shadow_map| GlassMapTarget::new(device, shadow_map))
            .transpose()
            .map_err(Failure::device)?;
        let texture = extra
            .texture
            .as_ref()
            .map(|texture| upload_light_texture(device, queue, texture))
            .transpose()
            .map_err(Failure::device)?;
        Ok(Self {
            shadow_map,
            glass,
            texture: texture.map(|texture| texture.create_view(&Default::default())),
        })
    }

    fn bytes(&self) -> u64 {
        self.shadow_map.as_ref().map_or(0, ShadowMapTarget::bytes)
            + self.glass.as_ref().map_or(0, GlassMapTarget::bytes)
    }
}

fn light_inputs(lights: &[LightTargets]) -> Vec<LightInputs<'_>> {
    lights
        .iter()
        .map(|light| LightInputs {
            shadow_map: light.shadow_map.as_ref().map(ShadowMapTarget::view),
            glass: light.glass.as_ref().map(GlassMapTarget::view),
            texture: light.texture.as_ref(),
        })
        .collect()
}

/// The engine's picture.
struct ColorTarget {
    texture: Texture,
    view: TextureView,
}

impl ColorTarget {
    fn new(device: &Device, [width, height]: [u32; 2], format: TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("colour target"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        Self { texture, view }
    }

    fn bytes(&self) -> u64 {
        let texel = self.texture.format().block_copy_size(None).unwrap_or(0);
        u64::from(self.texture.width()) * u64::from(self.texture.height()) * u64::from(texel)
    }

    /// The pass that composites on what is there.
    fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut CommandEncoder,
        timer: Option<&mut PassTimer>,
    ) -> wgpu::RenderPass<'encoder> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("composite"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            timestamp_writes: timer.and_then(|timer| timer.render_pass("composite")),
            ..Default::default()
        })
    }
}

/// 32-bit floats where they can be blended, for radiance of any range.
fn target_format(device: &Device) -> TextureFormat {
    if device
        .features()
        .contains(wgpu::Features::FLOAT32_BLENDABLE)
    {
        TextureFormat::Rgba32Float
    } else {
        TextureFormat::Rgba16Float
    }
}

fn picture(size: [u32; 2], channels: &[f32]) -> Picture {
    let (pixels, _) = channels.as_chunks::<4>();
    Picture {
        size,
        pixels: rgb(pixels),
    }
}
