//! The suite's tables, one after the other.

use super::{
    films::Films,
    stale::{compare, left_table},
    time::{time, times_table},
    walk::{WALKERS, walk, walks_table},
};
use crate::{
    backend::Backend,
    bench::{
        paper,
        report::{Bench, Report},
        subject,
        table::Table,
    },
    failure::Failure,
    progress::Progress,
};

/// Techniques that reuse is timed about: the thesis's technique, as the shots have it, and brute force.
const TIMED: [(&str, &[&str]); 2] = [
    ("hybrid, 1024 steps", &[]),
    (
        "ray-march, 256 steps",
        &["technique={name='ray-march',steps=256}"],
    ),
];

/// Measures the suite.
pub(in crate::bench) fn run(
    films: &Films,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Report, Failure> {
    let mut times = TIMED.map(|_| Vec::new());
    let mut left = Vec::new();
    let mut walks = Vec::new();
    if matches!(bench.backend, Backend::Gpu(_)) {
        for ((technique, values), rows) in TIMED.iter().zip(&mut times) {
            for (scene, thesis) in films.scenes {
                let what = format!("time {technique}, {}", scene.name);
                rows.push(progress.run(&what, |report| {
                    time(films, scene, values, thesis, bench, report)
                })?);
            }
        }
        let scene = subject::DONUTS;
        left = progress.run(&format!("compare {}", scene.name), |report| {
            compare(films, &scene, bench, report)
        })?;
        for technique in WALKERS {
            walks.extend(progress.run(&format!("walk by {technique}"), |report| {
                walk(films, technique, bench, report)
            })?);
        }
    }
    if times.iter().all(Vec::is_empty) {
        return Ok(Report {
            tables: vec![paper::nothing("temporal reuse")],
            missing: Vec::new(),
            faults: Vec::new(),
        });
    }
    let timed = TIMED.iter().zip(times);
    let mut tables: Vec<Table> = timed
        .map(|((technique, _), rows)| times_table(films, technique, rows))
        .collect();
    tables.extend([left_table(films, left), walks_table(films, walks)]);
    Ok(Report {
        tables,
        missing: Vec::new(),
        faults: Vec::new(),
    })
}
