//! A sequence's frames by one technique, with several kinds of reuse in turn.

use tyndall::{Effect, EffectView, FrameInputs, temporal::Reuse};
use tyndall_scene::gpu::readback;

use super::device::{finish, timed_frame};
use crate::{
    failure::Failure,
    render::{
        Gpu, Needs,
        gpu::{Timestamps, World, counts, new_effect, target_format},
    },
    sequence::Sequence,
};

/// A sequence on a device.
pub struct Film<'a> {
    gpu: &'a Gpu,
    sequence: Sequence,
    world: World,
    effect: Effect,
    takes: Vec<Take>,
}

/// The sequence with one kind of reuse.
struct Take {
    reuse: Option<Reuse>,
    view: EffectView,
    timestamps: Timestamps,
}

/// What a frame of a take took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TakeFrame {
    /// Time of the effect's passes, by the device's timestamps; of the wall clock where there are none [ms].
    pub milliseconds: f64,
    /// Share of the pixels that were computed, the mean of the lights.
    pub computed: f64,
}

impl<'a> Film<'a> {
    /// Uploads the scene; one take a kind of reuse.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub(crate) fn new(
        mut sequence: Sequence,
        takes: &[Option<Reuse>],
        gpu: &'a Gpu,
    ) -> Result<Self, Failure> {
        let setup = sequence.at(sequence.range().first)?;
        let format = target_format(&gpu.device);
        let effect = new_effect(&gpu.device, format)?;
        let take = |reuse: &Option<Reuse>| {
            let view = effect.create_view(&gpu.device, setup.size);
            let mut view = view.map_err(Failure::device)?;
            view.set_reuse(*reuse);
            Ok(Take {
                reuse: *reuse,
                view,
                timestamps: Timestamps::new(&gpu.device),
            })
        };
        Ok(Self {
            takes: takes.iter().map(take).collect::<Result<_, Failure>>()?,
            world: World::new(&setup, gpu, Needs::IN_SCATTER, format)?,
            effect,
            sequence,
            gpu,
        })
    }

    /// Renders a frame in every take.
    ///
    /// # Errors
    /// [`Failure::Input`] where the technique can't do the shot, [`Failure::Device`] where the GPU fails.
    pub fn frame(&mut self, number: u32) -> Result<Vec<TakeFrame>, Failure> {
        let (gpu, setup) = (self.gpu, self.sequence.at(number)?);
        let Gpu { device, queue, .. } = gpu;
        self.world.place(&setup, gpu, Needs::IN_SCATTER)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        self.world.draw_light_maps(&setup, &mut encoder, None);
        self.world.draw_g_buffer(&setup, &mut encoder, None);
        finish(gpu, encoder, &Timestamps::none())?;
        let (world, effect) = (&self.world, &self.effect);
        let pixels = f64::from(setup.size[0]) * f64::from(setup.size[1]);
        let frame = |take: &mut Take| {
            let occluders = world.occluders(&setup, take.reuse.as_ref(), gpu)?;
            let inputs = FrameInputs {
                depth: world.g_buffer().depth_view(),
                lights: &world.light_inputs(occluders.as_deref()),
            };
            let view = &mut take.view;
            let time = timed_frame(gpu, &mut take.timestamps, |encoder, timestamps| {
                effect
                    .prepare(
                        device,
                        queue,
                        view,
                        &inputs,
                        &setup.frame,
                        &setup.techniques,
                    )
                    .map_err(Failure::input)?;
                effect.record(encoder, view, timestamps.timer());
                Ok(())
            })?;
            let counts = counts(view, device, queue)?;
            let stale = counts.iter().filter(|(name, _)| name.starts_with("stale"));
            let stale: Vec<f64> = stale.map(|(_, count)| *count as f64 / pixels).collect();
            Ok(TakeFrame {
                milliseconds: time.total(),
                computed: match stale.len() {
                    0 => 1.0,
                    lights => stale.iter().sum::<f64>() / lights as f64,
                },
            })
        };
        self.takes.iter_mut().map(frame).collect()
    }

    /// The output of every take's last frame: in-scattered radiance [W/(m^2 sr)] and mean transmittance, pixel by pixel.
    ///
    /// # Errors
    /// [`Failure::Device`] where the device is lost.
    pub fn outputs(&self) -> Result<Vec<Vec<f32>>, Failure> {
        let Gpu { device, queue, .. } = self.gpu;
        let output = |take: &Take| {
            let output = take.view.output().texture();
            readback::texture_f32(device, queue, output).map_err(Failure::device)
        };
        self.takes.iter().map(output).collect()
    }
}
