//! The tables of one scene: quality, and passes.

use super::{
    quality::{QUALITY_COLUMNS, Quality, contenders, quality, quality_row},
    suite::{BUDGET, Paper, nothing, reduced, techniques},
};
use crate::{
    bench::{
        report::Bench,
        table::{Cell, Table},
    },
    failure::Failure,
    load::ShotFrame,
    measure::{DrawnFrame, Marches, Timings, Visibility},
    progress::Progress,
};

/// Measures a scene: its techniques' errors on small pictures, and their times on large ones.
pub(super) fn measure_scene(
    title: &str,
    shot_frame: &ShotFrame,
    paper: &Paper,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Vec<Table>, Failure> {
    let small = reduced(shot_frame, paper.reduction);
    let small_drawn = DrawnFrame::new(&small, &bench.backend, progress)?;
    let candidates = techniques(paper, &small_drawn);
    if candidates.is_empty() {
        return Ok(vec![nothing(title)]);
    }
    let truth = progress.run("reference", |_| {
        small_drawn.reference(Visibility::ShadowMap)
    })?;
    let mut marches = Marches::new(&small_drawn, &truth);
    let mut notes = Vec::new();
    let mut qualities = Vec::new();
    for (text, technique) in candidates {
        let name = technique.info().name;
        match progress.run(&format!("errors of {text}"), |_| {
            quality(&small_drawn, text, &technique, &truth, &mut marches)
        }) {
            Ok(quality) => qualities.push(quality),
            // A technique says by itself that it can't do the scene; the others can.
            Err(Failure::Input(reason)) => notes.push(format!("{name}: {reason:#}")),
            Err(failure) => return Err(failure),
        }
    }
    let drawn = DrawnFrame::new(shot_frame, &bench.backend, progress)?;
    let contenders = contenders(&qualities);
    let timings = progress.run(&format!("time {title}"), |_| {
        drawn.time(&contenders, &BUDGET)
    })?;
    notes.push(format!(
        "errors of {} x {} pixels against the converged picture of the same {}^2 shadow map; times of {} x {}",
        small.size[0], small.size[1], shot_frame.lights.first().map_or(0, |light| light.map_size[0]),
        shot_frame.size[0], shot_frame.size[1],
    ));
    notes.push(format!("not in the times: {}", draw_passes(&drawn)));
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

/// The passes that drew depth buffer and shadow maps, added up by name.
fn draw_passes(drawn: &DrawnFrame<'_>) -> String {
    let mut sums: Vec<(&str, f64)> = Vec::new();
    for (name, milliseconds) in drawn.draw_passes() {
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
