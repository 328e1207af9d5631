//! Lin 2012, table 6.1: `hybrid` with and without temporal reuse while things move, and what each mask leaves stale.

use tyndall::temporal::{Reuse, ReuseMask};

use super::{
    Bench, Report, paper,
    subject::{self, Subject},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{Film, TakeFrame},
    progress::Stages,
    render::Backend,
    sequence::Sequence,
    shot::FrameRange,
};

/// What is measured.
pub(super) struct Films {
    pub(super) scenes: &'static [(Subject, &'static str)],
    /// Width and height of the picture [pixels], and the side of the shadow map [texels].
    pub(super) size: [u32; 2],
    pub(super) map: u32,
    /// Frames that are timed.
    pub(super) timed: u32,
    /// The same of what is compared pixel by pixel.
    pub(super) compared_size: [u32; 2],
    pub(super) compared: u32,
}

/// The thesis's scenes, and its frames a second with reuse over those without.
pub(super) const SCENES: &[(Subject, &str)] = &[
    (subject::DRAGON, "1.31"),
    (subject::BUNNY, "1.34"),
    (subject::BUDDHA, "1.41"),
    (subject::DONUTS, "0.95"),
    (subject::BIG_SCENE, "1.10"),
    (subject::YEAH_RIGHT, "1.10"),
];

/// What reuse is timed about: the thesis's technique, as the shots have it, and brute force.
const TIMED: [(&str, &[&str]); 2] = [
    ("hybrid, 1024 steps", &[]),
    (
        "ray-march, 256 steps",
        &["technique={name='ray-march',steps=256}"],
    ),
];
/// The shots' frames.
const FRAMES: FrameRange = FrameRange { first: 0, last: 59 };
/// Frames in a row that the thesis keeps.
const KEPT: u32 = 3;
/// Who walks: brute force, and what is the fastest at exact pictures.
const WALKERS: [&str; 2] = ["ray-march", "min-max"];
/// The eye's way from frame to frame [mm].
const STEPS: [f64; 2] = [2.0, 10.0];
/// The camera's turn from frame to frame [degrees].
const TURN: f64 = 0.05;
/// What may be wrong with a pixel that is kept as it walks.
const TOLERANCES: [f32; 2] = [0.02, 0.1];

