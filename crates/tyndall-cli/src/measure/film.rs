//! A shot's frames by its techniques, with several kinds of reuse in turn.

use tyndall::temporal::Reuse;

use crate::{
    backend::Gpu,
    failure::Failure,
    load::{LoadedShot, ShotFrame},
    render::{
        Needs,
        gpu::{DeviceShot, TimedView, Timestamps, ViewOptions},
    },
};

/// A shot on a device whose frames are rendered with several kinds of reuse: its takes.
pub struct Film<'a> {
    loaded: LoadedShot,
    shot: DeviceShot<'a>,
    takes: Vec<TimedView>,
}

/// Cost of a frame of a take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TakeFrame {
    /// Time of the effect's passes, by the device's timestamps; of the wall clock where there are none \[ms].
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
        mut loaded: LoadedShot,
        takes: &[Option<Reuse>],
        gpu: &'a Gpu,
    ) -> Result<Self, Failure> {
        let first = loaded.frame(loaded.range().first)?;
        let shot = DeviceShot::new(&first, gpu, Needs::IN_SCATTER)?;
        let take = |reuse: &Option<Reuse>| {
            let options = ViewOptions {
                reuse: *reuse,
                tracks_maps: true,
            };
            TimedView::new(&shot, &first, &first.techniques, options)
        };
        Ok(Self {
            takes: takes.iter().map(take).collect::<Result<_, _>>()?,
            loaded,
            shot,
        })
    }

    /// Renders a frame in every take.
    ///
    /// # Errors
    /// [`Failure::Input`] where the technique can't do the shot, [`Failure::Device`] where the GPU fails.
    pub fn frame(&mut self, number: u32) -> Result<Vec<TakeFrame>, Failure> {
        let shot_frame = self.loaded.frame(number)?;
        self.shot
            .draw_and_wait(&shot_frame, &mut Timestamps::none())?;
        let shot = &self.shot;
        let frame = |take: &mut TimedView| {
            let time = take.frame(shot, &shot_frame)?;
            Ok(TakeFrame {
                milliseconds: time.total(),
                computed: computed(&take.view.counts(shot.gpu)?, &shot_frame),
            })
        };
        self.takes.iter_mut().map(frame).collect()
    }

    /// The output of every take's last frame: in-scattered radiance [W/(m^2 sr)] and mean transmittance, pixel by pixel.
    ///
    /// # Errors
    /// [`Failure::Device`] where the device is lost.
    pub fn outputs(&self) -> Result<Vec<Vec<f32>>, Failure> {
        let takes = self.takes.iter();
        takes.map(|take| take.view.output(self.shot.gpu)).collect()
    }
}

/// Share of the pixels that were stale, the mean of the lights; all where nothing counts them.
fn computed(counts: &[(String, u64)], shot_frame: &ShotFrame) -> f64 {
    let pixels = f64::from(shot_frame.size[0]) * f64::from(shot_frame.size[1]);
    let stale = counts.iter().filter(|(name, _)| name.starts_with("stale"));
    let stale: Vec<f64> = stale.map(|(_, count)| *count as f64 / pixels).collect();
    match stale.len() {
        0 => 1.0,
        lights => stale.iter().sum::<f64>() / lights as f64,
    }
}
