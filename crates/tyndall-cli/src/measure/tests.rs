//! The harness measures what it says: on a small shot, on the GPU and on the CPU.

use std::path::Path;

use tyndall_testkit::device::device_or_skip;

use super::*;
use crate::{
    backend::{Backend, BackendChoice},
    load::{LoadedShot, ShotFrame},
    progress::Progress,
    shot::{Override, Shot},
};

pub(super) fn shot_frame() -> ShotFrame {
    let overrides =
        ["size=[64,48]", "light.0.shadow_map=256"].map(|text| text.parse::<Override>().unwrap());
    let shot = Shot::load(Path::new("builtin:slats"), None, &overrides).unwrap();
    let mut loaded = LoadedShot::at_rest(&shot, &mut Progress::default()).unwrap();
    loaded.frame(0).unwrap()
}

fn backend(choice: BackendChoice) -> Backend {
    Backend::choose(choice, &[ray_march(1).info()]).unwrap()
}

pub(crate) fn gpu_or_skip(what: &str) -> Option<Backend> {
    device_or_skip(what).map(|_| backend(BackendChoice::Gpu))
}

#[test]
fn marching_at_256_steps_needs_256_steps_to_be_as_good() {
    let Some(gpu) = gpu_or_skip("equal quality") else {
        return;
    };
    let shot_frame = shot_frame();
    for backend in [gpu, backend(BackendChoice::Cpu)] {
        let drawn = DrawnFrame::new(&shot_frame, &backend, &mut Progress::default()).unwrap();
        let truth = drawn.reference(Visibility::ShadowMap).unwrap();
        let technique = drawn.in_scatter(&ray_march(256)).unwrap();
        let target = error_of(&technique, &truth).unwrap().rel_mae;
        let found = Marches::new(&drawn, &truth).equal_quality(target).unwrap();
        assert!(found.reached && found.error.rel_mae <= target, "{found:?}");
        eprintln!(
            "{} steps, error {:.2e}, target {target:.2e}",
            found.steps, found.error.rel_mae
        );
        assert!((231..=281).contains(&found.steps), "{found:?}");
    }
}

#[test]
fn techniques_on_the_cpu_are_handed_the_gpus_maps() {
    let Some(gpu) = gpu_or_skip("maps read back") else {
        return;
    };
    let shot_frame = shot_frame();
    let (mut progress, cpu) = (Progress::default(), backend(BackendChoice::Cpu));
    let on_gpu = DrawnFrame::new(&shot_frame, &gpu, &mut progress).unwrap();
    let on_cpu = DrawnFrame::new(&shot_frame, &cpu, &mut progress).unwrap();
    let truth = on_gpu.reference(Visibility::ShadowMap).unwrap();
    let marched = |drawn: &DrawnFrame<'_>| drawn.in_scatter(&ray_march(4096)).unwrap();
    let own = error_of(&marched(&on_gpu), &truth).unwrap().rel_mae;
    let others = error_of(&marched(&on_cpu), &truth).unwrap().rel_mae;
    eprintln!("error with the same maps {own:.2e}, with traced ones {others:.2e}");
    assert!(own < others, "{own} {others}");
}

#[test]
fn frames_are_timed_with_their_passes_and_the_limit() {
    let Some(gpu) = gpu_or_skip("times") else {
        return;
    };
    let shot_frame = shot_frame();
    let drawn = DrawnFrame::new(&shot_frame, &gpu, &mut Progress::default()).unwrap();
    let budget = Budget::default();
    let techniques = [8, 512].map(ray_march);
    let timings = drawn.time(&techniques, &budget).unwrap();
    let [few, many] = [0, 1].map(|i| &timings.techniques[i].1);
    for timing in [few, many] {
        assert_eq!((timing.place, timing.frames), (Place::Gpu, budget.frames));
        assert!(timing.wall.median >= timing.total().median, "{timing:?}");
        assert!(timing.wall.lower <= timing.wall.median && timing.wall.median <= timing.wall.upper);
        assert!(timing.bytes.is_some_and(|bytes| bytes >= 64 * 48 * 16));
    }
    assert!(few.total().median < many.total().median, "{few:?} {many:?}");
    let limit = timings.limit.as_ref().unwrap();
    assert_eq!(limit.frames, budget.frames);
    assert!(timings.over_limit(many).unwrap() > timings.over_limit(few).unwrap());
}

#[test]
fn what_a_stage_cannot_do_is_an_error_that_says_so() {
    let shot_frame = shot_frame();
    let cpu = backend(BackendChoice::Cpu);
    let drawn = DrawnFrame::new(&shot_frame, &cpu, &mut Progress::default()).unwrap();
    let gpu_only = |info: &tyndall::techniques::TechniqueInfo| {
        info.backends == tyndall::techniques::Backends::Gpu
    };
    for info in tyndall::techniques::TABLE {
        assert_eq!(drawn.place(info).is_none(), gpu_only(info), "{}", info.name);
    }
    assert!(
        drawn
            .techniques()
            .iter()
            .all(|t| drawn.in_scatter(t).is_ok())
    );
    assert!(drawn.time(&[], &Budget::default()).unwrap().limit.is_none());
}
