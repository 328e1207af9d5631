//! All tables of a paper.

use super::{
    maps::measure_maps,
    scene::measure_scene,
    suite::{Paper, contender},
};
use crate::{
    bench::report::{Bench, Report},
    failure::Failure,
    progress::Progress,
};

/// Measures all of the paper's tables.
pub(in crate::bench) fn run(
    paper: &Paper,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Report, Failure> {
    let missing = |text: &&&'static str| contender(text).is_none();
    let mut tables = Vec::new();
    for subject in paper.scenes {
        let (shot_frame, what) =
            subject.load(bench.assets.as_deref(), paper.size, paper.map, progress)?;
        let title = format!("{} ({what})", subject.name);
        tables.extend(measure_scene(&title, &shot_frame, paper, bench, progress)?);
        if !paper.spot_maps.is_empty() {
            tables.push(measure_maps(&title, &shot_frame, paper, bench, progress)?);
        }
    }
    Ok(Report {
        tables,
        missing: paper.techniques.iter().filter(missing).copied().collect(),
        faults: Vec::new(),
    })
}
