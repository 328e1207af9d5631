//! Frames that are timed: submitted by themselves, and waited for.

use std::time::Instant;

use tyndall::techniques::TechniqueChoice;
use wgpu::{CommandEncoder, PollType};

use super::{
    device_shot::{DeviceShot, DeviceView, ViewOptions},
    timestamps::Timestamps,
};
use crate::{backend::Gpu, failure::Failure, load::ShotFrame};

/// Times of one frame \[ms].
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FrameTime {
    /// Wall clock.
    pub(crate) wall: f64,
    /// Each pass's name and time, in order; empty without timestamps.
    pub(crate) passes: Vec<(String, f64)>,
}

impl FrameTime {
    /// Time of all passes, or of the wall clock where none were timed.
    pub(crate) fn total(&self) -> f64 {
        if self.passes.is_empty() {
            self.wall
        } else {
            self.gpu()
        }
    }

    /// Time of all passes.
    pub(crate) fn gpu(&self) -> f64 {
        self.passes
            .iter()
            .map(|(_, milliseconds)| milliseconds)
            .sum()
    }

    /// Time of all passes of this name.
    pub(crate) fn pass(&self, name: &str) -> f64 {
        let of_name = self.passes.iter().filter(|pass| pass.0 == name);
        of_name.map(|(_, milliseconds)| milliseconds).sum()
    }
}

/// Techniques on a device whose frames are timed.
pub(crate) struct TimedView {
    pub(crate) view: DeviceView,
    timestamps: Timestamps,
}

impl TimedView {
    /// Makes the techniques' textures.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub(crate) fn new(
        shot: &DeviceShot<'_>,
        shot_frame: &ShotFrame,
        techniques: &TechniqueChoice,
        options: ViewOptions,
    ) -> Result<Self, Failure> {
        Ok(Self {
            view: shot.view(shot_frame, techniques, options)?,
            timestamps: Timestamps::new(&shot.gpu.device),
        })
    }

    /// Renders a frame that has been drawn, and times the techniques' passes.
    ///
    /// # Errors
    /// [`Failure::Input`] where the technique can't do the frame, [`Failure::Device`] where the GPU fails.
    pub(crate) fn frame(
        &mut self,
        shot: &DeviceShot<'_>,
        shot_frame: &ShotFrame,
    ) -> Result<FrameTime, Failure> {
        let occluders = shot.occluders(&self.view, shot_frame)?;
        let (view, occluders) = (&mut self.view, occluders.as_deref());
        timed_frame(shot.gpu, &mut self.timestamps, |encoder, timestamps| {
            shot.record(view, shot_frame, occluders, encoder, timestamps.timer())
        })
    }
}

impl DeviceShot<'_> {
    /// Moves the scene to a frame, draws its light maps and G-buffer, and waits. Returns each pass's name and time \[ms], where
    /// there are timestamps.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub(crate) fn draw_and_wait(
        &mut self,
        shot_frame: &ShotFrame,
        timestamps: &mut Timestamps,
    ) -> Result<Vec<(String, f64)>, Failure> {
        self.place(shot_frame)?;
        let time = timed_frame(self.gpu, timestamps, |encoder, timestamps| {
            self.draw(shot_frame, encoder, timestamps.timer());
            Ok(())
        })?;
        Ok(time.passes)
    }
}

/// Times a frame from before it is prepared and recorded until the device is done.
pub(crate) fn timed_frame(
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
fn finish(gpu: &Gpu, mut encoder: CommandEncoder, timestamps: &Timestamps) -> Result<(), Failure> {
    timestamps.resolve(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    let waited = gpu.device.poll(PollType::wait_indefinitely());
    waited.map(|_| ()).map_err(Failure::device)
}
