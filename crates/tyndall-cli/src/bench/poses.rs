//! Epipolar techniques from anywhere: cameras at random within a scene and beside it, close to the light, and with the
//! light on the picture, on its border, in its corners, off each of its sides and behind.
//!
//! `min-max` is exact but for rounding, so that none of its pixels may be as wrong as brute force's worst ones are: at most
//! twice the 99th percentile of the error of 512 steps over all of a scene's pixels. `epipolar` interpolates; beside it
//! stands how wrong it is. Errors are relative to the mean of their picture.

use glam::{Mat3, Quat, Vec3, vec3};
use tyndall::{
    frame::{Camera, Emitter, Projection},
    techniques::{Backends, Technique},
};
use tyndall_scene::geometry::Bounds;

use super::{
    report::{Bench, Report},
    table::{Cell, Table},
};
use crate::{
    failure::Failure,
    load::{LoadedShot, ShotFrame},
    measure::{DrawnFrame, Place, Visibility, ray_march},
    picture::Picture,
    progress::Progress,
    samples::in_box,
    shot::{Override, Shot},
};

/// Cameras a scene.
pub(super) const POSES: usize = 500;

const PIXELS: [u32; 2] = [32, 24];
const ASPECT: f32 = PIXELS[0] as f32 / PIXELS[1] as f32;
const MAP: &str = "light.0.shadow_map=512";
const STEPS: u32 = 512;
const TECHNIQUES: [&str; 2] = ["min-max", "epipolar"];
/// Multiple of brute force's 99th percentile that a pixel's error may reach.
const FACTOR: f64 = 2.0;

const BUILT_IN: [&str; 3] = ["builtin:church", "builtin:forest", "builtin:terrain"];
const BOX_WALL: &str = "box-wall.glb";
const BOX_WALL_SHOT: &str = include_str!("shots/box-wall.toml");

