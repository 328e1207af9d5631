//! Frames of a camera that walks, whose pixels are reprojected.

use tyndall::temporal::Reuse;

use super::films::{FRAMES, Films};
use crate::{
    backend::{Backend, Gpu},
    bench::{
        report::Bench,
        subject,
        table::{Cell, Table},
    },
    failure::Failure,
    load::LoadedShot,
    measure::{Film, TakeFrame},
    progress::Progress,
};

/// Techniques that a camera walks by: brute force, and the fastest at exact pictures.
pub(super) const WALKERS: [&str; 2] = ["ray-march", "min-max"];
/// Distance of the eye from frame to frame \[mm].
const STEPS: [f64; 2] = [2.0, 10.0];
/// The camera's turn from frame to frame \[degrees].
const TURN: f64 = 0.05;
/// Errors that a pixel may be kept with as the camera walks.
const TOLERANCES: [f32; 2] = [0.02, 0.1];

/// Frames of a camera that walks, with several tolerances: the share that is computed, the time and the error.
pub(super) fn walk(
    films: &Films,
    technique: &str,
    bench: &Bench,
    report: &dyn Fn(u64, u64),
) -> Result<Vec<Vec<Cell>>, Failure> {
    let Backend::Gpu(gpu) = &bench.backend else {
        return Ok(Vec::new());
    };
    let mut rows = Vec::new();
    for (k, step) in STEPS.into_iter().enumerate() {
        let (mut film, subject) = walking(films, technique, step, bench, gpu)?;
        // Pipelines are made with the first frames.
        film.frame(0)?;
        film.frame(1)?;
        let mut walks = [Walk::default(); 1 + TOLERANCES.len()];
        for number in 2..films.compared {
            let frames = film.frame(number)?;
            let outputs = film.outputs()?;
            for (walk, (frame, output)) in walks.iter_mut().zip(frames.iter().zip(&outputs)) {
                walk.add(frame, output, &outputs[0], films.compared - 2);
            }
            let done = k as u64 * u64::from(films.compared) + u64::from(number) + 1;
            report(done, STEPS.len() as u64 * u64::from(films.compared));
        }
        let [full, kept @ ..] = walks;
        rows.extend(TOLERANCES.iter().zip(kept).map(|(tolerance, walk)| {
            vec![
                Cell::text(technique),
                Cell::text(subject.as_str()),
                step.into(),
                f64::from(*tolerance).into(),
                walk.computed.into(),
                full.milliseconds.into(),
                walk.milliseconds.into(),
                (full.milliseconds / walk.milliseconds).into(),
                walk.error.into(),
            ]
        }));
    }
    Ok(rows)
}

/// The film of a camera that goes `step` a frame \[mm], without reuse first, then with every tolerance; and its subject.
fn walking<'a>(
    films: &Films,
    technique: &str,
    step: f64,
    bench: &Bench,
    gpu: &'a Gpu,
) -> Result<(Film<'a>, String), Failure> {
    let last = f64::from(FRAMES.last);
    let [distance, turn] = [step * 1e-3, TURN].map(|of_a_frame| of_a_frame * last);
    let movement = format!(
        "animation.move=[{{node='camera',translate=[[0,0,0],[{distance},0,0]],rotate_deg=[[0,0,0],[0,{turn},0]]}}]"
    );
    let by = format!("technique={{name='{technique}'}}");
    let values = [by.as_str(), "animation.fps=30", &movement];
    let (size, assets) = (films.compared_size, bench.assets.as_deref());
    let (shot, subject) = subject::BIG_SCENE.shot_with(&values, assets, size, films.map)?;
    let within = |tolerance: f32| {
        Some(Reuse {
            reproject: Some(tolerance),
            ..Reuse::default()
        })
    };
    let takes: Vec<Option<Reuse>> = std::iter::once(None)
        .chain(TOLERANCES.map(within))
        .collect();
    let loaded = LoadedShot::moving(&shot, FRAMES, &mut Progress::quiet())?;
    Ok((Film::new(loaded, &takes, gpu)?, subject))
}

/// Means of a take's frames, and the largest of their errors.
#[derive(Clone, Copy, Default)]
struct Walk {
    computed: f64,
    milliseconds: f64,
    error: f64,
}

impl Walk {
    fn add(&mut self, frame: &TakeFrame, kept: &[f32], full: &[f32], frames: u32) {
        self.computed += frame.computed / f64::from(frames);
        self.milliseconds += frame.milliseconds / f64::from(frames);
        let light = |pixels: &[f32]| -> Vec<f64> {
            let (pixels, _) = pixels.as_chunks::<4>();
            pixels
                .iter()
                .flat_map(|p| [p[0], p[1], p[2]].map(f64::from))
                .collect()
        };
        let (kept, full) = (light(kept), light(full));
        let wrong: f64 = kept.iter().zip(&full).map(|(a, b)| (a - b).abs()).sum();
        self.error = self
            .error
            .max(wrong / full.iter().sum::<f64>().max(f64::MIN_POSITIVE));
    }
}

/// The table of the walks.
pub(super) fn walks_table(films: &Films, rows: Vec<Vec<Cell>>) -> Table {
    let ([width, height], map, compared) = (films.compared_size, films.map, films.compared);
    Table {
        title: format!("a camera that walks by {}", subject::BIG_SCENE.name),
        notes: vec![
            format!(
                "{width} x {height} pixels, {map}^2 shadow map; {compared} frames in a row, those of all tolerances in turn; means of a frame, of the effect's passes alone"
            ),
            format!("step: of the eye from frame to frame [mm]; it turns by {TURN} degrees besides"),
            "tolerance: of a pixel's error; error: of the worst frame against the one computed whole, mean over mean"
                .to_owned(),
        ],
        columns: vec![
            "technique",
            "of",
            "step",
            "tolerance",
            "computed",
            "whole ms",
            "ms",
            "speed-up",
            "error",
        ],
        rows,
    }
}
