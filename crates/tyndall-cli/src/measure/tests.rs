//! The harness measures what it says: on a small shot, on the GPU and on the CPU.

use std::path::Path;

use tyndall_testkit::device::device_or_skip;

use super::*;
use crate::{
    args::BackendChoice,
    progress::Stages,
    render::Backend,
    setup::Setup,
    shot::{Override, Shot},
};

pub(super) fn setup() -> Setup {
    let overrides =
        ["size=[64,48]", "light.0.shadow_map=256"].map(|text| text.parse::<Override>().unwrap());
    let shot = Shot::load(Path::new("builtin:slats"), None, &overrides).unwrap();
    Setup::new(&shot, &mut Stages::default()).unwrap()
}

fn backend(choice: BackendChoice) -> Backend {
    Backend::choose(choice, ray_march(1).info()).unwrap()
}

pub(crate) fn gpu_or_skip(what: &str) -> Option<Backend> {
    device_or_skip(what).map(|_| backend(BackendChoice::Gpu))
}

#[test]
fn marching_at_256_steps_needs_256_steps_to_be_as_good() {
    let Some(gpu) = gpu_or_skip("equal quality") else {
        return;
    };
    let setup = setup();
    for backend in [gpu, backend(BackendChoice::Cpu)] {
        let stage = Stage::new(&setup, &backend, &mut Stages::default()).unwrap();
        let truth = stage.reference(Visibility::ShadowMap).unwrap();
        let technique = stage.in_scatter(&ray_march(256)).unwrap();
        let target = error_of(&technique, &truth).unwrap().rel_mae;
        let found = Marches::new(&stage, &truth).equal_quality(target).unwrap();
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
    let setup = setup();
    let (mut stages, cpu) = (Stages::default(), backend(BackendChoice::Cpu));
    let on_gpu = Stage::new(&setup, &gpu, &mut stages).unwrap();
    let on_cpu = Stage::new(&setup, &cpu, &mut stages).unwrap();
    let truth = on_gpu.reference(Visibility::ShadowMap).unwrap();
    let marched = |stage: &Stage<'_>| stage.in_scatter(&ray_march(4096)).unwrap();
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
    let setup = setup();
    let stage = Stage::new(&setup, &gpu, &mut Stages::default()).unwrap();
    let budget = Budget::default();
    let techniques = [8, 512].map(ray_march);
    let timings = stage.time(&techniques, &budget).unwrap();
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
    let setup = setup();
    let cpu = backend(BackendChoice::Cpu);
    let stage = Stage::new(&setup, &cpu, &mut Stages::default()).unwrap();
    let gpu_only = |info: &tyndall::techniques::TechniqueInfo| {
        info.backends == tyndall::techniques::Backends::Gpu
    };
    for info in tyndall::techniques::TABLE {
        assert_eq!(stage.place(info).is_none(), gpu_only(info), "{}", info.name);
    }
    assert!(
        stage
            .techniques()
            .iter()
            .all(|t| stage.in_scatter(t).is_ok())
    );
    assert!(stage.time(&[], &Budget::default()).unwrap().limit.is_none());
}
