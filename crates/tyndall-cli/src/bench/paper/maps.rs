//! The table of a scene by the side of its shadow map.

use super::suite::{BUDGET, Paper, techniques};
use crate::{
    bench::{
        report::Bench,
        subject::with_far_spot,
        table::{Cell, Table},
    },
    failure::Failure,
    load::ShotFrame,
    measure::DrawnFrame,
    progress::Progress,
};

/// Time against the side of the shadow map, with a far spot light in the sun's place.
pub(super) fn measure_maps(
    title: &str,
    shot_frame: &ShotFrame,
    paper: &Paper,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Table, Failure> {
    let mut shot_frame = with_far_spot(shot_frame);
    let mut rows = Vec::new();
    for map in paper.spot_maps {
        for light in &mut shot_frame.lights {
            light.map_size = [*map; 2];
        }
        let drawn = DrawnFrame::new(&shot_frame, &bench.backend, progress)?;
        let (texts, techniques): (Vec<_>, Vec<_>) = techniques(paper, &drawn).into_iter().unzip();
        let timings = progress.run(&format!("time {title}, {map}^2 map"), |_| {
            drawn.time(&techniques, &BUDGET)
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
