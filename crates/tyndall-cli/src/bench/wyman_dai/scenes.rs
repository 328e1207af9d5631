//! Table 2: several scenes.

use super::suite::{BUDGET, STAGES, ivsv, of_stage};
use crate::{
    bench::{report::Bench, table::Cell},
    failure::Failure,
    load::ShotFrame,
    measure::DrawnFrame,
    progress::Progress,
};

pub(super) const SCENES: [&str; 9] = [
    "scene",
    "maps ms",
    "voxels ms",
    "scan ms",
    "full gather ms",
    "3x3 interleaved ms",
    "1/4 upsampled ms",
    "frame, interleaved ms",
    "times faster than naive",
];

/// A row of table 2.
pub(super) fn scene(
    title: &str,
    shot_frame: &ShotFrame,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Vec<Cell>, Failure> {
    let drawn = DrawnFrame::new(shot_frame, &bench.backend, progress)?;
    let techniques = [
        ivsv("full", true)?,
        ivsv("interleaved", true)?,
        ivsv("quarter", true)?,
        ivsv("full", false)?,
    ];
    let timings = progress.run(&format!("time {title}"), |_| {
        drawn.time(&techniques, &BUDGET)
    })?;
    let [full, interleaved, quarter, naive] = &timings.techniques[..] else {
        return Ok(vec![Cell::text(title)]);
    };
    let mut row = vec![Cell::text(title)];
    let shared = STAGES[..3].iter();
    row.extend(shared.map(|(_, passes)| Cell::Number(of_stage(&full.1, passes))));
    let gather = STAGES[3].1;
    for (_, timing) in [full, interleaved, quarter] {
        row.push(Cell::Number(of_stage(timing, gather)));
    }
    let [frame, naive] = [interleaved, naive].map(|(_, timing)| timing.total());
    row.push(frame.into());
    row.push(Cell::Number(naive.median / frame.median));
    Ok(row)
}
