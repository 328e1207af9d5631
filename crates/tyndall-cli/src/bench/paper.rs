//! A paper's tables: its scenes by its techniques, each against brute force at equal quality and in equal time.

use std::time::Duration;

use tyndall::techniques::{Technique, Value};

use super::{
    Bench, Report,
    subject::{Subject, with_far_spot},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{
        Budget, EqualQuality, Marches, PictureError, Stage, Timing, Timings, Visibility, error_of,
        ray_march, steps_in_time, time_of_steps, timed_marches,
    },
    picture::Picture,
    progress::Stages,
    setup::Setup,
};

/// What a paper measured.
pub(super) struct Paper {
    /// The techniques it compares, whether they are there or not: a name, then any parameters as `key=value`.
    pub(super) techniques: &'static [&'static str],
    pub(super) scenes: &'static [Subject],
    /// Width and height of the pictures [pixels].
    pub(super) size: [u32; 2],
    /// Errors are measured on pictures this many times smaller on each side; 1 where quality depends on the size.
    pub(super) reduction: u32,
    /// Side of the shadow map [texels].
    pub(super) map: u32,
    /// Sides of shadow maps of a second table [texels], with a far spot light in the sun's place; none: no such table.
    pub(super) spot_maps: &'static [u32],
}

/// What [`Paper::reduction`] mostly is: the search for equal quality needs many pictures.
pub(super) const REDUCTION: u32 = 4;

/// Marches of more steps are searched for, but not timed: their frames would take minutes on a software adapter.
const MOST_TIMED_STEPS: u32 = 512;

/// Of each technique's frames in one run.
const BUDGET: Budget = Budget {
    frames: 10,
    warm_up: 1,
    time: Duration::from_secs(8),
};

