//! All tables of the suite.

use super::{
    costs::costs,
    scenes::{SCENES, scene},
    steps::steps,
    suite::{AreaLights, RESOLUTION, with_samples},
};
use crate::{
    bench::{
        report::{Bench, Report},
        table::Table,
    },
    failure::Failure,
    progress::Progress,
};

/// Measures the suite.
pub(in crate::bench) fn run(
    suite: &AreaLights,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Report, Failure> {
    let most = suite.samples.last().copied().unwrap_or(1);
    let mut tables = Vec::new();
    let mut scenes = Vec::new();
    for (i, subject) in suite.scenes.iter().enumerate() {
        let (shot_frame, what) =
            subject.load(bench.assets.as_deref(), suite.size, RESOLUTION, progress)?;
        let title = format!("{} ({what})", subject.name);
        let shot_frame = with_samples(shot_frame, most);
        if i == 0 {
            tables.extend(steps(&title, &shot_frame, suite, bench, progress)?);
            tables.push(costs(&title, &shot_frame, bench, progress)?);
        }
        scenes.push(scene(&title, &shot_frame, bench, progress)?);
    }
    tables.push(Table {
        title: format!("table 2: {most} samples, {RESOLUTION}^3 voxels each"),
        notes: vec!["naive is one set of passes a sample, gathered at full resolution".to_owned()],
        columns: SCENES.to_vec(),
        rows: scenes,
    });
    Ok(Report {
        tables,
        missing: Vec::new(),
        faults: Vec::new(),
    })
}
