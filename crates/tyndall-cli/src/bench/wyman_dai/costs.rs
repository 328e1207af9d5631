//! The cost of many soft samples against one hard shadow volume.

use glam::Vec3;
use tyndall::{
    frame::Emitter,
    techniques::{Technique, Value},
};
use tyndall_scene::shadow_fit;

use super::suite::{BUDGET, RESOLUTION, ivsv, technique};
use crate::{
    bench::{
        report::Bench,
        table::{Cell, Table},
    },
    failure::Failure,
    load::ShotFrame,
    measure::{DrawnFrame, Timing},
    progress::Progress,
};

/// Voxels a side of a hard shadow volume, and texels a face of its shadow map.
const HARD: i64 = 512;

const HARD_MAP: u32 = 1024;

const COSTS: [&str; 8] = [
    "technique",
    "ms",
    "x vsv",
    "wall ms",
    "passes",
    "light rays voxelized",
    "MiB of voxels",
    "MiB",
];

/// Many soft samples against one hard shadow volume of a lamp in the light's middle.
pub(super) fn costs(
    title: &str,
    shot_frame: &ShotFrame,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Table, Failure> {
    let hard = [technique("vsv", &[("resolution", Value::Integer(HARD))])?];
    let soft = [
        ivsv("interleaved", true)?,
        ivsv("quarter", true)?,
        ivsv("full", true)?,
    ];
    let samples = samples(shot_frame);
    let lamp = with_lamp(shot_frame.clone());
    let mut rows = Vec::new();
    let mut of_hard = 0.0;
    let measured = [
        (&lamp, &hard[..], HARD as u64, 1),
        (shot_frame, &soft[..], RESOLUTION.into(), u64::from(samples)),
    ];
    for (shot_frame, techniques, side, grids) in measured {
        let drawn = DrawnFrame::new(shot_frame, &bench.backend, progress)?;
        let timings = progress.run(&format!("time {title}, {side}^3"), |_| {
            drawn.time(techniques, &BUDGET)
        })?;
        for (technique, timing) in &timings.techniques {
            if of_hard == 0.0 {
                of_hard = timing.total().median;
            }
            rows.push(cost_row(technique, timing, of_hard, side, grids));
        }
    }
    Ok(Table {
        title: format!("cost against one hard shadow volume of {HARD}^3 voxels: {title}"),
        notes: vec![
            format!("soft: {samples} samples of {RESOLUTION}^3 voxels; the lamp's {HARD_MAP}^2 cube map is drawn by the caller and not counted, the samples' maps are"),
            "both forms clear their voxels, set one a light ray, and scan them: rays and MiB are what they do of it".to_owned(),
        ],
        columns: COSTS.to_vec(),
        rows,
    })
}

/// A technique's row; `of_hard` is the time of the hard shadow volume \[ms], `side` the voxels a side of its `grids`.
fn cost_row(
    technique: &Technique,
    timing: &Timing,
    of_hard: f64,
    side: u64,
    grids: u64,
) -> Vec<Cell> {
    vec![
        Cell::text(label(technique)),
        timing.total().into(),
        Cell::Number(timing.total().median / of_hard),
        timing.wall.into(),
        Cell::Count(timing.passes.len() as u64),
        Cell::Count(side * side * grids),
        Cell::mebibytes(Some(side.pow(3) / 8 * grids)),
        Cell::mebibytes(timing.bytes),
    ]
}

/// Samples of all lights.
fn samples(shot_frame: &ShotFrame) -> u32 {
    let lights = shot_frame.frame.lights.iter();
    let samples = lights.map(|light| match light.emitter {
        Emitter::Rect { samples, .. } => samples,
        _ => 1,
    });
    samples.sum()
}

fn label(technique: &Technique) -> String {
    let gather = technique.params().into_iter().find(|p| p.key == "gather");
    let name = technique.info().name;
    gather.map_or(name.to_owned(), |gather| format!("{name} {}", gather.value))
}

/// A lamp in the middle of the rectangle, as strong as it is along its normal.
fn with_lamp(mut shot_frame: ShotFrame) -> ShotFrame {
    for (light, extra) in shot_frame
        .frame
        .lights
        .iter_mut()
        .zip(&mut shot_frame.lights)
    {
        if let Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            ..
        } = light.emitter
        {
            let area = Vec3::from(edge_x).cross(Vec3::from(edge_y)).length();
            light.emitter = Emitter::Point {
                position: center,
                intensity: radiance.map(|r| r * area),
                radius: 0.0,
            };
            light.shadow = shadow_fit::fit(shot_frame.tracer.geometry(), &light.emitter);
            extra.map_size = [HARD_MAP; 2];
        }
    }
    shot_frame
}
