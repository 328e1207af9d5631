//! Epipolar sampling on the GPU: against marching, against itself without trees, wherever the epipole is, and as the camera
//! moves.

mod common;

use std::sync::OnceLock;

use common::{SIZE, Stage, crowd, fog_stages, gpu as on, stages, steps, technique};
use glam::{Quat, Vec3};
use tyndall::{
    Effect,
    frame::{Camera, Emitter},
    techniques::{Technique, Value},
};
use tyndall_testkit::{
    device::{TestDevice, device_or_skip},
    metrics::compare,
    samples::in_box,
};

/// One effect for all tests: most of their time goes into its pipelines.
fn effect(gpu: &TestDevice) -> &'static Effect {
    static EFFECT: OnceLock<Effect> = OnceLock::new();
    EFFECT.get_or_init(|| on::effect(gpu))
}

fn epipolar(params: &[(&str, Value)]) -> Technique {
    technique("epipolar", params)
}

fn whole(key: &'static str, value: i64) -> (&'static str, Value) {
    (key, Value::Integer(value))
}

fn word(key: &'static str, value: &str) -> (&'static str, Value) {
    (key, Value::Word(value.into()))
}

/// Each light with two cameras, once with glass where it casts shadows, and all lights at once.
fn some_stages() -> Vec<Stage> {
    let chosen = |i: &usize| [i / 6 % 6, (i / 6 + 3) % 6].contains(&(i % 6));
    let all = stages().into_iter().enumerate();
    let some = all.filter(|(i, _)| chosen(i)).map(|(_, stage)| stage);
    some.chain([crowd()]).collect()
}

/// Every sample marched: there is left the interpolation from slices to pixels, in images whose depths are noise.
#[test]
fn it_agrees_with_marching_for_every_light_and_camera() {
    let Some(gpu) = device_or_skip("epipolar sampling against marching") else {
        return;
    };
    let effect = effect(gpu);
    let ours = epipolar(&[whole("slices", 512), whole("initial_step", 1)]);
    for stage in some_stages().into_iter().chain(fog_stages()) {
        let found = on::on_gpu(gpu, effect, &stage, ours.clone());
        let marched = on::on_gpu(gpu, effect, &stage, technique("ray-march", &[steps(1024)]));
        let error = compare(&found, &marched).expect("same size");
        // Largest measured on lavapipe: 0.0160 of a cube map, whose texels are not those of its charts; else 0.0067, of a
        // sun through a picture. With one texel a column, not the two that a slice's trace may cross: 0.0251, of a spot.
        // Droplets' forward peak is as narrow as a pixel of these pictures: 0.0188 of a spot that shines into the camera.
        let is_peak = stage.name == "spot; towards the light; droplets";
        let bound = if stage.name.starts_with("lamp") || is_peak {
            0.022
        } else {
            0.01
        };
        assert!(error.rel_mae < bound, "{}: {error:?}", stage.name);
    }
}

/// Algorithm 1 and algorithm 2 find the same stretches and add them up in the same order.
#[test]
fn trees_change_no_bit() {
    let Some(gpu) = device_or_skip("epipolar sampling with and without trees") else {
        return;
    };
    let effect = effect(gpu);
    for stage in some_stages() {
        let with = on::output(gpu, effect, &stage, epipolar(&[word("tree", "min-max")]));
        let without = on::output(gpu, effect, &stage, epipolar(&[word("tree", "none")]));
        assert_eq!(with, without, "{}", stage.name);
    }
}

/// The tangents of half the field of view of the cameras below.
const HALF_EXTENT: [f32; 2] = [0.6, 0.45];

/// A camera at `eye` that sees the direction `to_light` at a place of its picture, in half pictures from its middle; the
/// opposite direction where `ahead` is -1; to the side, at infinity, where it is 0.
fn camera_towards(eye: Vec3, to_light: Vec3, place: [f32; 2], ahead: f32, roll: f32) -> Camera {
    let [x, y] = [place[0] * HALF_EXTENT[0], place[1] * HALF_EXTENT[1]];
    let seen = if ahead == 0.0 {
        Vec3::new(x, y, 0.0)
    } else {
        ahead * Vec3::new(x, y, -1.0)
    };
    let turn =
        Quat::from_axis_angle(to_light, roll) * Quat::from_rotation_arc(seen.normalize(), to_light);
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let target = (eye + turn * Vec3::NEG_Z).to_array();
    let yfov = 2.0 * HALF_EXTENT[1].atan();
    Camera::perspective(
        eye.to_array(),
        target,
        (turn * Vec3::Y).to_array(),
        yfov,
        aspect,
        0.1,
        30.0,
    )
}

