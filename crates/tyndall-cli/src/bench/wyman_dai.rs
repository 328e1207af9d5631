//! Wyman and Dai 2013: samples of an area light one by one and all at once, stage by stage; several scenes; and the cost
//! against one hard shadow volume.

use std::time::Duration;

use glam::Vec3;
use tyndall::{
    frame::{Emitter, Light},
    techniques::{Technique, Value},
};
use tyndall_scene::shadow_fit;

use super::{
    Bench, Report,
    subject::{Subject, sphere},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{Budget, Stage, Timing},
    progress::Stages,
    setup::Setup,
};

/// What is measured.
pub(super) struct AreaLights {
    /// The scene of table 1 comes first.
    pub(super) scenes: &'static [Subject],
    /// Width and height of the pictures [pixels].
    pub(super) size: [u32; 2],
    /// Samples of the light, table by table row; the last is that of the other tables.
    pub(super) samples: &'static [u32],
}

/// Texels a side of a sample's map, and voxels of its grid.
const RESOLUTION: u32 = 128;
/// Voxels a side of a hard shadow volume, and texels a face of its shadow map.
const HARD: i64 = 512;
const HARD_MAP: u32 = 1024;

const BUDGET: Budget = Budget {
    frames: 5,
    warm_up: 1,
    time: Duration::from_secs(15),
};

/// The paper's stages, and the passes of each.
const STAGES: [(&str, &[&str]); 4] = [
    ("maps", &["splat points", "pull-push"]),
    ("voxels", &["voxelize"]),
    ("scan", &["scan"]),
    ("gather", &["gather", "resolve"]),
];

const STEPS: [&str; 19] = [
    "samples",
    "maps, naive ms",
    "batched",
    "ratio",
    "voxels, naive ms",
    "batched",
    "ratio",
    "scan, naive ms",
    "batched",
    "ratio",
    "gather, naive ms",
    "batched",
    "ratio",
    "frame, naive ms",
    "batched",
    "ratio",
    "wall ratio",
    "passes, naive",
    "batched",
];

const SCENES: [&str; 9] = [
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

/// Measures the suite.
pub(super) fn run(
    suite: &AreaLights,
    bench: &Bench,
    stages: &mut Stages,
) -> Result<Report, Failure> {
    let most = suite.samples.last().copied().unwrap_or(1);
    let mut tables = Vec::new();
    let mut scenes = Vec::new();
    for (i, subject) in suite.scenes.iter().enumerate() {
        let (setup, what) =
            subject.load(bench.assets.as_deref(), suite.size, RESOLUTION, stages)?;
        let title = format!("{} ({what})", subject.name);
        let setup = with_samples(setup, most);
        if i == 0 {
            tables.extend(steps(&title, &setup, suite, bench, stages)?);
            tables.push(costs(&title, &setup, bench, stages)?);
        }
        scenes.push(scene(&title, &setup, bench, stages)?);
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
    })
}

fn ivsv(gather: &str, batched: bool) -> Result<Technique, Failure> {
    let params = [
        ("gather", Value::Word(gather.to_owned())),
        ("batched", Value::Bool(batched)),
    ];
    technique("ivsv", &params)
}

fn technique(name: &str, params: &[(&str, Value)]) -> Result<Technique, Failure> {
    let missing = || Failure::Input(anyhow::anyhow!("there is no technique {name}"));
    let mut technique = Technique::from_name(name).ok_or_else(missing)?;
    for (key, value) in params {
        technique.set(key, value).map_err(Failure::input)?;
    }
    Ok(technique)
}

/// The scene with its first light a rectangle of so many samples: its own, or a panel above it.
fn with_samples(mut setup: Setup, count: u32) -> Setup {
    let (center, radius) = sphere(&setup);
    let above = center + 1.1 * radius * Vec3::Y;
    let Some(Light {
        emitter, shadow, ..
    }) = setup.frame.lights.first_mut()
    else {
        return setup;
    };
    if let Emitter::Rect { samples, .. } = emitter {
        *samples = count;
        return setup;
    }
    *shadow = None;
    *emitter = Emitter::Rect {
        center: above.to_array(),
        edge_x: [0.6 * radius, 0.0, 0.0],
        edge_y: [0.0, 0.0, 0.4 * radius],
        radiance: [12.0, 11.0, 9.0],
        samples: count,
    };
    setup.frame.lights.truncate(1);
    setup.lights.truncate(1);
    for light in &mut setup.lights {
        light.map_size = [RESOLUTION; 2];
    }
    setup
}

/// Median of the passes of a stage [ms].
fn of_stage(timing: &Timing, passes: &[&str]) -> f64 {
    let is_of = |name: &str| passes.iter().any(|pass| name.starts_with(pass));
    let of_stage = timing.passes.iter().filter(|(name, _)| is_of(name));
    of_stage.map(|(_, spread)| spread.median).sum()
}

/// A number of a technique's counts whose name starts so.
fn counted(stage: &Stage<'_>, technique: &Technique, name: &str) -> Result<u64, Failure> {
    let counts = stage.counts(technique)?;
    let of_name = counts.iter().find(|(count, _)| count.starts_with(name));
    Ok(of_name.map_or(0, |(_, count)| *count))
}

