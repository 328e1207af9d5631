//! Rendering on the GPU: an engine in small that hands the library its depth buffer and its shadow maps.

use tyndall::{techniques::Backends, temporal::Reuse};
use tyndall_scene::gpu::readback;
use wgpu::Texture;

use super::{
    color::ColorTarget,
    device_shot::{DeviceShot, DeviceView, ViewOptions},
    effect::{picture, target_format},
    timestamps::Timestamps,
};
use crate::{
    backend::Gpu,
    failure::Failure,
    layer::Layer,
    load::ShotFrame,
    progress::Progress,
    render::{
        layers::{Rendered, depth_layer},
        needs::Needs,
    },
};

/// A renderer of layers on a device. All of it is made once and serves any number of frames.
pub(crate) struct GpuRenderer<'a> {
    gpu: &'a Gpu,
    needs: Needs,
    shot: DeviceShot<'a>,
    view: DeviceView,
    color: ColorTarget,
    timestamps: Timestamps,
}

impl<'a> GpuRenderer<'a> {
    /// Uploads the scene.
    pub(crate) fn new(
        shot_frame: &ShotFrame,
        reuse: Option<Reuse>,
        gpu: &'a Gpu,
        needs: Needs,
        progress: &mut Progress,
    ) -> Result<Self, Failure> {
        let options = ViewOptions {
            reuse,
            tracks_maps: true,
        };
        let renderer = progress.run("build pipelines and upload", |_| {
            let shot = DeviceShot::new(shot_frame, gpu, needs)?;
            let format = target_format(&gpu.device);
            Ok(Self {
                view: shot.view(shot_frame, &shot_frame.techniques, options)?,
                color: ColorTarget::new(&gpu.device, shot_frame.size, format),
                timestamps: Timestamps::new(&gpu.device),
                gpu,
                needs,
                shot,
            })
        });
        gpu.errors.else_result(renderer)
    }

    /// Renders a frame whose nodes may have moved since the last one.
    pub(crate) fn render(
        &mut self,
        shot_frame: &ShotFrame,
        layers: &[Layer],
        progress: &mut Progress,
    ) -> Result<Rendered, Failure> {
        let rendered = progress.run("render", |_| self.draw(shot_frame, layers));
        self.gpu.errors.else_result(rendered)
    }

    fn draw(&mut self, shot_frame: &ShotFrame, layers: &[Layer]) -> Result<Rendered, Failure> {
        self.draw_below(shot_frame)?;
        // The composite draws on the surface, so that is read first.
        let surface = self.read_if(layers.contains(&Layer::Surface), &self.color.texture)?;
        self.draw_composite(layers.contains(&Layer::Final));
        let composited = self.read_if(layers.contains(&Layer::Final), &self.color.texture)?;
        let in_scatter = match layers.contains(&Layer::Inscatter) {
            true => self.view.output(self.gpu)?,
            false => Vec::new(),
        };
        let reads_depth = |layer| matches!(layer, &Layer::Depth | &Layer::Transmittance);
        let depth = self.shot.world.g_buffer().depth();
        let depth = self.read_if(layers.iter().any(reads_depth), depth)?;
        let picture = |layer| match layer {
            Layer::Surface => picture(shot_frame.size, &surface),
            Layer::Inscatter => picture(shot_frame.size, &in_scatter),
            Layer::Final => picture(shot_frame.size, &composited),
            Layer::Depth | Layer::Transmittance => depth_layer(layer, shot_frame, &depth),
        };
        Ok(Rendered {
            layers: layers
                .iter()
                .map(|&layer| (layer, picture(layer)))
                .collect(),
            techniques: shot_frame.techniques_on(Backends::Gpu),
            passes: self.timestamps.read(&self.gpu.device, &self.gpu.queue)?,
            bytes: self.bytes(),
            counts: self.view.counts(self.gpu)?,
        })
    }

    /// Submits all passes of a frame that come before the composite.
    fn draw_below(&mut self, shot_frame: &ShotFrame) -> Result<(), Failure> {
        self.shot.place(shot_frame)?;
        let Self {
            gpu,
            needs,
            shot,
            view,
            color,
            timestamps,
        } = self;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        timestamps.begin(&mut encoder);
        shot.draw(shot_frame, &mut encoder, timestamps.timer());
        // The passes of in-scattered light find the shadows on surfaces, too.
        if needs.in_scatter {
            let occluders = shot.occluders(view, shot_frame)?;
            let (occluders, timer) = (occluders.as_deref(), timestamps.timer());
            shot.record(view, shot_frame, occluders, &mut encoder, timer)?;
        }
        if needs.surface {
            let timer = timestamps.timer();
            shot.draw_surfaces(view, shot_frame, &mut encoder, &color.view, timer);
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Submits the composite, where it is asked for, and ends the frame's timestamps.
    fn draw_composite(&mut self, wanted: bool) {
        let device = &self.gpu.device;
        let mut encoder = device.create_command_encoder(&Default::default());
        if wanted {
            let mut pass = self.color.begin_pass(&mut encoder, self.timestamps.timer());
            self.shot.composite(&mut pass, &self.view);
        }
        self.timestamps.resolve(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
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
        let world = self.shot.world.bytes();
        [effect, color].into_iter().chain(world).collect()
    }
}
