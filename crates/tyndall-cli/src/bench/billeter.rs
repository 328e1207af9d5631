//! Billeter et al. 2010: light volumes of two lights, all texels or planar cells merged, with a mesh that is listed anew
//! each frame and one that stays.

use std::time::Duration;

use tyndall::{
    frame::Emitter,
    techniques::{Technique, Value},
};
use tyndall_scene::shadow_fit;

use super::{
    paper::{self, REDUCTION},
    report::{Bench, Report},
    subject::Subject,
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    load::ShotFrame,
    measure::{Budget, DrawnFrame, Timing, Visibility, error_of},
    progress::Progress,
};

/// Scene and sizes.
pub(super) struct LightVolumes {
    pub(super) scene: Subject,
    /// Width and height of the picture \[pixels].
    pub(super) size: [u32; 2],
    /// Sides of the shadow maps \[texels].
    pub(super) maps: &'static [u32],
}

const NAME: &str = "light-volume";

/// Tolerances of the mesh [widths of a texel], and what they are called.
const MESHES: [(&str, f64); 3] = [("full", 0.0), ("adaptive, 0.5", 0.5), ("adaptive, 2", 2.0)];

const BUDGET: Budget = Budget {
    frames: 7,
    warm_up: 1,
    time: Duration::from_secs(8),
};

const COLUMNS: [&str; 10] = [
    "map side",
    "mesh",
    "triangles",
    "times fewer",
    "relMAE",
    "ms, listed anew",
    "ms, mesh stays",
    "ratio",
    "x limit",
    "MiB",
];

/// Measures the suite.
pub(super) fn run(
    suite: &LightVolumes,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Report, Failure> {
    let mut rows = Vec::new();
    let mut title = String::new();
    for map in suite.maps {
        let loaded = suite
            .scene
            .load(bench.assets.as_deref(), suite.size, *map, progress)?;
        let (shot_frame, what) = (with_second_sun(loaded.0), loaded.1);
        title = format!("{} ({what}), two suns", suite.scene.name);
        rows.extend(measure(*map, &shot_frame, bench, progress)?);
    }
    let tables = if rows.is_empty() {
        vec![paper::nothing(&title)]
    } else {
        let [width, height] = suite.size;
        let small = suite.size.map(|side| side / REDUCTION);
        vec![Table {
            title,
            notes: vec![
                format!("times of {width} x {height} pixels; errors of {} x {} against the converged picture of the same map", small[0], small[1]),
                "triangles of both lights' surfaces; a stable map spares an adaptive mesh its listing".to_owned(),
            ],
            columns: COLUMNS.to_vec(),
            rows,
        }]
    };
    Ok(Report {
        tables,
        missing: Vec::new(),
        faults: Vec::new(),
    })
}

/// The scene lit by its sun and another one from the opposite side.
fn with_second_sun(mut shot_frame: ShotFrame) -> ShotFrame {
    let (first, extra) = (shot_frame.frame.lights.first(), shot_frame.lights.first());
    if let (Some(first), Some(extra)) = (first, extra)
        && let Emitter::Directional {
            direction: [x, y, z],
            illuminance,
        } = first.emitter
    {
        let mut second = *first;
        second.emitter = Emitter::Directional {
            direction: [-x, y, -z],
            illuminance,
        };
        second.shadow = shadow_fit::fit(shot_frame.tracer.geometry(), &second.emitter);
        let extra = extra.clone();
        shot_frame.frame.lights.push(second);
        shot_frame.lights.push(extra);
    }
    shot_frame
}

fn light_volume(tolerance: f64) -> Option<Technique> {
    let mut technique = Technique::from_name(NAME)?;
    technique.set("tolerance", &Value::Real(tolerance)).ok()?;
    Some(technique)
}

fn measure(
    map: u32,
    shot_frame: &ShotFrame,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Vec<Vec<Cell>>, Failure> {
    let small = paper::reduced(shot_frame, REDUCTION);
    let small_drawn = DrawnFrame::new(&small, &bench.backend, progress)?;
    let techniques: Vec<Technique> = MESHES
        .iter()
        .filter_map(|(_, tolerance)| light_volume(*tolerance))
        .filter(|technique| small_drawn.place(technique.info()).is_some())
        .collect();
    if techniques.is_empty() {
        return Ok(Vec::new());
    }
    let truth = progress.run("reference", |_| {
        small_drawn.reference(Visibility::ShadowMap)
    })?;
    let drawn = DrawnFrame::new(shot_frame, &bench.backend, progress)?;
    let (timings, limit) = progress.run(&format!("time {map}^2 maps"), |_| {
        drawn.time_with_stable_maps(&techniques, &BUDGET)
    })?;
    let meshes = techniques.iter().zip(MESHES).zip(&timings);
    meshes
        .map(|((technique, (mesh, _)), [anew, stays])| {
            let error = error_of(&small_drawn.in_scatter(technique)?, &truth)?.rel_mae;
            let counts = drawn.counts(technique)?;
            let sum = |which: &str| -> u64 {
                let of_kind = counts.iter().filter(|(name, _)| name.contains(which));
                of_kind.map(|(_, count)| count).sum()
            };
            let full = sum("triangles, full");
            let drawn = Some(sum("triangles, adaptive")).filter(|n| *n > 0);
            let drawn = drawn.unwrap_or(full);
            let of_limit = |t: &Timing| {
                let limit = limit.as_ref()?;
                Some(t.total().median / limit.total().median)
            };
            Ok(vec![
                Cell::Count(map.into()),
                Cell::text(mesh),
                Cell::Count(drawn),
                Cell::Number(full as f64 / drawn as f64),
                error.into(),
                anew.total().into(),
                stays.total().into(),
                Cell::Number(anew.total().median / stays.total().median),
                of_limit(stays).into(),
                Cell::mebibytes(anew.bytes),
            ])
        })
        .collect()
}