/// Places of the epipole: on the picture, beside its rim on either side, in its corners, off each side.
fn places(x: f32, y: f32) -> [[f32; 2]; 10] {
    let pixel = 2.0 / SIZE[0] as f32;
    [
        [x, y],
        [1.0 - pixel * y, x],
        [x, -1.0 - pixel * y],
        [1.0, 1.0],
        [-1.0 - 0.1 * pixel * y, 1.0 + 0.1 * pixel * x],
        [-1.0, x],
        [-2.0 - y, 2.0 * x],
        [1.5, x],
        [x, 3.0 + x],
        [2.0 * x, -1.2],
    ]
}

/// Views of the lights' stages: a random eye, and the epipole where it hurts.
fn poses(count: usize, lights: &[&str]) -> Vec<Stage> {
    let all = stages();
    let mut poses = Vec::new();
    let random = in_box(
        11,
        count / 10,
        [
            -6.0..=6.0,
            -6.0..=6.0,
            -6.0..=6.0,
            -0.95..=0.95,
            0.05..=0.95,
            0.0..=6.2,
        ],
    );
    for (i, [x, y, z, u, v, roll]) in random.into_iter().enumerate() {
        let eye = Vec3::new(x, y, z);
        for (j, place) in places(u, v).into_iter().enumerate() {
            let light = lights[(i + j) % lights.len()];
            let stage = all
                .iter()
                .find(|s| s.name.starts_with(light))
                .expect("a light");
            let to_light = match stage.frame.lights[0].emitter {
                Emitter::Directional { direction, .. } => -Vec3::from(direction),
                Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                    Vec3::from(position) - eye
                }
                Emitter::Rect { .. } => unreachable!("not among the lights"),
            };
            let ahead = [1.0, -1.0, 0.0][i % 3];
            let mut pose = Stage {
                name: format!("{light}; eye {eye}; epipole {place:?}, ahead {ahead}"),
                frame: stage.frame.clone(),
                depth: common::depth(true),
                lights: stage.lights.clone(),
            };
            pose.frame.camera = camera_towards(eye, to_light.normalize(), place, ahead, roll);
            poses.push(pose);
        }
    }
    poses
}

/// As fine as pictures of this size need.
fn small() -> Technique {
    epipolar(&[whole("slices", 192), whole("samples", 64)])
}

/// Wherever the epipole is: no NaN, and the light of marching.
#[test]
fn shadows_are_there_wherever_the_epipole_is() {
    let Some(gpu) = device_or_skip("epipolar sampling of shadows from many poses") else {
        return;
    };
    let effect = effect(gpu);
    let march = technique("ray-march", &[steps(256)]);
    let mut worst = (0.0, String::new());
    for pose in poses(10, &["sun;", "lamp;", "spot;"])
        .into_iter()
        .step_by(5)
    {
        let found = on::on_gpu(gpu, effect, &pose, small());
        let marched = on::on_gpu(gpu, effect, &pose, march.clone());
        let error = compare(&found, &marched).expect("same size").rel_mae;
        if error > worst.0 {
            worst = (error, pose.name);
        }
    }
    println!("shadows: {worst:?}");
    // Measured on lavapipe: 0.100, of a lamp.
    assert!(worst.0 < 0.14, "{worst:?}");
}

/// Smaller pictures in between and the other criterion: the light of marching, less exactly.
#[test]
fn coarser_pictures_and_the_other_criterion_show_the_same_light() {
    let Some(gpu) = device_or_skip("epipolar sampling by way of smaller pictures") else {
        return;
    };
    let effect = effect(gpu);
    let march = technique("ray-march", &[steps(256)]);
    // Largest measured on lavapipe: 0.041, 0.073 and 0.012, of suns.
    let settings = [
        (whole("downscale", 2), 0.06),
        (whole("downscale", 4), 0.1),
        (word("criterion", "in-scatter"), 0.02),
    ];
    for (setting, bound) in settings {
        let ours = epipolar(&[whole("slices", 192), whole("samples", 64), setting.clone()]);
        let mut worst = (0.0, String::new());
        for pose in poses(10, &["sun;", "lamp;", "spot;"])
            .into_iter()
            .step_by(9)
        {
            let found = on::on_gpu(gpu, effect, &pose, ours.clone());
            let marched = on::on_gpu(gpu, effect, &pose, march.clone());
            let error = compare(&found, &marched).expect("same size").rel_mae;
            if error > worst.0 {
                worst = (error, pose.name);
            }
        }
        println!("{setting:?}: {worst:?}");
        assert!(worst.0 < bound, "{setting:?}: {worst:?}");
    }
}