/// Renders from so many places in every scene.
pub(super) fn run(poses: usize, bench: &Bench, progress: &mut Progress) -> Result<Report, Failure> {
    let mut shot_frames = Vec::new();
    for name in BUILT_IN {
        let shot = Shot::load(name.as_ref(), None, &overrides()?).map_err(Failure::input)?;
        shot_frames.push((
            name.to_owned(),
            LoadedShot::at_rest(&shot, progress)?
                .frame(0)?
                .with_whole_maps(),
        ));
    }
    let box_wall = bench.assets.as_ref().map(|folder| folder.join(BOX_WALL));
    let mut notes = vec![format!(
        "{poses} cameras a scene; errors relative to the picture's mean; {STEPS} steps of brute force"
    )];
    match box_wall.filter(|file| file.is_file()) {
        Some(file) => {
            let shot = Shot::of_text(&file.with_extension("toml"), BOX_WALL_SHOT, &overrides()?);
            let shot_frame =
                LoadedShot::at_rest(&shot.map_err(Failure::input)?, progress)?.frame(0)?;
            shot_frames.push((BOX_WALL.to_owned(), shot_frame.with_whole_maps()));
        }
        None => notes.push(format!("skipped: {BOX_WALL} is not among the assets")),
    }
    let mut rows = Vec::new();
    for (name, shot_frame) in &shot_frames {
        let errors = progress.run(&format!("{poses} poses of {name}"), |report| {
            of_scene(shot_frame, poses, bench, report)
        })?;
        rows.extend(errors.rows(name));
    }
    Ok(Report {
        tables: vec![Table {
            title: "from random places".to_owned(),
            notes,
            columns: vec![
                "scene",
                "technique",
                "on",
                "not finite",
                "p99 of brute force",
                "p99",
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
    let size = format!("size=[{},{}]", PIXELS[0], PIXELS[1]);
    let texts = [size.as_str(), MAP];
    let parsed = texts.iter().map(|text| text.parse());
    parsed.collect::<Result<_, _>>().map_err(Failure::input)
}

/// Errors of a scene's pixels and channels, over all poses.
#[derive(Default)]
struct Errors {
    march: Vec<f64>,
    techniques: Vec<OfTechnique>,
}

/// Errors of a technique on one processor, with the pose of each; a value that is not finite is an infinite error.
struct OfTechnique {
    name: &'static str,
    place: Place,
    errors: Vec<(f64, usize)>,
}

fn of_scene(
    shot_frame: &ShotFrame,
    poses: usize,
    bench: &Bench,
    report: &dyn Fn(u64, u64),
) -> Result<Errors, Failure> {
    let mut drawn = DrawnFrame::new(shot_frame, &bench.backend, &mut Progress::default())?;
    let techniques: Vec<Technique> = TECHNIQUES
        .iter()
        .filter_map(|name| Technique::from_name(name))
        .collect();
    let mut errors = Errors::default();
    let numbers = in_box(1, poses, [const { -1.0..=1.0 }; 9]);
    for (pose, x) in numbers.iter().rev().take(poses).enumerate() {
        drawn.look_from(camera(shot_frame, pose, x))?;
        let truth = drawn.reference(Visibility::ShadowMap)?;
        let march = drawn.in_scatter(&ray_march(STEPS))?;
        errors.march.extend(differences(&march, &truth));
        for technique in &techniques {
            let info = technique.info();
            if info.backends != Backends::Gpu {
                let picture = drawn.in_scatter_on_cpu(technique)?;
                errors.add(info.name, Place::Cpu, pose, differences(&picture, &truth));
            }
            if drawn.place(info) == Some(Place::Gpu) {
                let picture = drawn.in_scatter(technique)?;
                errors.add(info.name, Place::Gpu, pose, differences(&picture, &truth));
            }
        }
        report(pose as u64 + 1, poses as u64);
    }
    Ok(errors)
}

/// Errors of each pixel and channel, relative to the truth's mean; infinite where a value is not finite.
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
    fn add(&mut self, name: &'static str, place: Place, pose: usize, differences: Vec<f64>) {
        let errors = differences.into_iter().map(|e| (e, pose));
        let mut known = self.techniques.iter_mut();
        match known.find(|of| (of.name, of.place) == (name, place)) {
            Some(of) => of.errors.extend(errors),
            None => self.techniques.push(OfTechnique {
                name,
                place,
                errors: errors.collect(),
            }),
        }
    }

    fn rows(mut self, scene: &str) -> Vec<Vec<Cell>> {
        self.march.sort_unstable_by(f64::total_cmp);
        let bound = p99(&self.march);
        for of in &mut self.techniques {
            of.errors.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        }
        let row = |of: &OfTechnique| {
            let (errors, poses): (Vec<f64>, Vec<usize>) = of.errors.iter().copied().unzip();
            let count = |is: &dyn Fn(f64) -> bool| {
                Cell::Count(errors.iter().filter(|e| is(**e)).count() as u64)
            };
            vec![
                Cell::text(scene),
                Cell::text(of.name),
                Cell::text(of.place.name()),
                count(&|e| !e.is_finite()),
                Cell::Number(bound),
                Cell::Number(p99(&errors)),
                Cell::Number(errors.last().copied().unwrap_or(0.0)),
                count(&|e| e > FACTOR * bound),
                Cell::Count(poses.last().copied().unwrap_or(0) as u64),
            ]
        };
        self.techniques.iter().map(row).collect()
    }
}

/// The 99th percentile of what is sorted; 0 of nothing.
fn p99(sorted: &[f64]) -> f64 {
    sorted.get(sorted.len() * 99 / 100).copied().unwrap_or(0.0)
}

/// Camera number `pose` of random numbers within [-1, 1]: anywhere, with the light at a chosen place of the picture, at the
/// light, or from outside; every tenth orthographic, every tenth wide.
fn camera(shot_frame: &ShotFrame, pose: usize, x: &[f32; 9]) -> Camera {
    let vector = |n: usize| vec3(x[n], x[n + 1], x[n + 2]);
    let bounds = shot_frame.tracer.geometry().bounds();
    let Bounds { min, max } = bounds.unwrap_or(Bounds {
        min: Vec3::NEG_ONE,
        max: Vec3::ONE,
    });
    let (center, half) = (0.5 * (min + max), 0.5 * (max - min));
    let anywhere = center + half * vector(0);
    let at_random = vector(3).normalize_or(Vec3::Z);
    let jitter = vector(6);
    let (width, radius) = (jitter.z.abs(), half.length());
    let wide = pose % 10 == 4;
    let yfov = if wide { 2.4 } else { 0.3 + 1.2 * width };
    let light = shot_frame.frame.lights[0].emitter;
    let (eye, turn) = match pose % 5 {
        1 => {
            let seen = epipole(pose / 5, [jitter.x, jitter.y], yfov);
            let shown = Quat::from_rotation_arc(seen, to_light(&light, anywhere));
            (anywhere, shown)
        }
        2 => match light {
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                // From a millimetre to a few decimetres.
                let distance = 1e-3 * 300.0_f32.powf(jitter.x.abs());
                let eye = Vec3::from(position) + distance * at_random;
                let forward = if jitter.y < 0.0 { -at_random } else { jitter };
                (eye, looking(forward))
            }
            _ => {
                let forward = to_light(&light, anywhere) * jitter.x.signum() + 1e-3 * jitter;
                (anywhere, looking(forward))
            }
        },
        3 => {
            let eye = center + 2.0 * half.length() * at_random;
            (eye, looking(center + 0.5 * half * jitter - eye))
        }
        _ => (anywhere, looking(at_random)),
    };
    let [eye, target, up] = [eye, eye + turn * Vec3::NEG_Z, turn * Vec3::Y].map(|v| v.to_array());
    let mut camera =
        Camera::perspective(eye, target, up, yfov, ASPECT, 2e-3 * radius, 4.0 * radius);
    if pose % 10 == 9 {
        let half = radius * (0.1 + 0.5 * width);
        camera.projection = Projection::Orthographic {
            half_extent: [half * ASPECT, half],
            center: [0.0; 2],
            near: 2e-3 * radius,
            far: 4.0 * radius,
        };
    }
    camera
}

/// The turn of an upright camera.
fn looking(forward: Vec3) -> Quat {
    let forward = forward.normalize_or(Vec3::Z);
    let up = if forward.y.abs() < 0.9 {
        Vec3::Y
    } else {
        Vec3::X
    };
    let side = forward.cross(up).normalize();
    Quat::from_mat3(&Mat3::from_cols(side, side.cross(forward), -forward))
}

/// The unit direction in the camera's space that is seen at place number `case` of its picture, or the opposite one: on the
/// picture, beside its border, in its corners, off each side, at infinity.
fn epipole(case: usize, [x, y]: [f32; 2], yfov: f32) -> Vec3 {
    // In half pictures from the middle.
    let pixel = 2.0 / PIXELS[0] as f32;
    let places = [
        [x, y],
        [1.0 - pixel * y.abs(), x],
        [x, -1.0 - pixel * y.abs()],
        [1.0, 1.0],
        [-1.0 - 0.1 * pixel * y, 1.0 + 0.1 * pixel * x],
        [-1.0, x],
        [-2.0 - y, 2.0 * x],
        [1.5, x],
        [x, 3.0 + x],
        [2.0 * x, -1.2],
        [x, y],
    ];
    let tangent = (0.5 * yfov).tan();
    let number = case % places.len();
    let [x, y] = places[number];
    let is_at_infinity = number + 1 == places.len();
    let depth = if is_at_infinity { 0.0 } else { -1.0 };
    let ahead = if (case / places.len()).is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    ahead * vec3(x * tangent * ASPECT, y * tangent, depth).normalize_or(Vec3::NEG_Z)
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
