//! A technique's errors and times beside those of brute force at equal quality and in equal time.

use tyndall::techniques::Technique;

use super::suite::is_march;
use crate::{
    bench::table::Cell,
    failure::Failure,
    measure::{
        DrawnFrame, EqualQuality, Marches, PictureError, Timing, Timings, error_of, ray_march,
        steps_in_time, time_of_steps, timed_marches,
    },
    picture::Picture,
};

/// Marches of more steps are searched for, but not timed: their frames would take minutes on a software adapter.
const MOST_TIMED_STEPS: u32 = 512;

pub(super) const QUALITY_COLUMNS: [&str; 15] = [
    "technique",
    "on",
    "ms",
    "wall ms",
    "frames",
    "x limit",
    "MiB",
    "relMAE",
    "bias",
    "equal-quality steps",
    "their ms",
    "speed-up",
    "by the line",
    "equal-time steps",
    "their relMAE",
];

/// A technique's picture against the converged one of the same shadow map.
pub(super) struct Quality {
    /// Its name and parameters.
    pub(super) text: &'static str,
    pub(super) technique: Technique,
    pub(super) error: PictureError,
    pub(super) equal: Option<EqualQuality>,
}

/// Measures a technique's errors, and searches for brute force of equal quality.
pub(super) fn quality(
    drawn: &DrawnFrame<'_>,
    text: &'static str,
    technique: &Technique,
    truth: &Picture,
    marches: &mut Marches<'_>,
) -> Result<Quality, Failure> {
    let error = error_of(&drawn.in_scatter(technique)?, truth)?;
    let equal = (!is_march(technique))
        .then(|| marches.equal_quality(error.rel_mae))
        .transpose()?;
    Ok(Quality {
        text,
        technique: technique.clone(),
        error,
        equal,
    })
}

impl Quality {
    /// The march that is timed for it: that of equal quality, or the longest that is timed.
    fn timed_steps(&self) -> Option<u32> {
        self.equal.map(|equal| equal.steps.min(MOST_TIMED_STEPS))
    }

    /// Whether the timed march is as good as the technique.
    fn is_equal(&self) -> bool {
        self.equal
            .is_some_and(|equal| equal.reached && equal.steps <= MOST_TIMED_STEPS)
    }
}

/// The techniques, the two marches that say what a step takes, and those of equal quality.
pub(super) fn contenders(qualities: &[Quality]) -> Vec<Technique> {
    let mut contenders: Vec<Technique> = qualities.iter().map(|q| q.technique.clone()).collect();
    if qualities.iter().any(|quality| quality.equal.is_some()) {
        contenders.extend(timed_marches());
    }
    for steps in qualities.iter().filter_map(Quality::timed_steps) {
        let march = ray_march(steps);
        if !contenders.contains(&march) {
            contenders.push(march);
        }
    }
    contenders
}

fn time_of<'a>(timings: &'a Timings, technique: &Technique) -> Option<&'a Timing> {
    let mut all = timings.techniques.iter();
    all.find(|(timed, _)| timed == technique)
        .map(|(_, timing)| timing)
}

/// A technique's row of the table.
pub(super) fn quality_row(
    quality: &Quality,
    timing: &Timing,
    timings: &Timings,
    marches: &mut Marches<'_>,
) -> Result<Vec<Cell>, Failure> {
    let total = timing.total();
    let march = quality
        .timed_steps()
        .and_then(|steps| time_of(timings, &ray_march(steps)));
    let speed_up = march.map(|march| march.total().median / total.median);
    let line = match timed_marches().map(|march| time_of(timings, &march)) {
        [Some(few), Some(many)] => Some([few, many].map(|t| t.total().median)),
        _ => None,
    };
    let compared = quality.equal.zip(line);
    let same_time = compared
        .map(|(_, line)| {
            let steps = steps_in_time(total.median, line);
            marches.error_at(steps).map(|error| (steps, error.rel_mae))
        })
        .transpose()?;
    let by_the_line = compared.map(|(equal, line)| {
        let ratio = time_of_steps(equal.steps, line) / total.median;
        let bound = if equal.reached { "" } else { "> " };
        Cell::Text(format!("{bound}{ratio:.1}"))
    });
    let at_least = |text: String| {
        Cell::Text(if quality.is_equal() {
            text
        } else {
            format!("> {text}")
        })
    };
    Ok(vec![
        Cell::text(quality.text),
        Cell::text(timing.place.name()),
        total.into(),
        timing.wall.into(),
        Cell::Count(timing.frames as u64),
        timings.over_limit(timing).into(),
        Cell::mebibytes(timing.bytes),
        quality.error.rel_mae.into(),
        quality.error.bias.into(),
        steps_cell(quality.equal),
        march.map_or(Cell::Empty, |march| {
            at_least(Cell::Time(march.total()).to_string())
        }),
        speed_up.map_or(Cell::Empty, |ratio| at_least(format!("{:.2}", ratio))),
        by_the_line.unwrap_or(Cell::Empty),
        same_time.map_or(Cell::Empty, |(steps, _)| Cell::Count(steps.into())),
        same_time.map(|(_, error)| error).into(),
    ])
}

fn steps_cell(equal: Option<EqualQuality>) -> Cell {
    match equal {
        None => Cell::Empty,
        Some(equal) if equal.reached => Cell::Count(equal.steps.into()),
        Some(equal) => Cell::Text(format!("> {}", equal.steps)),
    }
}