/// Each view of the work shows what it says, in its own colours.
#[test]
fn debug_views_show_samples_breaks_and_corrections() {
    let Some(gpu) = device_or_skip("debug views of epipolar sampling") else {
        return;
    };
    let effect = effect(gpu);
    let all = stages();
    let stage = all.iter().find(|s| s.name.starts_with("lamp; across"));
    let stage = stage.expect("a lamp among depths that are noise");
    // So few slices that some pixels have no fitting sources.
    let few = |view| {
        epipolar(&[
            whole("slices", 16),
            whole("samples", 32),
            word("show", view),
        ])
    };
    const WHITE: [f64; 3] = [1.0; 3];
    const BLACK: [f64; 3] = [0.0; 3];
    const BLUE: [f64; 3] = [0.0, 0.0, 0.4];
    const RED: [f64; 3] = [1.0, 0.0, 0.0];
    const GREY: [f64; 3] = [0.2; 3];
    for (view, colours) in [
        ("samples", &[WHITE, BLACK, BLUE][..]),
        ("depth-breaks", &[WHITE, BLACK]),
        ("corrected", &[RED, GREY]),
    ] {
        let picture = on::on_gpu(gpu, effect, stage, few(view));
        let is_near = |pixel: &[f64; 3], colour: &[f64; 3]| {
            pixel.iter().zip(colour).all(|(a, b)| (a - b).abs() < 1e-3)
        };
        let counts: Vec<usize> = colours
            .iter()
            .map(|c| picture.pixels().iter().filter(|p| is_near(p, c)).count())
            .collect();
        println!("{view}: {counts:?}");
        let all: usize = counts.iter().sum();
        assert_eq!(all, picture.pixels().len(), "{view}: {counts:?}");
        assert!(counts.iter().all(|n| *n > 0), "{view}: {counts:?}");
    }
}

/// Light that nothing blocks has no edges: here a pixel without its light is a seam, and none may be.
#[test]
fn no_seams_are_there_wherever_the_epipole_is() {
    let Some(gpu) = device_or_skip("epipolar sampling without blockers from many poses") else {
        return;
    };
    let effect = effect(gpu);
    let equiangular = ("spacing", Value::Word("equiangular".into()));
    let march = technique("ray-march", &[steps(128), equiangular]);
    let mut worst = (0.0, String::new());
    for mut pose in poses(30, &["sun;", "lamp;"]).into_iter().step_by(5) {
        if let Some(map) = &mut pose.lights[0].shadow_map {
            map.depth.fill(0.0);
        }
        let found = on::on_gpu(gpu, effect, &pose, small());
        let marched = on::on_gpu(gpu, effect, &pose, march.clone());
        let pairs = found.pixels().iter().zip(marched.pixels());
        let error = pairs
            .map(|(a, b)| (a[0] - b[0]).abs() / b[0])
            .fold(0.0, f64::max);
        assert!(
            found.pixels().iter().flatten().all(|x| x.is_finite()),
            "{}",
            pose.name
        );
        if error > worst.0 {
            worst = (error, pose.name);
        }
    }
    println!("seams: {worst:?}");
    // Measured on lavapipe: 0.0035 of the pixel.
    assert!(worst.0 < 0.007, "{worst:?}");
}

/// A tenth of a pixel of turning changes the picture no more than it changes by marching, but for the technique's error.
#[test]
fn pictures_are_stable_as_the_camera_turns() {
    let Some(gpu) = device_or_skip("epipolar sampling of a camera that turns") else {
        return;
    };
    let effect = effect(gpu);
    let march = technique("ray-march", &[steps(1024)]);
    for mut stage in poses(100, &["sun;", "lamp;", "spot;"])
        .into_iter()
        .step_by(59)
    {
        let render = |stage: &Stage| {
            [epipolar(&[]), march.clone()].map(|t| on::on_gpu(gpu, effect, stage, t))
        };
        let before = render(&stage);
        let tenth = 0.1 * 2.0 * HALF_EXTENT[0] / SIZE[0] as f32;
        let camera = &mut stage.frame.camera;
        let forward = Vec3::from(camera.forward);
        let side = forward.cross(Vec3::from(camera.up)).normalize();
        camera.forward = (forward + tenth * side).to_array();
        let after = render(&stage);
        let [change, by_marching] =
            [0, 1].map(|k| compare(&after[k], &before[k]).expect("same size").rel_mae);
        let error = compare(&before[0], &before[1]).expect("same size").rel_mae;
        println!("stable: {change:.4} {by_marching:.4} {error:.4}");
        assert!(
            change <= by_marching + error,
            "{}: {change} {by_marching} {error}",
            stage.name
        );
    }
}