/// Measures the suite.
pub(super) fn run(films: &Films, bench: &Bench, stages: &mut Stages) -> Result<Report, Failure> {
    let mut times = TIMED.map(|_| Vec::new());
    let mut left = Vec::new();
    let mut walks = Vec::new();
    if matches!(bench.backend, Backend::Gpu(_)) {
        for ((technique, values), rows) in TIMED.iter().zip(&mut times) {
            for (scene, thesis) in films.scenes {
                let what = format!("time {technique}, {}", scene.name);
                rows.push(stages.run(&what, |progress| {
                    time(films, scene, values, thesis, bench, progress)
                })?);
            }
        }
        let scene = subject::DONUTS;
        left = stages.run(&format!("compare {}", scene.name), |progress| {
            compare(films, &scene, bench, progress)
        })?;
        for technique in WALKERS {
            walks.extend(stages.run(&format!("walk by {technique}"), |progress| {
                walk(films, technique, bench, progress)
            })?);
        }
    }
    if times.iter().all(Vec::is_empty) {
        return Ok(Report {
            tables: vec![paper::nothing("temporal reuse")],
            missing: Vec::new(),
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
    })
}

fn times_table(films: &Films, technique: &str, rows: Vec<Vec<Cell>>) -> Table {
    let ([width, height], map, timed) = (films.size, films.map, films.timed);
    Table {
        title: format!("temporal reuse about {technique}"),
        notes: vec![
            format!(
                "{width} x {height} pixels, {map}^2 shadow map; {timed} frames of 60 in a row, those of all three in turn; means of a frame, of the effect's passes alone"
            ),
            "covered: share of the pixels that were computed".to_owned(),
            format!(
                "change: pixels that see a change of depth or shadow map, any number of frames; geometry: the thesis's mask, a full frame every {}",
                KEPT + 1
            ),
        ],
        columns: vec![
            "scene",
            "of",
            "without ms",
            "change: covered",
            "ms",
            "speed-up",
            "geometry: covered",
            "ms ",
            "speed-up ",
            "the thesis's, about hybrid",
        ],
        rows,
    }
}

fn left_table(films: &Films, rows: Vec<Vec<Cell>>) -> Table {
    let ([width, height], compared) = (films.compared_size, films.compared);
    Table {
        title: format!("what is left stale, {}", subject::DONUTS.name),
        notes: vec![
            format!(
                "{width} x {height} pixels, {compared} frames, each against the frame computed from nothing, bit by bit"
            ),
            "largest error: of a channel of a pixel, over the mean of the picture".to_owned(),
        ],
        columns: vec![
            "mask",
            "covered",
            "stale pixels",
            "most in a frame",
            "frames with any",
            "largest error",
        ],
        rows,
    }
}

fn walks_table(films: &Films, rows: Vec<Vec<Cell>>) -> Table {
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

/// Reuse with this mask and limit.
fn reuse(mask: ReuseMask, frames: Option<u32>) -> Option<Reuse> {
    Some(Reuse {
        mask,
        frames,
        ..Reuse::default()
    })
}

/// The shot of a scene as a film, with these values set, and what it is of. A scene that is missing doesn't move: another one
/// stands in.
fn film<'a>(
    scene: &Subject,
    values: &[&str],
    size: [u32; 2],
    map: u32,
    takes: &[Option<Reuse>],
    bench: &'a Bench,
) -> Result<Option<(Film<'a>, String)>, Failure> {
    let Backend::Gpu(gpu) = &bench.backend else {
        return Ok(None);
    };
    let assets = bench.assets.as_deref();
    let (mut shot, mut what) = scene.shot_with(values, assets, size, map)?;
    if shot.animation.is_none() {
        (shot, what) = subject::YEAH_RIGHT.shot_with(values, assets, size, map)?;
        what += " in its place";
    }
    let sequence = Sequence::new(&shot, FRAMES, &mut Stages::quiet())?;
    Ok(Some((Film::new(sequence, takes, gpu)?, what)))
}

fn time(
    films: &Films,
    scene: &Subject,
    values: &[&str],
    thesis: &str,
    bench: &Bench,
    progress: &dyn Fn(u64, u64),
) -> Result<Vec<Cell>, Failure> {
    let takes = [
        None,
        reuse(ReuseMask::Change, None),
        reuse(ReuseMask::Geometry, Some(KEPT)),
    ];
    let Some((mut film, what)) = film(scene, values, films.size, films.map, &takes, bench)? else {
        return Ok(Vec::new());
    };
    // Pipelines are made with the first frame.
    film.frame(0)?;
    let mut sums = [TakeFrame::default(); 3];
    for number in 1..=films.timed {
        for (sum, frame) in sums.iter_mut().zip(film.frame(number)?) {
            sum.milliseconds += frame.milliseconds / f64::from(films.timed);
            sum.computed += frame.computed / f64::from(films.timed);
        }
        progress(number.into(), films.timed.into());
    }
    let [plain, change, geometry] = sums;
    let mut cells = vec![
        Cell::text(scene.name),
        Cell::text(what),
        plain.milliseconds.into(),
    ];
    for take in [change, geometry] {
        cells.extend([
            take.computed.into(),
            take.milliseconds.into(),
            (plain.milliseconds / take.milliseconds).into(),
        ]);
    }
    cells.push(Cell::text(thesis));
    Ok(cells)
}

/// Frames of a camera that walks, with several tolerances: what is computed, how long it takes and what is wrong.
fn walk(
    films: &Films,
    technique: &str,
    bench: &Bench,
    progress: &dyn Fn(u64, u64),
) -> Result<Vec<Vec<Cell>>, Failure> {
    let Backend::Gpu(gpu) = &bench.backend else {
        return Ok(Vec::new());
    };
    let mut rows = Vec::new();
    for (k, step) in STEPS.into_iter().enumerate() {
        let last = f64::from(FRAMES.last);
        let [way, turn] = [step * 1e-3, TURN].map(|of_a_frame| of_a_frame * last);
        let movement = format!(
            "animation.move=[{{node='camera',translate=[[0,0,0],[{way},0,0]],rotate_deg=[[0,0,0],[0,{turn},0]]}}]"
        );
        let by = format!("technique={{name='{technique}'}}");
        let values = [by.as_str(), "animation.fps=30", &movement];
        let (size, assets) = (films.compared_size, bench.assets.as_deref());
        let (shot, what) = subject::BIG_SCENE.shot_with(&values, assets, size, films.map)?;
        let within = |tolerance: f32| {
            Some(Reuse {
                reproject: Some(tolerance),
                ..Reuse::default()
            })
        };
        let takes: Vec<Option<Reuse>> = std::iter::once(None)
            .chain(TOLERANCES.map(within))
            .collect();
        let sequence = Sequence::new(&shot, FRAMES, &mut Stages::quiet())?;
        let mut film = Film::new(sequence, &takes, gpu)?;
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
            progress(done, STEPS.len() as u64 * u64::from(films.compared));
        }
        let [whole, kept @ ..] = walks;
        rows.extend(TOLERANCES.iter().zip(kept).map(|(tolerance, walk)| {
            vec![
                Cell::text(technique),
                Cell::text(what.as_str()),
                step.into(),
                f64::from(*tolerance).into(),
                walk.computed.into(),
                whole.milliseconds.into(),
                walk.milliseconds.into(),
                (whole.milliseconds / walk.milliseconds).into(),
                walk.error.into(),
            ]
        }));
    }
    Ok(rows)
}

