//! Growth of time and memory: one quantity varied at a time, and the power law that fits.

use std::{sync::Arc, time::Duration};

use glam::Vec3;
use tyndall::techniques::{Technique, Value};
use tyndall_scene::{
    scene::{Primitive, Scene},
    trace::Tracer,
};

use super::{
    fit::PowerLaw,
    report::{Bench, Report},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    load::{LoadedShot, ShotFrame, built},
    measure::{Budget, DrawnFrame, Timing},
    progress::Progress,
    shot::Shot,
};

/// The shot that one quantity after the other is varied on.
const SCENE: &str = "builtin:church";
const SIZE: [u32; 2] = [160, 120];
const MAP: u32 = 1024;

/// Widths of pictures of 4:3 \[pixels].
const WIDTHS: [u32; 5] = [80, 160, 240, 320, 480];
/// Sides of shadow maps \[texels].
const MAPS: [u32; 5] = [256, 512, 1024, 2048, 4096];
/// Numbers of times that every triangle is cut in four.
const SUBDIVISIONS: [u32; 3] = [0, 1, 2];
/// Whole-number parameters that say how fine a technique works, and their values.
const FINENESS: [&str; 6] = ["steps", "slices", "samples", "resolution", "vpls", "points"];
const FINENESS_VALUES: [i64; 5] = [64, 128, 256, 512, 1024];

const BUDGET: Budget = Budget {
    frames: 10,
    warm_up: 1,
    time: Duration::from_secs(4),
};

/// A measurement at one value of a quantity.
struct Point {
    technique: &'static str,
    quantity: String,
    value: f64,
    timing: Timing,
}

/// Measures every technique on the table.
pub(super) fn run(bench: &Bench, progress: &mut Progress) -> Result<Report, Failure> {
    let base = base(progress)?;
    let mut points = Vec::new();
    for width in WIDTHS {
        let mut shot_frame = base.clone();
        shot_frame.size = [width, width * SIZE[1] / SIZE[0]];
        let pixels = f64::from(shot_frame.size[0] * shot_frame.size[1]);
        points.extend(all(&shot_frame, bench, ("pixels", pixels), progress)?);
    }
    for side in MAPS {
        let mut shot_frame = base.clone();
        shot_frame
            .lights
            .iter_mut()
            .for_each(|light| light.map_size = [side; 2]);
        let texels = f64::from(side).powi(2);
        points.extend(all(
            &shot_frame,
            bench,
            ("shadow-map texels", texels),
            progress,
        )?);
    }
    for times in SUBDIVISIONS {
        let shot_frame = subdivided(&base, times);
        let triangles = shot_frame.tracer.geometry().len() as f64;
        points.extend(all(&shot_frame, bench, ("triangles", triangles), progress)?);
    }
    points.extend(fineness(&base, bench, progress)?);
    Ok(Report {
        tables: vec![exponents(&points), measured(&points)],
        missing: Vec::new(),
        faults: Vec::new(),
    })
}

fn base(progress: &mut Progress) -> Result<ShotFrame, Failure> {
    let mut shot = Shot::load(SCENE.as_ref(), None, &[]).map_err(Failure::input)?;
    shot.size = SIZE;
    let mut shot_frame = LoadedShot::at_rest(&shot, progress)?.frame(0)?;
    shot_frame
        .lights
        .iter_mut()
        .for_each(|light| light.map_size = [MAP; 2]);
    Ok(shot_frame)
}

/// Times every technique that can do the shot, with its own defaults.
fn all(
    shot_frame: &ShotFrame,
    bench: &Bench,
    (quantity, value): (&str, f64),
    progress: &mut Progress,
) -> Result<Vec<Point>, Failure> {
    let drawn = DrawnFrame::new(shot_frame, &bench.backend, progress)?;
    let techniques = drawn.techniques();
    let timings = progress.run(&format!("{quantity} = {value}"), |_| {
        drawn.time(&techniques, &BUDGET)
    })?;
    let point = |(technique, timing): (Technique, Timing)| Point {
        technique: technique.info().name,
        quantity: quantity.to_owned(),
        value,
        timing,
    };
    Ok(timings.techniques.into_iter().map(point).collect())
}

