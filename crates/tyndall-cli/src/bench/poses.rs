//! `min-max` from anywhere: cameras at random within a scene and beside it, towards the light and close to it.
//!
//! The technique is exact but for rounding, so that none of its pixels may be as wrong as brute force's worst ones are:
//! at most twice the 99th percentile of the error of 512 steps over all of a scene's pixels. Errors are relative to the
//! mean of their picture.

use glam::{Vec3, vec3};
use tyndall::{
    frame::{Camera, Emitter, Projection},
    techniques::Technique,
};
use tyndall_scene::geometry::Bounds;
use tyndall_testkit::samples::in_box;

use super::{
    Bench, Report,
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    measure::{Place, Stage, Visibility, ray_march},
    picture::Picture,
    progress::Stages,
    setup::Setup,
    shot::{Override, Shot},
};

/// Cameras a scene.
pub(super) const POSES: usize = 500;

const SIZE: &str = "size=[32,24]";
const MAP: &str = "light.0.shadow_map=512";
const STEPS: u32 = 512;
/// How much worse than brute force's 99th percentile a pixel may be.
const FACTOR: f64 = 2.0;

const BUILT_IN: [&str; 3] = ["builtin:church", "builtin:forest", "builtin:terrain"];
const BOX_WALL: &str = "box-wall.glb";
const BOX_WALL_SHOT: &str = include_str!("shots/box-wall.toml");

/// Renders from so many places in every scene.
pub(super) fn run(poses: usize, bench: &Bench, stages: &mut Stages) -> Result<Report, Failure> {
    let mut setups = Vec::new();
    for name in BUILT_IN {
        let shot = Shot::load(name.as_ref(), None, &overrides()?).map_err(Failure::input)?;
        setups.push((name.to_owned(), Setup::new(&shot, stages)?));
    }
    let box_wall = bench.assets.as_ref().map(|folder| folder.join(BOX_WALL));
    let mut notes = vec![format!(
        "{poses} cameras a scene; errors relative to the picture's mean; {STEPS} steps of brute force"
    )];
    match box_wall.filter(|file| file.is_file()) {
        Some(file) => {
            let shot = Shot::of_text(&file.with_extension("toml"), BOX_WALL_SHOT, &overrides()?);
            let setup = Setup::new(&shot.map_err(Failure::input)?, stages)?;
            setups.push((BOX_WALL.to_owned(), setup));
        }
        None => notes.push(format!("skipped: {BOX_WALL} is not among the assets")),
    }
    let mut rows = Vec::new();
    for (name, setup) in &setups {
        let errors = stages.run(&format!("{poses} poses of {name}"), |progress| {
            of_scene(setup, poses, bench, progress)
        })?;
        rows.extend(errors.rows(name));
    }
    Ok(Report {
        tables: vec![Table {
            title: "min-max from random places".to_owned(),
            notes,
            columns: vec![
                "scene",
                "on",
                "not finite",
                "p99 of brute force",
                "largest error",
                "pixels over twice the p99",
                "worst pose",
            ],
            rows,
        }],
        missing: Vec::new(),
    })
}

fn overrides() -> Result<Vec<Override>, Failure> {
    let parsed = [SIZE, MAP].iter().map(|text| text.parse());
    parsed.collect::<Result<_, _>>().map_err(Failure::input)
}

/// Errors of a scene's pixels and channels, over all poses.
#[derive(Default)]
struct Errors {
    march: Vec<f64>,
    /// With the pose of each; a value that is not finite is an infinite error.
    min_max: Vec<(Place, Vec<(f64, usize)>)>,
}

fn of_scene(
    setup: &Setup,
    poses: usize,
    bench: &Bench,
    progress: &dyn Fn(u64, u64),
) -> Result<Errors, Failure> {
    let mut stage = Stage::new(setup, &bench.backend, &mut Stages::default())?;
    let technique = Technique::from_name("min-max").unwrap_or_default();
    let place = stage.place(technique.info());
    let mut errors = Errors::default();
    let numbers = in_box(1, poses, [const { -1.0..=1.0 }; 9]);
    for (pose, x) in numbers.iter().rev().take(poses).enumerate() {
        stage.look_from(camera(setup, pose, x))?;
        let truth = stage.reference(Visibility::ShadowMap)?;
        let march = stage.in_scatter(&ray_march(STEPS))?;
        errors.march.extend(differences(&march, &truth));
        errors.add(
            Place::Cpu,
            pose,
            &stage.in_scatter_on_cpu(&technique)?,
            &truth,
        );
        if place == Some(Place::Gpu) {
            errors.add(Place::Gpu, pose, &stage.in_scatter(&technique)?, &truth);
        }
        progress(pose as u64 + 1, poses as u64);
    }
    Ok(errors)
}

