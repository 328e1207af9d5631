//! Billeter et al. 2010: light volumes of two lights, all texels or planar cells merged, with a mesh that is listed anew
//! each frame and one that stays.

use std::time::Duration;

use tyndall::{
    frame::Emitter,
    techniques::{Technique, Value},
};
use tyndall_scene::shadow_fit;

use super::{
    Bench, Report,
    paper::{self, REDUCTION},
    subject::Subject,
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{Budget, Stage, Timing, Visibility, error_of},
    progress::Stages,
    setup::Setup,
};

/// What is measured.
pub(super) struct LightVolumes {
    pub(super) scene: Subject,
    /// Width and height of the picture [pixels].
    pub(super) size: [u32; 2],
    /// Sides of the shadow maps [texels].
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
    stages: &mut Stages,
) -> Result<Report, Failure> {
    let mut rows = Vec::new();
    let mut title = String::new();
    for map in suite.maps {
        let loaded = suite
            .scene
            .load(bench.assets.as_deref(), suite.size, *map, stages)?;
        let (setup, what) = (with_second_sun(loaded.0), loaded.1);
        title = format!("{} ({what}), two suns", suite.scene.name);
        rows.extend(measure(*map, &setup, bench, stages)?);
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
    })
}

/// The scene lit by its sun and another one from the opposite side.
fn with_second_sun(mut setup: Setup) -> Setup {
    let (first, extra) = (setup.frame.lights.first(), setup.lights.first());
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
        second.shadow = shadow_fit::fit(setup.tracer.geometry(), &second.emitter);
        let extra = extra.clone();
        setup.frame.lights.push(second);
        setup.lights.push(extra);
    }
    setup
}

fn light_volume(tolerance: f64) -> Option<Technique> {
    let mut technique = Technique::from_name(NAME)?;
    technique.set("tolerance", &Value::Real(tolerance)).ok()?;
    Some(technique)
}

fn measure(
    map: u32,
    setup: &Setup,
    bench: &Bench,
    stages: &mut Stages,
) -> Result<Vec<Vec<Cell>>, Failure> {
    let mut small = setup.clone();
    small.size = setup.size.map(|side| (side / REDUCTION).max(1));
    let small_stage = Stage::new(&small, &bench.backend, stages)?;
    let techniques: Vec<Technique> = MESHES
        .iter()
        .filter_map(|(_, tolerance)| light_volume(*tolerance))
        .filter(|technique| small_stage.place(technique.info()).is_some())
        .collect();
    if techniques.is_empty() {
        return Ok(Vec::new());
    }
    let truth = stages.run("reference", |_| {
        small_stage.reference(Visibility::ShadowMap)
    })?;
    let stage = Stage::new(setup, &bench.backend, stages)?;
    let (timings, limit) = stages.run(&format!("time {map}^2 maps"), |_| {
        stage.time_with_stable_maps(&techniques, &BUDGET)
    })?;
    let meshes = techniques.iter().zip(MESHES).zip(&timings);
    meshes
        .map(|((technique, (mesh, _)), [anew, stays])| {
            let error = error_of(&small_stage.in_scatter(technique)?, &truth)?.rel_mae;
            let counts = stage.counts(technique)?;
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
