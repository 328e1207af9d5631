//! Yusov 2012: the stages, and marching with trees and without by the side of the shadow map.

use std::time::Duration;

use tyndall::techniques::Technique;

use super::{
    Bench, Report,
    paper::{self, Paper, contender},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{Budget, Stage, Timing},
    progress::Stages,
};

/// What is measured.
pub(super) struct Epipolar {
    pub(super) paper: Paper,
    /// Sides of the shadow maps of the table of trees [texels].
    pub(super) maps: &'static [u32],
}

/// The ways of marching; the first is what others are compared with.
const TREES: [&str; 2] = ["epipolar tree=none", "epipolar tree=min-max"];

/// The stages that depend on how rays are marched.
const MARCHING: [&str; 5] = [
    "slice directions",
    "min/max tree",
    "ray marching",
    "correction",
    "second correction",
];

const BUDGET: Budget = Budget {
    frames: 10,
    warm_up: 1,
    time: Duration::from_secs(8),
};

/// Measures the suite.
pub(super) fn run(suite: &Epipolar, bench: &Bench, stages: &mut Stages) -> Result<Report, Failure> {
    let mut report = paper::run(&suite.paper, bench, stages)?;
    let scenes = suite.paper.scenes.iter();
    for subject in scenes {
        let mut rows = Vec::new();
        let mut title = String::new();
        for map in suite.maps {
            let assets = bench.assets.as_deref();
            let (setup, what) = subject.load(assets, suite.paper.size, *map, stages)?;
            title = format!("{} ({what}): marching, by shadow map", subject.name);
            let stage = Stage::new(&setup, &bench.backend, stages)?;
            rows.extend(measure(*map, &stage, stages)?);
        }
        report.tables.push(Table {
            title,
            notes: vec![format!("marching: {}", MARCHING.join(", "))],
            columns: vec![
                "map side",
                "technique",
                "marching ms",
                "x faster",
                "ms",
                "x faster",
            ],
            rows,
        });
    }
    Ok(report)
}

fn measure(map: u32, stage: &Stage<'_>, stages: &mut Stages) -> Result<Vec<Vec<Cell>>, Failure> {
    let (texts, techniques): (Vec<&str>, Vec<Technique>) = TREES
        .iter()
        .filter_map(|text| Some((*text, contender(text)?)))
        .filter(|(_, technique)| stage.place(technique.info()).is_some())
        .unzip();
    let timings = stages.run(&format!("time trees of a {map}^2 map"), |_| {
        stage.time(&techniques, &BUDGET)
    })?;
    let times: Vec<[f64; 2]> = timings
        .techniques
        .iter()
        .map(|(_, timing)| [marching(timing), timing.total().median])
        .collect();
    let row = |(text, [marching, whole]): (&&str, &[f64; 2])| {
        vec![
            Cell::Count(map.into()),
            Cell::text(*text),
            Cell::Number(*marching),
            Cell::Number(times[0][0] / marching),
            Cell::Number(*whole),
            Cell::Number(times[0][1] / whole),
        ]
    };
    Ok(texts.iter().zip(&times).map(row).collect())
}

/// What marching takes, trees counted in [ms].
fn marching(timing: &Timing) -> f64 {
    let passes = timing.passes.iter();
    passes
        .filter(|(name, _)| MARCHING.iter().any(|pass| name.starts_with(pass)))
        .map(|(_, time)| time.median)
        .sum()
}
