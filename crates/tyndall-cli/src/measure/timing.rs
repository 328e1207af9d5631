//! Times of a frame: of many frames, those of different techniques in turn, the median and quartiles.

use std::time::{Duration, Instant};

use tyndall::techniques::Technique;

use super::place::Place;
use crate::render::gpu::FrameTime;

/// Numbers of frames that are timed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Timed frames of each technique (>= 1).
    pub frames: usize,
    /// Frames of each before the clock starts.
    pub warm_up: usize,
    /// Time that a technique's frames may take together. Past it, it gets no more frames than [`Budget::FEWEST`];
    /// past three times that, a single one must do.
    pub time: Duration,
}

impl Budget {
    /// Timed frames that every technique gets (or [`Budget::frames`], where that is less), however slow it is.
    pub const FEWEST: usize = 3;
}

impl Default for Budget {
    fn default() -> Self {
        Self {
            frames: 10,
            warm_up: 1,
            time: Duration::from_secs(10),
        }
    }
}

/// Median and quartiles of the frames \[ms].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// A quarter of the frames took at most this.
    pub lower: f64,
    /// Half of the frames took at most this.
    pub median: f64,
    /// Three quarters of the frames took at most this.
    pub upper: f64,
}

impl Spread {
    /// Takes one value a frame, in any order; linear between ranks; zero without values.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let quantile = |fraction: f64| {
            let rank = fraction * sorted.len().saturating_sub(1) as f64;
            let value = |rank: f64| sorted.get(rank as usize).copied().unwrap_or(0.0);
            let (below, above) = (value(rank.floor()), value(rank.ceil()));
            below + (above - below) * rank.fract()
        };
        Self {
            lower: quantile(0.25),
            median: quantile(0.5),
            upper: quantile(0.75),
        }
    }
}

/// Times of the frames of one technique, or of the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The place it ran in.
    pub place: Place,
    /// Number of frames that were timed.
    pub frames: usize,
    /// Wall-clock time of a frame, from its preparation until the device is done \[ms].
    pub wall: Spread,
    /// Time of all passes of a frame together, by the device's timestamps \[ms]; `None` where there are none.
    pub gpu: Option<Spread>,
    /// Each pass's name and time \[ms], in order, passes of one name added up; empty where there are no timestamps.
    pub passes: Vec<(String, Spread)>,
    /// Textures and buffers of the technique itself, its output among them \[bytes]; `None` on the CPU.
    pub bytes: Option<u64>,
}

impl Timing {
    /// The time that techniques are compared by: that of the passes, or of the wall clock where there are none \[ms].
    pub fn total(&self) -> Spread {
        self.gpu.unwrap_or(self.wall)
    }

    pub(super) fn new(place: Place, bytes: Option<u64>, frames: &[FrameTime]) -> Self {
        let spread = |value: &dyn Fn(&FrameTime) -> f64| {
            Spread::of(&frames.iter().map(value).collect::<Vec<_>>())
        };
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in frames.iter().flat_map(|frame| &frame.passes) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let pass = |name: &str| spread(&|frame| frame.pass(name));
        Self {
            place,
            frames: frames.len(),
            wall: spread(&|frame| frame.wall),
            gpu: (!names.is_empty()).then(|| spread(&FrameTime::gpu)),
            passes: names
                .iter()
                .map(|name| ((*name).to_owned(), pass(name)))
                .collect(),
            bytes,
        }
    }
}

/// Times of one run, frame by frame in turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Timings {
    /// One a technique, in the order they were given.
    pub techniques: Vec<(Technique, Timing)>,
    /// A pass that reads depth buffer and shadow map once and writes the output once; `None` on the CPU.
    pub limit: Option<Timing>,
}

impl Timings {
    /// A technique's time as a multiple of the limit's; `None` where it didn't run on the GPU.
    pub fn over_limit(&self, timing: &Timing) -> Option<f64> {
        let limit = self.limit.as_ref()?.total().median;
        (timing.place == Place::Gpu).then(|| timing.total().median / limit)
    }
}