/// Times every technique at several values of each parameter that says how fine it works.
fn fineness(
    shot_frame: &ShotFrame,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Vec<Point>, Failure> {
    let drawn = DrawnFrame::new(shot_frame, &bench.backend, progress)?;
    let mut points = Vec::new();
    for technique in drawn.techniques() {
        for param in technique.params() {
            if !FINENESS.contains(&param.key) || !matches!(param.value, Value::Integer(_)) {
                continue;
            }
            let varied: Vec<(f64, Technique)> = FINENESS_VALUES
                .iter()
                .filter_map(|value| {
                    let mut varied = technique.clone();
                    varied.set(param.key, &Value::Integer(*value)).ok()?;
                    Some((*value as f64, varied))
                })
                .collect();
            let techniques: Vec<Technique> = varied.iter().map(|v| v.1.clone()).collect();
            let name = technique.info().name;
            let timings = progress.run(&format!("{name}, {}", param.key), |_| {
                drawn.time(&techniques, &BUDGET)
            })?;
            points.extend(
                varied
                    .iter()
                    .zip(timings.techniques)
                    .map(|((value, _), timed)| Point {
                        technique: name,
                        quantity: param.key.to_owned(),
                        value: *value,
                        timing: timed.1,
                    }),
            );
        }
    }
    Ok(points)
}

/// Cuts every triangle in four, so many times; the surfaces stay.
fn subdivided(shot_frame: &ShotFrame, times: u32) -> ShotFrame {
    let mut scene = Scene::clone(&shot_frame.scene);
    for primitive in scene
        .meshes
        .iter_mut()
        .flat_map(|mesh| &mut mesh.primitives)
    {
        for _ in 0..times {
            *primitive = subdivide(primitive);
        }
    }
    ShotFrame {
        tracer: Arc::new(built(Tracer::new(&scene))),
        scene: Arc::new(scene),
        ..shot_frame.clone()
    }
}

/// Cuts every triangle in four at the middles of its edges.
fn subdivide(primitive: &Primitive) -> Primitive {
    /// Corners, then the middles of the edges that begin at them.
    const QUARTERS: [[u32; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
    let mut finer = Primitive {
        material: primitive.material,
        ..Primitive::default()
    };
    let (triangles, _) = primitive.indices.as_chunks::<3>();
    for triangle in triangles {
        let first = finer.positions.len() as u32;
        let [a, b, c] = triangle.map(|index| index as usize);
        for [a, b] in [[a, a], [b, b], [c, c], [a, b], [b, c], [c, a]] {
            let (positions, normals, uvs) =
                (&primitive.positions, &primitive.normals, &primitive.uvs);
            finer.positions.push(positions[a].midpoint(positions[b]));
            finer
                .normals
                .push((normals[a] + normals[b]).normalize_or(Vec3::Y));
            finer.uvs.push(uvs[a].midpoint(uvs[b]));
        }
        finer
            .indices
            .extend(QUARTERS.as_flattened().iter().map(|corner| first + corner));
    }
    finer
}

fn exponents(points: &[Point]) -> Table {
    let mut sorted: Vec<&Point> = points.iter().collect();
    sorted.sort_by_key(|point| (point.technique, point.quantity.clone()));
    let law = |series: &[&Point], of: &dyn Fn(&Point) -> Option<f64>| {
        let points: Option<Vec<_>> = series.iter().map(|p| Some((p.value, of(p)?))).collect();
        let law = points.and_then(|points| PowerLaw::fit(&points));
        law.map_or(Cell::Empty, |law| Cell::Text(law.to_string()))
    };
    let row = |series: &[&Point]| {
        vec![
            Cell::text(series[0].technique),
            Cell::text(&series[0].quantity),
            Cell::Number(series[0].value),
            Cell::Number(series[series.len() - 1].value),
            law(series, &|point| Some(point.timing.total().median)),
            law(series, &|point| {
                point.timing.bytes.map(|bytes| bytes as f64)
            }),
        ]
    };
    let rows = sorted.chunk_by(|a, b| (a.technique, &a.quantity) == (b.technique, &b.quantity));
    Table {
        title: "exponents: y ~ x^e, least squares of logarithms, with the standard error of e"
            .to_owned(),
        notes: vec![format!(
            "{SCENE}, {} x {} pixels and a {MAP}^2 shadow map, but for what is varied",
            SIZE[0], SIZE[1]
        )],
        columns: vec!["technique", "x", "from", "to", "time", "bytes"],
        rows: rows.map(row).collect(),
    }
}

fn measured(points: &[Point]) -> Table {
    let row = |point: &Point| {
        vec![
            Cell::text(&point.quantity),
            Cell::Number(point.value),
            Cell::text(point.technique),
            Cell::text(point.timing.place.name()),
            point.timing.total().into(),
            Cell::Count(point.timing.frames as u64),
            Cell::mebibytes(point.timing.bytes),
        ]
    };
    Table {
        title: "measured".to_owned(),
        notes: Vec::new(),
        columns: vec!["x", "value", "technique", "on", "ms", "frames", "MiB"],
        rows: points.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use tyndall_scene::builtin;

    use super::*;

    #[test]
    fn subdividing_keeps_the_surface() {
        let scene = builtin::builtin("slats").unwrap();
        let primitive = &scene.meshes[0].primitives[0];
        let finer = subdivide(primitive);
        assert_eq!(finer.indices.len(), 4 * primitive.indices.len());
        let area = |primitive: &Primitive| {
            let (triangles, _) = primitive.indices.as_chunks::<3>();
            let corner = |i: u32| primitive.positions[i as usize];
            let twice = triangles.iter().map(|t| {
                let [a, b, c] = t.map(corner);
                f64::from((b - a).cross(c - a).length())
            });
            twice.sum::<f64>()
        };
        let (before, after) = (area(primitive), area(&finer));
        assert!((after / before - 1.0).abs() < 1e-6, "{before} {after}");
    }
}