/// Table 1, and what a pass costs by itself.
fn steps(
    title: &str,
    setup: &Setup,
    suite: &AreaLights,
    bench: &Bench,
    stages: &mut Stages,
) -> Result<[Table; 2], Failure> {
    let mut rows = Vec::new();
    let mut batched = Vec::new();
    for count in suite.samples {
        let setup = with_samples(setup.clone(), *count);
        let stage = Stage::new(&setup, &bench.backend, stages)?;
        let techniques = [ivsv("full", false)?, ivsv("full", true)?];
        let timings = stages.run(&format!("time {count} samples"), |_| {
            stage.time(&techniques, &BUDGET)
        })?;
        let [(_, naive), (_, at_once)] = &timings.techniques[..] else {
            return Ok([super::paper::nothing(title), super::paper::nothing(title)]);
        };
        let mut row = vec![Cell::Count((*count).into())];
        let mut pair = |naive: f64, at_once: f64| {
            row.extend([naive, at_once, naive / at_once].map(Cell::Number));
        };
        for (_, passes) in STAGES {
            pair(of_stage(naive, passes), of_stage(at_once, passes));
        }
        pair(naive.total().median, at_once.total().median);
        row.push(Cell::Number(naive.wall.median / at_once.wall.median));
        for technique in &techniques {
            row.push(Cell::Count(counted(&stage, technique, "passes")?));
        }
        rows.push(row);
        let times = STAGES.map(|(_, passes)| [naive, at_once].map(|t| of_stage(t, passes)));
        batched.push((*count, times));
    }
    let [width, height] = suite.size;
    Ok([
        Table {
            title: format!("table 1: {title}"),
            notes: vec![format!(
                "{width} x {height} pixels, {RESOLUTION}^3 voxels a sample; naive: one set of passes a sample"
            )],
            columns: STEPS.to_vec(),
            rows,
        },
        overheads(&batched),
    ])
}

/// What of the naive form's time is work that batches do too, and how much larger the rest would have to be for the
/// paper's ratios.
fn overheads(batched: &[(u32, [[f64; 2]; 4])]) -> Table {
    /// The paper's ratios of 256 samples.
    const PAPER: [f64; 4] = [18.6, 16.6, 25.8, 2.0];
    let rows = batched.last().map(|(count, times)| {
        let row = |((name, _), (paper, [naive, at_once])): ((&str, _), (f64, [f64; 2]))| {
            let [a_pass, work] = [naive, at_once].map(|ms| ms / f64::from(*count));
            let needed = (paper - 1.0) * work;
            vec![
                Cell::text(name),
                Cell::Number(1e3 * work),
                Cell::Number(1e3 * (a_pass - work).max(0.0)),
                Cell::Number(1e3 * needed),
                Cell::Number(paper),
            ]
        };
        STAGES
            .into_iter()
            .zip(PAPER.into_iter().zip(*times))
            .map(row)
            .collect()
    });
    Table {
        title: "why: work and overhead of a sample".to_owned(),
        notes: vec![
            "a ratio r needs passes whose overhead is r - 1 times a sample's work in them; a device that draws hundreds of samples at once has little of the one, a software driver little of the other".to_owned(),
        ],
        columns: vec![
            "stage",
            "work of a sample us",
            "overhead of its pass us",
            "overhead that the paper's ratio takes us",
            "paper's ratio",
        ],
        rows: rows.unwrap_or_default(),
    }
}

/// A row of table 2.
fn scene(
    title: &str,
    setup: &Setup,
    bench: &Bench,
    stages: &mut Stages,
) -> Result<Vec<Cell>, Failure> {
    let stage = Stage::new(setup, &bench.backend, stages)?;
    let techniques = [
        ivsv("full", true)?,
        ivsv("interleaved", true)?,
        ivsv("quarter", true)?,
        ivsv("full", false)?,
    ];
    let timings = stages.run(&format!("time {title}"), |_| {
        stage.time(&techniques, &BUDGET)
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

/// Many soft samples against one hard shadow volume of a lamp in the light's middle.
fn costs(title: &str, setup: &Setup, bench: &Bench, stages: &mut Stages) -> Result<Table, Failure> {
    let hard = [technique("vsv", &[("resolution", Value::Integer(HARD))])?];
    let soft = [
        ivsv("interleaved", true)?,
        ivsv("quarter", true)?,
        ivsv("full", true)?,
    ];
    let samples = setup.frame.lights.iter().map(|light| match light.emitter {
        Emitter::Rect { samples, .. } => samples,
        _ => 1,
    });
    let samples: u32 = samples.sum();
    let lamp = with_lamp(setup.clone());
    let mut rows = Vec::new();
    let mut of_hard = 0.0;
    let measured = [
        (&lamp, &hard[..], HARD as u64, 1),
        (setup, &soft[..], RESOLUTION.into(), u64::from(samples)),
    ];
    for (setup, techniques, side, grids) in measured {
        let stage = Stage::new(setup, &bench.backend, stages)?;
        let timings = stages.run(&format!("time {title}, {side}^3"), |_| {
            stage.time(techniques, &BUDGET)
        })?;
        for (technique, timing) in &timings.techniques {
            let ms = timing.total().median;
            if of_hard == 0.0 {
                of_hard = ms;
            }
            rows.push(vec![
                Cell::text(label(technique)),
                timing.total().into(),
                Cell::Number(ms / of_hard),
                timing.wall.into(),
                Cell::Count(timing.passes.len() as u64),
                Cell::Count(side * side * grids),
                Cell::mebibytes(Some(side.pow(3) / 8 * grids)),
                Cell::mebibytes(timing.bytes),
            ]);
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

fn label(technique: &Technique) -> String {
    let gather = technique.params().into_iter().find(|p| p.key == "gather");
    let name = technique.info().name;
    gather.map_or(name.to_owned(), |gather| format!("{name} {}", gather.value))
}

/// A lamp in the middle of the rectangle, as strong as it is along its normal.
fn with_lamp(mut setup: Setup) -> Setup {
    for (light, extra) in setup.frame.lights.iter_mut().zip(&mut setup.lights) {
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
            };
            light.shadow = shadow_fit::fit(setup.tracer.geometry(), &light.emitter);
            extra.map_size = [HARD_MAP; 2];
        }
    }
    setup
}
