//! Epipolar sampling on the GPU: against marching, against itself without trees, wherever the epipole is, and as the camera
//! moves.

mod common;

use common::{SIZE, Stage, crowd, gpu as on, stages, steps, technique};
use glam::{Quat, Vec3};
use tyndall::{
    camera::CameraRays,
    frame::{Camera, Emitter, Light},
    techniques::{Technique, Value},
};
use tyndall_testkit::{device::device_or_skip, metrics::compare, samples::in_box};

fn epipolar(params: &[(&str, Value)]) -> Technique {
    technique("epipolar", params)
}

fn whole(key: &'static str, value: i64) -> (&'static str, Value) {
    (key, Value::Integer(value))
}

fn word(key: &'static str, value: &str) -> (&'static str, Value) {
    (key, Value::Word(value.into()))
}

/// Every sample marched: what is left is the way from slices to pixels, in pictures whose depths are noise.
#[test]
fn it_agrees_with_marching_for_every_light_and_camera() {
    let Some(gpu) = device_or_skip("epipolar sampling against marching") else {
        return;
    };
    let effect = on::effect(gpu);
    let ours = epipolar(&[whole("slices", 512), whole("initial_step", 1)]);
    for stage in stages().into_iter().chain([crowd()]) {
        let found = on::on_gpu(gpu, &effect, &stage, ours.clone());
        let marched = on::on_gpu(gpu, &effect, &stage, technique("ray-march", &[steps(1024)]));
        let error = compare(&found, &marched).expect("same size");
        println!("{}: {:.4} {:+.4}", stage.name, error.rel_mae, error.bias);
        assert!(error.rel_mae < 0.03, "{}: {error:?}", stage.name);
    }
}

/// Algorithm 1 and algorithm 2 find the same stretches and add them up in the same order.
#[test]
fn trees_change_no_bit() {
    let Some(gpu) = device_or_skip("epipolar sampling with and without trees") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in stages().into_iter().chain([crowd()]) {
        let with = on::output(gpu, &effect, &stage, epipolar(&[word("tree", "min-max")]));
        let without = on::output(gpu, &effect, &stage, epipolar(&[word("tree", "none")]));
        assert_eq!(with, without, "{}", stage.name);
    }
}
