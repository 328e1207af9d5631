//! Techniques that are timed in turn on one drawn frame.

use std::time::Instant;

use tyndall::techniques::Technique;

use super::{
    drawn::{DrawnFrame, OnDevice},
    place::Place,
    timing::{Budget, Timing, Timings, interleave},
};
use crate::{
    failure::Failure,
    render::gpu::{FrameTime, TimedView, Timestamps, ViewOptions, timed_frame},
};

impl DrawnFrame<'_> {
    /// Times techniques in turn: one frame of each, and one of the limit, a round.
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn time(&self, techniques: &[Technique], budget: &Budget) -> Result<Timings, Failure> {
        let contenders = techniques
            .iter()
            .map(|technique| self.contender(technique, false))
            .collect::<Result<Vec<_>, _>>()?;
        let (timings, limit) = self.time_contenders(contenders, budget)?;
        Ok(Timings {
            techniques: techniques.iter().cloned().zip(timings).collect(),
            limit,
        })
    }

    /// Times techniques in turn, each twice: as if the shadow maps changed every frame, and saying that they don't.
    /// Also the time of the limit, where there is one.
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn time_with_stable_maps(
        &self,
        techniques: &[Technique],
        budget: &Budget,
    ) -> Result<(Vec<[Timing; 2]>, Option<Timing>), Failure> {
        let twice = techniques.iter().flat_map(|t| [(t, false), (t, true)]);
        let contenders = twice
            .map(|(technique, is_stable)| self.contender(technique, is_stable))
            .collect::<Result<Vec<_>, _>>()?;
        let (timings, limit) = self.time_contenders(contenders, budget)?;
        let (pairs, _) = timings.as_chunks::<2>();
        Ok((pairs.to_vec(), limit))
    }

    /// Times of the contenders, and of the limit.
    fn time_contenders<'s>(
        &'s self,
        mut contenders: Vec<Contender<'s>>,
        budget: &Budget,
    ) -> Result<(Vec<Timing>, Option<Timing>), Failure> {
        if let Some(device) = self.device().filter(|device| !device.limit.is_empty()) {
            let timestamps = Timestamps::new(&device.shot.gpu.device);
            contenders.push(Contender::Limit(device, timestamps));
        }
        let mut runs: Vec<_> = contenders.iter_mut().map(|c| || c.frame()).collect();
        let frames = interleave(&mut runs, budget)?;
        let timings = contenders.iter().zip(&frames);
        let mut timings: Vec<Timing> = timings
            .map(|(c, frames)| Timing::new(c.place(), c.bytes(), frames))
            .collect();
        let has_limit = matches!(contenders.last(), Some(Contender::Limit(..)));
        let limit = timings.pop_if(|_| has_limit);
        Ok((timings, limit))
    }

    fn contender<'s>(
        &'s self,
        technique: &'s Technique,
        has_stable_maps: bool,
    ) -> Result<Contender<'s>, Failure> {
        Ok(match self.device_for(technique)? {
            Some(device) => {
                let options = ViewOptions {
                    reuse: None,
                    tracks_maps: has_stable_maps,
                };
                let view = TimedView::new(
                    &device.shot,
                    &self.shot_frame,
                    &technique.clone().into(),
                    options,
                )?;
                Contender::Gpu(self, device, Box::new(view))
            }
            None => {
                // Reading back happens but once: it is no part of a frame.
                self.buffers()?;
                Contender::Cpu(self, technique)
            }
        })
    }
}

/// A technique that gets frames in turn with others, or the limit.
enum Contender<'a> {
    Gpu(&'a DrawnFrame<'a>, &'a OnDevice<'a>, Box<TimedView>),
    Cpu(&'a DrawnFrame<'a>, &'a Technique),
    Limit(&'a OnDevice<'a>, Timestamps),
}

impl Contender<'_> {
    fn frame(&mut self) -> Result<FrameTime, Failure> {
        match self {
            Self::Gpu(drawn, device, view) => view.frame(&device.shot, &drawn.shot_frame),
            Self::Limit(device, timestamps) => {
                timed_frame(device.shot.gpu, timestamps, |encoder, timestamps| {
                    device.limit.record(encoder, timestamps.timer());
                    Ok(())
                })
            }
            Self::Cpu(drawn, technique) => {
                let start = Instant::now();
                drawn.in_scatter_on_cpu(technique)?;
                Ok(FrameTime {
                    wall: start.elapsed().as_secs_f64() * 1e3,
                    passes: Vec::new(),
                })
            }
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Gpu(..) | Self::Limit(..) => Place::Gpu,
            Self::Cpu(..) => Place::Cpu,
        }
    }

    /// Known once a frame was rendered.
    fn bytes(&self) -> Option<u64> {
        match self {
            Self::Gpu(_, _, view) => Some(view.view.bytes()),
            Self::Limit(..) | Self::Cpu(..) => None,
        }
    }
}
