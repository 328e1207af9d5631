//! The pipeline on the GPU: an engine in small that hands tyndall its depth buffer and its shadow maps.

mod color;
mod errors;
mod lights;
mod timestamps;
mod world;

use tyndall::{Count, CountValue, Effect, EffectOptions, EffectView, FrameInputs, OutputPrecision};
use tyndall_scene::gpu::readback;
use wgpu::{CommandEncoder, Device, Queue, Texture, TextureFormat};

use super::{Needs, Rendered, backend::Gpu, depth_layer, rgb};
use crate::{failure::Failure, layer::Layer, picture::Picture, progress::Stages, setup::Setup};
use color::ColorTarget;

pub(crate) use errors::DeviceErrors;
pub(crate) use timestamps::Timestamps;
pub(crate) use world::World;

pub(super) fn render(
    setup: &Setup,
    gpu: &Gpu,
    needs: Needs,
    layers: &[Layer],
    stages: &mut Stages,
) -> Result<Rendered, Failure> {
    let pipeline = stages.run("build pipelines and upload", |_| {
        Pipeline::new(setup, gpu, needs)
    });
    let mut pipeline = gpu.errors.else_result(pipeline)?;
    let rendered = stages.run("render", |_| pipeline.render(setup, needs, layers));
    gpu.errors.else_result(rendered)
}

/// Everything that is made once and would hold for any number of frames.
struct Pipeline {
    device: Device,
    queue: Queue,
    world: World,
    effect: Effect,
    view: EffectView,
    color: ColorTarget,
    timestamps: Timestamps,
}

impl Pipeline {
    fn new(setup: &Setup, gpu: &Gpu, needs: Needs) -> Result<Self, Failure> {
        let Gpu { device, queue, .. } = gpu;
        let format = target_format(device);
        let world = World::new(setup, gpu, needs, format)?;
        let effect = new_effect(device, format)?;
        let view = effect.create_view(device, setup.size);
        Ok(Self {
            view: view.map_err(Failure::device)?,
            color: ColorTarget::new(device, setup.size, format),
            timestamps: Timestamps::new(device),
            device: device.clone(),
            queue: queue.clone(),
            world,
            effect,
        })
    }

    fn render(
        &mut self,
        setup: &Setup,
        needs: Needs,
        layers: &[Layer],
    ) -> Result<Rendered, Failure> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.timestamps.begin(&mut encoder);
        self.draw_world(setup, needs, &mut encoder);
        if needs.in_scatter {
            self.draw_in_scatter(setup, &mut encoder)?;
        }
        self.queue.submit([encoder.finish()]);
        // The composite draws on the surface, so that is read first.
        let surface = self.read_if(layers.contains(&Layer::Surface), &self.color.texture)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        if layers.contains(&Layer::Final) {
            let mut pass = self.color.begin_pass(&mut encoder, self.timestamps.timer());
            self.effect.composite(&mut pass, &self.view);
        }
        self.timestamps.resolve(&mut encoder);
        self.queue.submit([encoder.finish()]);
        let composited = self.read_if(layers.contains(&Layer::Final), &self.color.texture)?;
        let in_scatter = self.view.output().texture();
        let in_scatter = self.read_if(layers.contains(&Layer::Inscatter), in_scatter)?;
        let reads_depth = |layer| matches!(layer, &Layer::Depth | &Layer::Transmittance);
        let depth = self.world.g_buffer().depth();
        let depth = self.read_if(layers.iter().any(reads_depth), depth)?;
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
            passes: self.timestamps.read(&self.device, &self.queue)?,
            bytes: self.bytes(),
            counts: counts(&self.view, &self.device, &self.queue)?,
        })
    }

    fn draw_world(&mut self, setup: &Setup, needs: Needs, encoder: &mut CommandEncoder) {
        let (world, timestamps) = (&self.world, &mut self.timestamps);
        world.draw_light_maps(setup, encoder, timestamps.timer());
        world.draw_g_buffer(setup, encoder, timestamps.timer());
        if needs.surface {
            world.draw_surfaces(setup, encoder, &self.color.view, timestamps.timer());
        }
    }

    fn draw_in_scatter(
        &mut self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
    ) -> Result<(), Failure> {
        let inputs = FrameInputs {
            depth: self.world.g_buffer().depth_view(),
            lights: &self.world.light_inputs(),
        };
        let (device, queue, view) = (&self.device, &self.queue, &mut self.view);
        self.effect
            .prepare(device, queue, view, &inputs, &setup.frame)
            .map_err(Failure::input)?;
        self.effect
            .record(encoder, &mut self.view, self.timestamps.timer());
        Ok(())
    }

    fn read_if(&self, wanted: bool, texture: &Texture) -> Result<Vec<f32>, Failure> {
        if !wanted {
            return Ok(Vec::new());
        }
        readback::texture_f32(&self.device, &self.queue, texture).map_err(Failure::device)
    }

    fn bytes(&self) -> Vec<(&'static str, u64)> {
        let [g_buffer, light_maps] = self.world.bytes();
        let effect = ("effect", self.view.bytes());
        let color = ("colour target", self.color.bytes());
        vec![effect, g_buffer, color, light_maps]
    }
}

/// What the technique counts, of the frame that was recorded last. Waits for the device.
///
/// # Errors
/// [`Failure::Device`] where the device is lost.
pub(crate) fn counts(
    view: &EffectView,
    device: &Device,
    queue: &Queue,
) -> Result<Vec<(String, u64)>, Failure> {
    let value = |value: &CountValue| match value {
        CountValue::Known(known) => Ok(*known),
        CountValue::Written { buffer, offset } => {
            readback::buffer_u32(device, queue, buffer, *offset).map(u64::from)
        }
    };
    let count = |count: &Count| Ok((count.name.clone(), value(&count.value)?));
    let counts: Result<_, readback::ReadbackError> = view.counts().iter().map(count).collect();
    counts.map_err(Failure::device)
}

/// The effect, with an output that is exact enough to be measured.
pub(crate) fn new_effect(device: &Device, target_format: TextureFormat) -> Result<Effect, Failure> {
    let options = EffectOptions {
        target_format,
        output: OutputPrecision::Full,
    };
    Effect::new(device, &options).map_err(Failure::device)
}

/// 32-bit floats where they can be blended, for radiance of any range.
pub(crate) fn target_format(device: &Device) -> TextureFormat {
    if device
        .features()
        .contains(wgpu::Features::FLOAT32_BLENDABLE)
    {
        TextureFormat::Rgba32Float
    } else {
        TextureFormat::Rgba16Float
    }
}

/// The colours of an `Rgba32Float` texture.
pub(crate) fn picture(size: [u32; 2], channels: &[f32]) -> Picture {
    let (pixels, _) = channels.as_chunks::<4>();
    Picture {
        size,
        pixels: rgb(pixels),
    }
}
