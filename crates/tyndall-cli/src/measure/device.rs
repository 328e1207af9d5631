//! The stage's GPU side.

use std::{borrow::Cow, time::Instant};

use tyndall::{
    Effect, EffectView, FrameInputs, Occluder,
    frame::{Camera, Frame},
    techniques::{Technique, TechniqueChoice},
};
use tyndall_scene::gpu::readback;
use wgpu::{CommandEncoder, PollType};

use super::{limit::Limit, timing::FrameTime};
use crate::{
    failure::Failure,
    picture::Picture,
    render::{
        Buffers, Gpu, Needs,
        gpu::{Timestamps, World, counts, new_effect, picture, target_format},
    },
    setup::Setup,
};

/// A shot on a device, its depth buffer and shadow maps drawn.
pub(super) struct DeviceStage<'a> {
    setup: Cow<'a, Setup>,
    gpu: &'a Gpu,
    world: World,
    effect: Effect,
    limit: Limit,
    drawn: Vec<(String, f64)>,
}

/// A technique with the textures it works on.
pub(super) struct DeviceTechnique<'a> {
    stage: &'a DeviceStage<'a>,
    frame: Frame,
    techniques: TechniqueChoice,
    occluders: Option<Vec<Occluder<'a>>>,
    view: EffectView,
    /// What the technique is told of the shadow maps, which never change here.
    shadow_revision: Option<u64>,
    timestamps: Timestamps,
}

impl<'a> DeviceStage<'a> {
    pub(super) fn new(setup: &'a Setup, gpu: &'a Gpu) -> Result<Self, Failure> {
        gpu.errors.else_result(Self::draw(setup, gpu))
    }

    fn draw(setup: &'a Setup, gpu: &'a Gpu) -> Result<Self, Failure> {
        let format = target_format(&gpu.device);
        let world = World::new(setup, gpu, Needs::IN_SCATTER, format)?;
        let mut timestamps = Timestamps::new(&gpu.device);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        timestamps.begin(&mut encoder);
        world.draw_light_maps(setup, &mut encoder, timestamps.timer());
        world.draw_g_buffer(setup, &mut encoder, timestamps.timer());
        finish(gpu, encoder, &timestamps)?;
        Ok(Self {
            setup: Cow::Borrowed(setup),
            gpu,
            effect: new_effect(&gpu.device, format)?,
            limit: Limit::new(&gpu.device, &world),
            drawn: timestamps.read(&gpu.device, &gpu.queue)?,
            world,
        })
    }

    /// Each pass that drew the shadow maps and the depth buffer, and its time [ms].
    pub(super) fn drawn(&self) -> &[(String, f64)] {
        &self.drawn
    }

    pub(super) fn read(&self) -> Result<Buffers, Failure> {
        self.gpu.errors.else_result(self.world.read(self.gpu))
    }

    /// Draws the depth buffer of another camera.
    pub(super) fn look_from(&mut self, camera: Camera) -> Result<(), Failure> {
        self.setup.to_mut().frame.camera = camera;
        let mut timestamps = Timestamps::new(&self.gpu.device);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.world
            .draw_g_buffer(&self.setup, &mut encoder, timestamps.timer());
        let done = finish(self.gpu, encoder, &timestamps);
        self.gpu.errors.else_result(done)
    }

    pub(super) fn technique(
        &'a self,
        technique: &Technique,
        has_stable_maps: bool,
    ) -> Result<DeviceTechnique<'a>, Failure> {
        let view = self.effect.create_view(&self.gpu.device, self.setup.size);
        let mut setup = Setup::clone(&self.setup);
        setup.techniques = technique.clone().into();
        Ok(DeviceTechnique {
            stage: self,
            occluders: self.world.occluders(&setup, None, self.gpu)?,
            frame: setup.frame,
            techniques: setup.techniques,
            view: view.map_err(Failure::device)?,
            shadow_revision: has_stable_maps.then_some(0),
            timestamps: Timestamps::new(&self.gpu.device),
        })
    }

    pub(super) fn has_limit(&self) -> bool {
        !self.limit.is_empty()
    }

    /// One frame of the limit.
    pub(super) fn limit_frame(&self, timestamps: &mut Timestamps) -> Result<FrameTime, Failure> {
        timed_frame(self.gpu, timestamps, |encoder, timestamps| {
            self.limit.record(encoder, timestamps.timer());
            Ok(())
        })
    }

    pub(super) fn timestamps(&self) -> Timestamps {
        Timestamps::new(&self.gpu.device)
    }
}

impl DeviceTechnique<'_> {
    pub(super) fn frame(&mut self) -> Result<FrameTime, Failure> {
        let Self {
            stage,
            frame,
            techniques,
            occluders,
            view,
            shadow_revision,
            timestamps,
        } = self;
        timed_frame(stage.gpu, timestamps, |encoder, timestamps| {
            let mut lights = stage.world.light_inputs(occluders.as_deref());
            for light in &mut lights {
                light.shadow_revision = *shadow_revision;
            }
            let inputs = FrameInputs {
                depth: stage.world.g_buffer().depth_view(),
                lights: &lights,
            };
            let Gpu { device, queue, .. } = stage.gpu;
            let prepared = stage
                .effect
                .prepare(device, queue, view, &inputs, frame, techniques);
            prepared.map_err(Failure::input)?;
            stage.effect.record(encoder, view, timestamps.timer());
            Ok(())
        })
    }

    /// The frame rendered last.
    pub(super) fn in_scatter(&self) -> Result<Picture, Failure> {
        let Gpu { device, queue, .. } = self.stage.gpu;
        let channels = readback::texture_f32(device, queue, self.view.output().texture());
        let channels = channels.map_err(Failure::device)?;
        Ok(picture(self.view.size(), &channels))
    }

    /// What the frame rendered last counts.
    pub(super) fn counts(&self) -> Result<Vec<(String, u64)>, Failure> {
        counts(&self.view, &self.stage.gpu.device, &self.stage.gpu.queue)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.view.bytes()
    }
}

/// Times a frame from before it is prepared and recorded until the device is done.
pub(super) fn timed_frame(
    gpu: &Gpu,
    timestamps: &mut Timestamps,
    record: impl FnOnce(&mut CommandEncoder, &mut Timestamps) -> Result<(), Failure>,
) -> Result<FrameTime, Failure> {
    let start = Instant::now();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    timestamps.begin(&mut encoder);
    record(&mut encoder, timestamps)?;
    let done = finish(gpu, encoder, timestamps);
    gpu.errors.else_result(done)?;
    let wall = start.elapsed().as_secs_f64() * 1e3;
    let passes = timestamps.read(&gpu.device, &gpu.queue)?;
    Ok(FrameTime { wall, passes })
}

/// Submits the passes and waits for them and their timestamps.
pub(super) fn finish(
    gpu: &Gpu,
    mut encoder: CommandEncoder,
    timestamps: &Timestamps,
) -> Result<(), Failure> {
    timestamps.resolve(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    let waited = gpu.device.poll(PollType::wait_indefinitely());
    waited.map(|_| ()).map_err(Failure::device)
}
