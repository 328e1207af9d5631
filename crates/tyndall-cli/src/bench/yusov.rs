//! Yusov 2012: the stages, and marching with trees and without by the side of the shadow map.

use std::time::Duration;

use tyndall::techniques::Technique;

use super::{
    paper::{self, Paper, contender},
    report::{Bench, Report},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{Budget, DrawnFrame, Timing},
    progress::Progress,
};

/// The paper's tables, and sides of shadow maps.
pub(super) struct Epipolar {
    pub(super) paper: Paper,
    /// Sides of the shadow maps of the table of trees \[texels].
    pub(super) maps: &'static [u32],
}

/// Kinds of marching; others are compared with the first.
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
pub(super) fn run(
    suite: &Epipolar,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Report, Failure> {
    let mut report = paper::run(&suite.paper, bench, progress)?;
    let scenes = suite.paper.scenes.iter();
    for subject in scenes {
        let mut rows = Vec::new();
        let mut title = String::new();
        for map in suite.maps {
            let assets = bench.assets.as_deref();
            let (shot_frame, what) = subject.load(assets, suite.paper.size, *map, progress)?;
            title = format!("{} ({what}): marching, by shadow map", subject.name);
            let drawn = DrawnFrame::new(&shot_frame, &bench.backend, progress)?;
            rows.extend(measure(*map, &drawn, progress)?);
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

fn measure(
    map: u32,
    drawn: &DrawnFrame<'_>,
    progress: &mut Progress,
) -> Result<Vec<Vec<Cell>>, Failure> {
    let (texts, techniques): (Vec<&str>, Vec<Technique>) = TREES
        .iter()
        .filter_map(|text| Some((*text, contender(text)?)))
        .filter(|(_, technique)| drawn.place(technique.info()).is_some())
        .unzip();
    let timings = progress.run(&format!("time trees of a {map}^2 map"), |_| {
        drawn.time(&techniques, &BUDGET)
    })?;
    let times: Vec<[f64; 2]> = timings
        .techniques
        .iter()
        .map(|(_, timing)| [marching(timing), timing.total().median])
        .collect();
    let row = |(text, [marching, total]): (&&str, &[f64; 2])| {
        vec![
            Cell::Count(map.into()),
            Cell::text(*text),
            Cell::Number(*marching),
            Cell::Number(times[0][0] / marching),
            Cell::Number(*total),
            Cell::Number(times[0][1] / total),
        ]
    };
    Ok(texts.iter().zip(&times).map(row).collect())
}

/// Time of marching, trees included \[ms].
fn marching(timing: &Timing) -> f64 {
    let passes = timing.passes.iter();
    passes
        .filter(|(name, _)| MARCHING.iter().any(|pass| name.starts_with(pass)))
        .map(|(_, time)| time.median)
        .sum()
}