const QUALITY_COLUMNS: [&str; 15] = [
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
struct Quality {
    /// Its name and parameters.
    text: &'static str,
    technique: Technique,
    error: PictureError,
    equal: Option<EqualQuality>,
}

/// Measures all of the paper's tables.
pub(super) fn run(paper: &Paper, bench: &Bench, stages: &mut Stages) -> Result<Report, Failure> {
    let missing = |text: &&&'static str| contender(text).is_none();
    let mut tables = Vec::new();
    for subject in paper.scenes {
        let (setup, what) = subject.load(bench.assets.as_deref(), paper.size, paper.map, stages)?;
        let title = format!("{} ({what})", subject.name);
        tables.extend(measure_scene(&title, &setup, paper, bench, stages)?);
        if !paper.spot_maps.is_empty() {
            tables.push(measure_maps(&title, &setup, paper, bench, stages)?);
        }
    }
    Ok(Report {
        tables,
        missing: paper.techniques.iter().filter(missing).copied().collect(),
    })
}

/// A technique by its name and parameters, `name key=value ...`; `None` where it is not there.
pub(super) fn contender(text: &'static str) -> Option<Technique> {
    let mut words = text.split_whitespace();
    let mut technique = Technique::from_name(words.next()?)?;
    for word in words {
        let (key, value) = word.split_once('=')?;
        let integer = value.parse().map(Value::Integer);
        let real = || value.parse().map(Value::Real);
        let value = integer
            .or_else(|_| real())
            .unwrap_or_else(|_| Value::Word(value.to_owned()));
        technique.set(key, &value).ok()?;
    }
    Some(technique)
}

/// The paper's techniques that are there, with their texts; brute force by itself where none is.
fn techniques(paper: &Paper, stage: &Stage<'_>) -> Vec<(&'static str, Technique)> {
    let contenders = paper.techniques.iter();
    let own: Vec<_> = contenders
        .filter_map(|text| Some((*text, contender(text)?)))
        .filter(|(_, technique)| stage.place(technique.info()).is_some())
        .collect();
    if !own.is_empty() {
        return own;
    }
    let marches = stage.techniques().into_iter().filter(is_march);
    marches.map(|t| (t.info().name, t)).collect()
}

fn is_march(technique: &Technique) -> bool {
    matches!(technique, Technique::RayMarch(_))
}

fn measure_scene(
    title: &str,
    setup: &Setup,
    paper: &Paper,
    bench: &Bench,
    stages: &mut Stages,
) -> Result<Vec<Table>, Failure> {
    let mut small = setup.clone();
    small.size = setup.size.map(|side| (side / paper.reduction).max(1));
    let small_stage = Stage::new(&small, &bench.backend, stages)?;
    let candidates = techniques(paper, &small_stage);
    if candidates.is_empty() {
        return Ok(vec![nothing(title)]);
    }
    let truth = stages.run("reference", |_| {
        small_stage.reference(Visibility::ShadowMap)
    })?;
    let mut marches = Marches::new(&small_stage, &truth);
    let mut notes = Vec::new();
    let mut qualities = Vec::new();
    for (text, technique) in candidates {
        let name = technique.info().name;
        match stages.run(&format!("errors of {text}"), |_| {
            quality(&small_stage, text, &technique, &truth, &mut marches)
        }) {
            Ok(quality) => qualities.push(quality),
            // What a technique can't do it says by itself; the others can.
            Err(Failure::Input(reason)) => notes.push(format!("{name}: {reason:#}")),
            Err(failure) => return Err(failure),
        }
    }
    let stage = Stage::new(setup, &bench.backend, stages)?;
    let contenders = contenders(&qualities);
    let timings = stages.run(&format!("time {title}"), |_| {
        stage.time(&contenders, &BUDGET)
    })?;
    notes.push(format!(
        "errors of {} x {} pixels against the converged picture of the same {}^2 shadow map; times of {} x {}",
        small.size[0], small.size[1], setup.lights.first().map_or(0, |light| light.map_size[0]),
        setup.size[0], setup.size[1],
    ));
    notes.push(format!("not in the times: {}", drawn(&stage)));
    let rows = qualities
        .iter()
        .zip(&timings.techniques)
        .map(|(quality, (_, timing))| quality_row(quality, timing, &timings, &mut marches));
    Ok(vec![
        Table {
            title: title.to_owned(),
            notes,
            columns: QUALITY_COLUMNS.to_vec(),
            rows: rows.collect::<Result<_, _>>()?,
        },
        passes(title, &timings, &qualities),
    ])
}

pub(super) fn nothing(title: &str) -> Table {
    Table {
        title: title.to_owned(),
        notes: vec!["no technique that is there can do its lights".to_owned()],
        columns: Vec::new(),
        rows: Vec::new(),
    }
}

fn quality(
    stage: &Stage<'_>,
    text: &'static str,
    technique: &Technique,
    truth: &Picture,
    marches: &mut Marches<'_>,
) -> Result<Quality, Failure> {
    let error = error_of(&stage.in_scatter(technique)?, truth)?;
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
fn contenders(qualities: &[Quality]) -> Vec<Technique> {
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

fn quality_row(
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

/// Every pass of the techniques, and of the limit.
fn passes(title: &str, timings: &Timings, qualities: &[Quality]) -> Table {
    let techniques = qualities.iter().zip(&timings.techniques);
    let techniques = techniques.map(|(quality, (_, timing))| (quality.text, timing));
    let limit = timings.limit.iter().map(|limit| ("limit", limit));
    let rows = techniques.chain(limit).flat_map(|(name, timing)| {
        let all: f64 = timing.passes.iter().map(|(_, time)| time.median).sum();
        let passes = timing.passes.iter();
        passes.map(move |(pass, time)| {
            vec![
                Cell::text(name),
                Cell::text(pass),
                (*time).into(),
                (100.0 * time.median / all).into(),
            ]
        })
    });
    Table {
        title: format!("{title}: passes"),
        notes: Vec::new(),
        columns: vec!["technique", "pass", "ms", "percent"],
        rows: rows.collect(),
    }
}

/// What drew the stage's depth buffer and shadow maps, added up by pass.
fn drawn(stage: &Stage<'_>) -> String {
    let mut sums: Vec<(&str, f64)> = Vec::new();
    for (name, milliseconds) in stage.drawn() {
        match sums.iter_mut().find(|(known, _)| known == name) {
            Some((_, sum)) => *sum += milliseconds,
            None => sums.push((name, *milliseconds)),
        }
    }
    let sums: Vec<String> = sums
        .iter()
        .map(|(name, ms)| format!("{name} {ms:.1} ms"))
        .collect();
    if sums.is_empty() {
        "depth buffer and shadow map".to_owned()
    } else {
        sums.join(", ")
    }
}

/// Time against the side of the shadow map, with a far spot light in the sun's place.
fn measure_maps(
    title: &str,
    setup: &Setup,
    paper: &Paper,
    bench: &Bench,
    stages: &mut Stages,
) -> Result<Table, Failure> {
    let mut setup = with_far_spot(setup);
    let mut rows = Vec::new();
    for map in paper.spot_maps {
        for light in &mut setup.lights {
            light.map_size = [*map; 2];
        }
        let stage = Stage::new(&setup, &bench.backend, stages)?;
        let (texts, techniques): (Vec<_>, Vec<_>) = techniques(paper, &stage).into_iter().unzip();
        let timings = stages.run(&format!("time {title}, {map}^2 map"), |_| {
            stage.time(&techniques, &BUDGET)
        })?;
        rows.extend(
            texts
                .iter()
                .zip(&timings.techniques)
                .map(|(text, (_, timing))| {
                    vec![
                        Cell::Count((*map).into()),
                        Cell::text(*text),
                        Cell::text(timing.place.name()),
                        timing.total().into(),
                        timings.over_limit(timing).into(),
                        Cell::mebibytes(timing.bytes),
                    ]
                }),
        );
    }
    Ok(Table {
        title: format!("{title}: far spot light, by shadow map"),
        notes: Vec::new(),
        columns: vec!["map side", "technique", "on", "ms", "x limit", "MiB"],
        rows,
    })
}