/// Of each pixel and channel, relative to the truth's mean; infinite where a value is not finite.
fn differences(picture: &Picture, truth: &Picture) -> Vec<f64> {
    let values = |picture: &Picture| -> Vec<f64> {
        let channels = picture.pixels.as_flattened().iter();
        channels.map(|x| f64::from(*x)).collect()
    };
    let (found, truth) = (values(picture), values(truth));
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let error = |(found, truth): (&f64, &f64)| match (found - truth).abs() {
        difference if difference.is_finite() => difference / mean.max(f64::MIN_POSITIVE),
        _ => f64::INFINITY,
    };
    found.iter().zip(&truth).map(error).collect()
}

impl Errors {
    fn add(&mut self, place: Place, pose: usize, picture: &Picture, truth: &Picture) {
        let errors = differences(picture, truth).into_iter().map(|e| (e, pose));
        match self.min_max.iter_mut().find(|(p, _)| *p == place) {
            Some((_, all)) => all.extend(errors),
            None => self.min_max.push((place, errors.collect())),
        }
    }

    fn rows(mut self, scene: &str) -> Vec<Vec<Cell>> {
        self.march.sort_unstable_by(f64::total_cmp);
        let p99 = self.march[self.march.len() * 99 / 100];
        let row = |(place, errors): &(Place, Vec<(f64, usize)>)| {
            let count = |is: &dyn Fn(f64) -> bool| {
                Cell::Count(errors.iter().filter(|(e, _)| is(*e)).count() as u64)
            };
            let worst = errors.iter().max_by(|a, b| a.0.total_cmp(&b.0));
            let &(largest, pose) = worst.unwrap_or(&(0.0, 0));
            vec![
                Cell::text(scene),
                Cell::text(place.name()),
                count(&|e| !e.is_finite()),
                Cell::Number(p99),
                Cell::Number(largest),
                count(&|e| e > FACTOR * p99),
                Cell::Count(pose as u64),
            ]
        };
        self.min_max.iter().map(row).collect()
    }
}

/// Camera number `pose` of random numbers within [-1, 1]: anywhere, towards the light, at the light, or from outside; every fifth orthographic or wide.
fn camera(setup: &Setup, pose: usize, x: &[f32; 9]) -> Camera {
    let vector = |n: usize| vec3(x[n], x[n + 1], x[n + 2]);
    let bounds = setup.tracer.geometry().bounds();
    let Bounds { min, max } = bounds.unwrap_or(Bounds {
        min: Vec3::NEG_ONE,
        max: Vec3::ONE,
    });
    let (center, half) = (0.5 * (min + max), 0.5 * (max - min));
    let anywhere = center + half * vector(0);
    let at_random = vector(3).normalize_or(Vec3::Z);
    let jitter = vector(6);
    let light = setup.frame.lights[0].emitter;
    let (eye, forward) = match pose % 5 {
        1 => (anywhere, to_light(&light, anywhere) + 0.2 * jitter),
        2 => match light {
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                // From a millimetre to a few decimetres.
                let distance = 1e-3 * 300.0_f32.powf(jitter.x.abs());
                let eye = Vec3::from(position) + distance * at_random;
                (eye, if jitter.y < 0.0 { -at_random } else { jitter })
            }
            _ => (
                anywhere,
                to_light(&light, anywhere) * jitter.x.signum() + 1e-3 * jitter,
            ),
        },
        3 => {
            let eye = center + 2.0 * half.length() * at_random;
            (eye, center + 0.5 * half * jitter - eye)
        }
        _ => (anywhere, at_random),
    };
    let forward = forward.normalize_or(Vec3::Z);
    let up = if forward.y.abs() < 0.9 {
        Vec3::Y
    } else {
        Vec3::X
    };
    let (width, radius) = (jitter.z.abs(), half.length());
    let wide = pose % 10 == 4;
    let yfov = if wide { 2.4 } else { 0.3 + 1.2 * width };
    let [eye, target, up] = [eye, eye + forward, up].map(|v| v.to_array());
    let mut camera = Camera::perspective(
        eye,
        target,
        up,
        yfov,
        4.0 / 3.0,
        2e-3 * radius,
        4.0 * radius,
    );
    if pose % 10 == 9 {
        let half = radius * (0.1 + 0.5 * width);
        camera.projection = Projection::Orthographic {
            half_extent: [half * 4.0 / 3.0, half],
            center: [0.0; 2],
            near: 2e-3 * radius,
            far: 4.0 * radius,
        };
    }
    camera
}

fn to_light(light: &Emitter, from: Vec3) -> Vec3 {
    match *light {
        Emitter::Directional { direction, .. } => -Vec3::from(direction).normalize_or(Vec3::NEG_Y),
        Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
            (Vec3::from(position) - from).normalize_or(Vec3::Y)
        }
        Emitter::Rect { center, .. } => (Vec3::from(center) - from).normalize_or(Vec3::Y),
    }
}