/// Runs frames in turn, A B A B, so that a machine that gets slower gets slower for all.
///
/// # Errors
/// The first that a frame ends with.
pub(super) fn interleave<E>(
    contenders: &mut [impl FnMut() -> Result<FrameTime, E>],
    budget: &Budget,
) -> Result<Vec<Vec<FrameTime>>, E> {
    let mut spent = vec![Duration::ZERO; contenders.len()];
    let mut frames = vec![Vec::new(); contenders.len()];
    for round in 0..budget.warm_up + budget.frames {
        for (i, contender) in contenders.iter_mut().enumerate() {
            let timed = round >= budget.warm_up;
            let done = frames[i].len();
            let enough = if spent[i] > 3 * budget.time {
                done > 0 || !timed
            } else {
                spent[i] > budget.time && (done >= Budget::FEWEST || !timed)
            };
            if enough {
                continue;
            }
            let start = Instant::now();
            let frame = contender()?;
            spent[i] += start.elapsed();
            if timed {
                frames[i].push(frame);
            }
        }
    }
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use std::{cell::RefCell, convert::Infallible};

    use super::*;

    #[test]
    fn quartiles_are_linear_between_ranks() {
        for (values, lower, median, upper) in [
            (&[][..], 0.0, 0.0, 0.0),
            (&[7.0], 7.0, 7.0, 7.0),
            (&[4.0, 1.0, 3.0, 2.0, 5.0], 2.0, 3.0, 4.0),
            (&[4.0, 1.0, 3.0, 2.0], 1.75, 2.5, 3.25),
        ] {
            assert_eq!(
                Spread::of(values),
                Spread {
                    lower,
                    median,
                    upper
                }
            );
        }
    }

    #[test]
    fn frames_are_run_in_turn_and_warm_up_frames_are_not_timed() {
        let order = RefCell::new(String::new());
        let contender = |name: char| {
            let order = &order;
            move || {
                order.borrow_mut().push(name);
                Ok::<_, Infallible>(FrameTime::default())
            }
        };
        let budget = Budget {
            frames: 3,
            warm_up: 1,
            time: Duration::from_secs(60),
        };
        let frames = interleave(&mut [contender('a'), contender('b')], &budget).unwrap();
        assert_eq!(*order.borrow(), "abababab");
        assert_eq!(frames.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
    }

    #[test]
    fn slow_techniques_get_fewer_frames_but_some() {
        let contender = |milliseconds| {
            move || {
                std::thread::sleep(Duration::from_millis(milliseconds));
                Ok::<_, Infallible>(FrameTime::default())
            }
        };
        let budget = Budget {
            frames: 9,
            warm_up: 2,
            time: Duration::from_millis(100),
        };
        let frames =
            interleave(&mut [contender(0), contender(55), contender(310)], &budget).unwrap();
        assert_eq!(
            frames.iter().map(Vec::len).collect::<Vec<_>>(),
            [9, Budget::FEWEST, 1]
        );
    }

    #[test]
    fn a_frame_that_fails_ends_the_run() {
        let mut count = 0;
        let failing = || {
            count += 1;
            if count == 2 {
                Err("lost")
            } else {
                Ok(FrameTime::default())
            }
        };
        assert_eq!(interleave(&mut [failing], &Budget::default()), Err("lost"));
        assert_eq!(count, 2);
    }

    #[test]
    fn passes_of_one_name_add_up() {
        let frame = |scale: f64| FrameTime {
            wall: 10.0 * scale,
            passes: [("tree", 1.0), ("march", 2.0), ("tree", 3.0)]
                .map(|(name, ms)| (name.to_owned(), ms * scale))
                .to_vec(),
        };
        let timing = Timing::new(Place::Gpu, None, &[frame(1.0), frame(2.0), frame(3.0)]);
        let medians: Vec<_> = timing
            .passes
            .iter()
            .map(|(n, s)| (n.as_str(), s.median))
            .collect();
        assert_eq!(medians, [("tree", 8.0), ("march", 4.0)]);
        assert_eq!(timing.gpu.map(|gpu| gpu.median), Some(12.0));
        assert_eq!((timing.wall.median, timing.total().median), (20.0, 12.0));
        let untimed = Timing::new(
            Place::Cpu,
            None,
            &[FrameTime {
                wall: 5.0,
                passes: vec![],
            }],
        );
        assert_eq!((untimed.gpu, untimed.total().median), (None, 5.0));
    }
}