/// What a take of a walk came to.
#[derive(Clone, Copy, Default)]
struct Walk {
    computed: f64,
    milliseconds: f64,
    error: f64,
}

impl Walk {
    fn add(&mut self, frame: &TakeFrame, kept: &[f32], whole: &[f32], frames: u32) {
        self.computed += frame.computed / f64::from(frames);
        self.milliseconds += frame.milliseconds / f64::from(frames);
        let light = |pixels: &[f32]| -> Vec<f64> {
            let (pixels, _) = pixels.as_chunks::<4>();
            pixels
                .iter()
                .flat_map(|p| [p[0], p[1], p[2]].map(f64::from))
                .collect()
        };
        let (kept, whole) = (light(kept), light(whole));
        let wrong: f64 = kept.iter().zip(&whole).map(|(a, b)| (a - b).abs()).sum();
        self.error = self
            .error
            .max(wrong / whole.iter().sum::<f64>().max(f64::MIN_POSITIVE));
    }
}

/// Pixels of a take that differ from the frame computed from nothing.
#[derive(Clone, Copy, Default)]
struct Left {
    covered: f64,
    stale: u64,
    most: u64,
    frames: u64,
    error: f64,
}

impl Left {
    fn add(&mut self, kept: &[f32], fresh: &[f32]) {
        let (kept, _) = kept.as_chunks::<4>();
        let (fresh, _) = fresh.as_chunks::<4>();
        let light = |pixel: &[f32; 4]| [pixel[0], pixel[1], pixel[2]].map(f64::from);
        let mean = fresh.iter().flat_map(light).sum::<f64>() / (3 * fresh.len().max(1)) as f64;
        let differ = |(a, b): &(&[f32; 4], &[f32; 4])| a.map(f32::to_bits) != b.map(f32::to_bits);
        let stale: Vec<_> = kept.iter().zip(fresh).filter(differ).collect();
        let errors = stale.iter().flat_map(|(a, b)| {
            let (a, b) = (light(a), light(b));
            [0, 1, 2].map(|k| (a[k] - b[k]).abs())
        });
        self.error = errors.fold(self.error, |most, error| most.max(error / mean));
        self.stale += stale.len() as u64;
        self.most = self.most.max(stale.len() as u64);
        self.frames += u64::from(!stale.is_empty());
    }
}

fn compare(
    films: &Films,
    scene: &Subject,
    bench: &Bench,
    progress: &dyn Fn(u64, u64),
) -> Result<Vec<Vec<Cell>>, Failure> {
    let masks = [
        ("change", reuse(ReuseMask::Change, None)),
        (
            "geometry, full every 4",
            reuse(ReuseMask::Geometry, Some(KEPT)),
        ),
        ("geometry", reuse(ReuseMask::Geometry, None)),
    ];
    let takes: Vec<Option<Reuse>> = std::iter::once(None).chain(masks.map(|m| m.1)).collect();
    let size = films.compared_size;
    let Some((mut film, _)) = film(scene, &[], size, films.map, &takes, bench)? else {
        return Ok(Vec::new());
    };
    let mut left = [Left::default(); 3];
    for number in 0..films.compared {
        let frames = film.frame(number)?;
        let outputs = film.outputs()?;
        for (k, left) in left.iter_mut().enumerate() {
            left.add(&outputs[k + 1], &outputs[0]);
            left.covered += frames[k + 1].computed / f64::from(films.compared);
        }
        progress(u64::from(number) + 1, films.compared.into());
    }
    let row = |((name, _), left): (&(&str, _), &Left)| {
        vec![
            Cell::text(*name),
            left.covered.into(),
            Cell::Count(left.stale),
            Cell::Count(left.most),
            Cell::Count(left.frames),
            left.error.into(),
        ]
    };
    Ok(masks.iter().zip(&left).map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_counted_bit_by_bit() {
        let fresh = [1.0, 2.0, 3.0, 0.5, 1.0, 2.0, 3.0, 0.5];
        let mut kept = fresh;
        let mut left = Left::default();
        left.add(&kept, &fresh);
        assert_eq!((left.stale, left.frames, left.error), (0, 0, 0.0));
        kept[5] = 3.0;
        left.add(&kept, &fresh);
        left.add(&kept, &fresh);
        assert_eq!((left.stale, left.most, left.frames), (2, 1, 2));
        assert_eq!(left.error, 0.5);
        kept[5] = 2.0_f32.next_up();
        let mut left = Left::default();
        left.add(&kept, &fresh);
        assert_eq!(left.stale, 1);
    }
}
