//! The pipeline on the GPU: an engine in small that hands tyndall its depth buffer and its shadow maps.

mod color;
mod errors;
mod lights;
mod timestamps;
mod world;

use tyndall::{
    Count, CountValue, Effect, EffectOptions, EffectView, FrameInputs, OutputPrecision,
    temporal::Reuse,
};
use tyndall_scene::gpu::readback;
use wgpu::{CommandEncoder, Device, Queue, Texture, TextureFormat};

use super::{Needs, Rendered, backend::Gpu, depth_layer, rgb};
use crate::{failure::Failure, layer::Layer, picture::Picture, progress::Stages, setup::Setup};
use color::ColorTarget;

pub(crate) use errors::DeviceErrors;
pub(crate) use timestamps::Timestamps;
pub(crate) use world::World;

/// Everything that is made once and holds for any number of frames.
pub(super) struct Pipeline<'a> {
    gpu: &'a Gpu,
    needs: Needs,
    world: World,
    effect: Effect,
    reuse: Option<Reuse>,
    view: EffectView,
    color: ColorTarget,
    timestamps: Timestamps,
}

impl<'a> Pipeline<'a> {
    /// Uploads the setup's scene.
    pub(super) fn new(
        setup: &Setup,
        reuse: Option<Reuse>,
        gpu: &'a Gpu,
        needs: Needs,
        stages: &mut Stages,
    ) -> Result<Self, Failure> {
        let pipeline = stages.run("build pipelines and upload", |_| {
            let format = target_format(&gpu.device);
            let world = World::new(setup, gpu, needs, format)?;
            let effect = new_effect(&gpu.device, format)?;
            let view = effect.create_view(&gpu.device, setup.size);
            let mut view = view.map_err(Failure::device)?;
            view.set_reuse(reuse);
            view.set_surface_shadows(needs.surface_shadows.then(|| world.surface_shadows()));
            Ok(Self {
                view,
                reuse,
                color: ColorTarget::new(&gpu.device, setup.size, format),
                timestamps: Timestamps::new(&gpu.device),
                gpu,
                needs,
                world,
                effect,
            })
        });
        gpu.errors.else_result(pipeline)
    }

    /// Renders a frame whose nodes may have moved since the last one.
    pub(super) fn render(
        &mut self,
        setup: &Setup,
        layers: &[Layer],
        stages: &mut Stages,
    ) -> Result<Rendered, Failure> {
        let rendered = stages.run("render", |_| self.draw(setup, layers));
        self.gpu.errors.else_result(rendered)
    }

    fn draw(&mut self, setup: &Setup, layers: &[Layer]) -> Result<Rendered, Failure> {
        self.world.place(setup, self.gpu, self.needs)?;
        let Gpu { device, queue, .. } = self.gpu;
        let mut encoder = device.create_command_encoder(&Default::default());
        self.timestamps.begin(&mut encoder);
        self.draw_world(setup, &mut encoder);
        // Whatever blocks light on surfaces comes out of the same passes.
        if self.needs.in_scatter {
            self.draw_in_scatter(setup, &mut encoder)?;
        }
        if self.needs.surface {
            self.draw_surfaces(setup, &mut encoder);
        }
        queue.submit([encoder.finish()]);
        // The composite draws on the surface, so that is read first.
        let surface = self.read_if(layers.contains(&Layer::Surface), &self.color.texture)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        if layers.contains(&Layer::Final) {
            let mut pass = self.color.begin_pass(&mut encoder, self.timestamps.timer());
            self.effect.composite(&mut pass, &self.view);
        }
        self.timestamps.resolve(&mut encoder);
        queue.submit([encoder.finish()]);
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
            passes: self.timestamps.read(device, queue)?,
            bytes: self.bytes(),
            counts: counts(&self.view, device, queue)?,
        })
    }

    fn draw_world(&mut self, setup: &Setup, encoder: &mut CommandEncoder) {
        let (world, timestamps) = (&self.world, &mut self.timestamps);
        world.draw_light_maps(setup, encoder, timestamps.timer());
        world.draw_g_buffer(setup, encoder, timestamps.timer());
    }

    fn draw_surfaces(&mut self, setup: &Setup, encoder: &mut CommandEncoder) {
        let lights = 0..setup.frame.lights.len();
        let visibility: Vec<_> = lights
            .map(|light| self.view.surface_light_visibility(light))
            .collect();
        let (target, timer) = (&self.color.view, self.timestamps.timer());
        self.world
            .draw_surfaces(setup, encoder, target, &visibility, timer);
    }

    fn draw_in_scatter(
        &mut self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
    ) -> Result<(), Failure> {
        let world = &self.world;
        let occluders = world.occluders(setup, self.reuse.as_ref(), self.gpu)?;
        let inputs = FrameInputs {
            depth: world.g_buffer().depth_view(),
            lights: &world.light_inputs(occluders.as_deref()),
        };
        let Gpu { device, queue, .. } = self.gpu;
        let view = &mut self.view;
        self.effect
            .prepare(
                device,
                queue,
                view,
                &inputs,
                &setup.frame,
                &setup.techniques,
            )
            .map_err(Failure::input)?;
        self.effect
            .record(encoder, &mut self.view, self.timestamps.timer());
        Ok(())
    }

    fn read_if(&self, wanted: bool, texture: &Texture) -> Result<Vec<f32>, Failure> {
        if !wanted {
            return Ok(Vec::new());
        }
        readback::texture_f32(&self.gpu.device, &self.gpu.queue, texture).map_err(Failure::device)
    }

    fn bytes(&self) -> Vec<(&'static str, u64)> {
        let effect = ("effect", self.view.bytes());
        let color = ("colour target", self.color.bytes());
        let world = self.world.bytes();
        [effect, color].into_iter().chain(world).collect()
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
