//! Table 1: samples one by one and all at once, stage by stage.

use tyndall::techniques::Technique;

use super::suite::{AreaLights, BUDGET, RESOLUTION, STAGES, ivsv, of_stage, with_samples};
use crate::{
    bench::{
        paper,
        report::Bench,
        table::{Cell, Table},
    },
    failure::Failure,
    load::ShotFrame,
    measure::DrawnFrame,
    progress::Progress,
};

const STEPS: [&str; 19] = [
    "samples",
    "maps, naive ms",
    "batched",
    "ratio",
    "voxels, naive ms",
    "batched",
    "ratio",
    "scan, naive ms",
    "batched",
    "ratio",
    "gather, naive ms",
    "batched",
    "ratio",
    "frame, naive ms",
    "batched",
    "ratio",
    "wall ratio",
    "passes, naive",
    "batched",
];

/// Table 1, and what a pass costs by itself.
pub(super) fn steps(
    title: &str,
    shot_frame: &ShotFrame,
    suite: &AreaLights,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<[Table; 2], Failure> {
    let mut rows = Vec::new();
    let mut batched = Vec::new();
    for count in suite.samples {
        let shot_frame = with_samples(shot_frame.clone(), *count);
        let drawn = DrawnFrame::new(&shot_frame, &bench.backend, progress)?;
        let techniques = [ivsv("full", false)?, ivsv("full", true)?];
        let timings = progress.run(&format!("time {count} samples"), |_| {
            drawn.time(&techniques, &BUDGET)
        })?;
        let [(_, naive), (_, at_once)] = &timings.techniques[..] else {
            return Ok([paper::nothing(title), paper::nothing(title)]);
        };
        let mut row = vec![Cell::Count((*count).into())];
        let mut pair = |naive: f64, at_once: f64| {
            row.extend([naive, at_once, naive / at_once].map(Cell::Number));
        };
        for (_, passes) in STAGES {
            pair(of_stage(naive, passes), of_stage(at_once, passes));
        }
        pair(naive.total().median, at_once.total().median);
        row.push(Cell::Number(naive.wall.median / at_once.wall.median));
        for technique in &techniques {
            row.push(Cell::Count(counted(&drawn, technique, "passes")?));
        }
        rows.push(row);
        let times = STAGES.map(|(_, passes)| [naive, at_once].map(|t| of_stage(t, passes)));
        batched.push((*count, times));
    }
    let [width, height] = suite.size;
    Ok([
        Table {
            title: format!("table 1: {title}"),
            notes: vec![format!(
                "{width} x {height} pixels, {RESOLUTION}^3 voxels a sample; naive: one set of passes a sample"
            )],
            columns: STEPS.to_vec(),
            rows,
        },
        overheads(&batched),
    ])
}

/// A number of a technique's counts whose name starts so.
fn counted(drawn: &DrawnFrame<'_>, technique: &Technique, name: &str) -> Result<u64, Failure> {
    let counts = drawn.counts(technique)?;
    let of_name = counts.iter().find(|(count, _)| count.starts_with(name));
    Ok(of_name.map_or(0, |(_, count)| *count))
}

/// Splits the naive form's time into work that batches do too and the rest, and says how much larger the rest would have
/// to be for the paper's ratios.
fn overheads(batched: &[(u32, [[f64; 2]; 4])]) -> Table {
    /// The paper's ratios of 256 samples.
    const PAPER: [f64; 4] = [18.6, 16.6, 25.8, 2.0];
    let rows = batched.last().map(|(count, times)| {
        let row = |((name, _), (paper, [naive, at_once])): ((&str, _), (f64, [f64; 2]))| {
            let [a_pass, work] = [naive, at_once].map(|ms| ms / f64::from(*count));
            let needed = (paper - 1.0) * work;
            vec![
                Cell::text(name),
                Cell::Number(1e3 * work),
                Cell::Number(1e3 * (a_pass - work).max(0.0)),
                Cell::Number(1e3 * needed),
                Cell::Number(paper),
            ]
        };
        STAGES
            .into_iter()
            .zip(PAPER.into_iter().zip(*times))
            .map(row)
            .collect()
    });
    Table {
        title: "why: work and overhead of a sample".to_owned(),
        notes: vec![
            "a ratio r needs passes whose overhead is r - 1 times a sample's work in them; a device that draws hundreds of samples at once has little of the one, a software driver little of the other".to_owned(),
        ],
        columns: vec![
            "stage",
            "work of a sample us",
            "overhead of its pass us",
            "overhead that the paper's ratio takes us",
            "paper's ratio",
        ],
        rows: rows.unwrap_or_default(),
    }
}
