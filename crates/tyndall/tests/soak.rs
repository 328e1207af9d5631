//! Frame after frame of everything that may change in a game: lights and media that come and go, techniques that are
//! switched, reuse on and off, windows that are resized. Nothing may grow. And a device that is lost.

#![cfg(feature = "gpu")]

mod common;

use std::sync::{Arc, Mutex};

use common::{Random, Stage, crowd, gpu as on, media, run::Run, steps, technique};
use peak_alloc::PeakAlloc;
use tyndall::{
    Effect, PrepareError,
    techniques::{Technique, Value},
    temporal::{Reuse, ReuseMask, ReuseShow},
};
use tyndall_testkit::device::{TestDevice, device_or_skip, plain_device_or_skip};

/// Bytes that the largest frames of one half may have over those of the other. Measured on lavapipe: of 320 frames 137 kB of the heap
/// and 111 kB of the device, of 10,000 frames 26 kB and 1 kB.
const SLACK: u64 = 256 << 10;

/// Cheap: what is looked for does not hang on a picture's quality.
fn techniques() -> [Technique; 6] {
    let grid = [
        ("slices", Value::Integer(32)),
        ("samples", Value::Integer(32)),
    ];
    [
        technique("ray-march", &[steps(16)]),
        technique("min-max", &[]),
        technique("hybrid", &[steps(16)]),
        technique("epipolar", &grid),
        technique("light-volume", &[]),
        technique("vsv", &[("resolution", Value::Integer(64))]),
    ]
}
const SIZES: [[u32; 2]; 4] = [[48, 36], [1, 1], [37, 53], [64, 16]];
const REUSE: [Option<Reuse>; 2] = [
    None,
    Some(Reuse {
        frames: Some(20),
        mask: ReuseMask::Change,
        reproject: None,
        show: ReuseShow::Light,
    }),
];

/// A stage with these of its lights alone.
fn with_lights(stage: &Stage, chosen: &[usize]) -> Stage {
    let mut stage = stage.clone();
    stage.frame.lights = chosen.iter().map(|i| stage.frame.lights[*i]).collect();
    stage.lights = chosen.iter().map(|i| stage.lights[*i].clone()).collect();
    stage
}

#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// What this library holds \[bytes]: Rust's heap, and memory of the device. A software driver's own memory is not among it, for
/// lavapipe compiles shaders anew for values it meets and keeps their code.
#[derive(Clone, Copy, Debug)]
struct Held {
    heap: u64,
    device: u64,
}

impl Held {
    fn now(gpu: &TestDevice) -> Self {
        let report = gpu.device.generate_allocator_report();
        Self {
            heap: HEAP.current_usage() as u64,
            device: report.map_or(0, |report| report.total_allocated_bytes),
        }
    }

    fn most(self, other: Self) -> Self {
        Self {
            heap: self.heap.max(other.heap),
            device: self.device.max(other.device),
        }
    }
}

/// A technique and the lights of the crowd that it does.
struct Cast {
    technique: Technique,
    lights: Vec<usize>,
}

/// All techniques, after each has drawn each of its lights alone, in each medium, with and without reuse, and none.
fn warmed_up(gpu: &TestDevice, effect: &Effect, crowds: &[Stage]) -> Vec<Cast> {
    let is_done = |technique: &Technique, lights: &[usize]| {
        let mut settings = crowds
            .iter()
            .flat_map(|crowd| REUSE.map(|reuse| (crowd, reuse)));
        settings.all(|(crowd, reuse)| {
            let stage = with_lights(crowd, lights);
            let mut run = Run::new(gpu, effect, reuse);
            match run.prepare_with(&stage, technique, None) {
                Err(PrepareError::Unsupported { .. }) => return false,
                done => done.expect("a good stage"),
            }
            run.record();
            // A frame that keeps pixels, if there is reuse.
            run.frame(&stage, technique);
            true
        })
    };
    let cast = |technique: Technique| {
        assert!(is_done(&technique, &[]), "{technique:?} of no light");
        let mut lights: Vec<usize> = (0..crowds[0].lights.len()).collect();
        lights.retain(|light| is_done(&technique, &[*light]));
        assert!(!lights.is_empty(), "{technique:?} does no light");
        Cast { technique, lights }
    };
    techniques().map(cast).into()
}

/// The lights of all stages, or a sun, a lamp and a spot, in so many media.
fn crowds(of_all: bool, media_count: usize) -> Vec<Stage> {
    let all = crowd();
    let chosen: Vec<usize> = (0..all.frame.lights.len()).collect();
    let few: Vec<usize> = chosen.iter().copied().step_by(3).collect();
    let crowd = with_lights(&all, if of_all { &chosen } else { &few });
    let within = |(_, medium)| {
        let mut crowd = crowd.clone();
        crowd.frame.medium = medium;
        crowd
    };
    media().into_iter().take(media_count).map(within).collect()
}

/// So many frames at least. The largest that memory gets in the second half is what it was in the first, but for a few bytes.
fn soak(gpu: &TestDevice, crowds: &[Stage], frames: u32) {
    let effect = on::effect(gpu);
    let casts = warmed_up(gpu, &effect, crowds);
    let warm = effect.pipelines();
    let mut dice = Random(1);
    let mut size = SIZES[0];
    let mut run = Run::sized(size, gpu, &effect, None);
    let mut largest = [Held { heap: 0, device: 0 }; 2];
    let mut frame = 0;
    while frame < frames {
        let before = frame;
        if dice.roll(40) == 0 {
            size = SIZES[dice.roll(SIZES.len())];
            run = Run::sized(size, gpu, &effect, None);
        }
        if dice.roll(10) == 0 {
            run.view().set_reuse(REUSE[dice.roll(REUSE.len())]);
        }
        let cast = &casts[dice.roll(casts.len())];
        // Three of them at most.
        let mut chosen = cast.lights.clone();
        while chosen.len() > 3 || (!chosen.is_empty() && dice.roll(2) == 0) {
            chosen.remove(dice.roll(chosen.len()));
        }
        let crowd = &crowds[dice.roll(crowds.len())];
        let stage = with_lights(crowd, &chosen).sized(size);
        // Reuse keeps the pixels of a frame that is drawn again.
        for _ in 0..1 + dice.roll(3) {
            let pixels = run.frame(&stage, &cast.technique);
            let is_finite = |bits: &u32| f32::from_bits(*bits).is_finite();
            assert!(
                pixels.as_flattened().iter().all(is_finite),
                "frame {frame}: {}",
                stage.name
            );
            frame += 1;
        }
        assert_eq!(
            effect.pipelines(),
            warm,
            "frame {frame} made pipelines: {:?} of lights {chosen:?}",
            cast.technique
        );
        let half = usize::from(2 * frame > frames);
        largest[half] = largest[half].most(Held::now(gpu));
        if frame / 1000 > before / 1000 {
            eprintln!("frame {frame}: {:?}", largest[half]);
        }
    }
    let [first, second] = largest;
    eprintln!("{warm} pipelines, {frame} frames: {first:?}, then {second:?}");
    assert!(first.heap > 0 && first.device > 0, "{first:?}");
    assert!(
        second.heap <= first.heap + SLACK,
        "{first:?}, then {second:?}"
    );
    assert!(
        second.device <= first.device + SLACK,
        "{first:?}, then {second:?}"
    );
}

#[test]
fn nothing_grows() {
    if let Some(gpu) = device_or_skip("soak") {
        soak(gpu, &crowds(false, 1), 320);
    }
}

#[test]
#[ignore = "takes minutes"]
fn nothing_grows_in_ten_thousand_frames() {
    if let Some(gpu) = device_or_skip("long soak") {
        soak(gpu, &crowds(true, 2), 10_000);
    }
}

/// A device that is lost gives errors and no panic; a new device draws the same picture.
#[test]
fn a_lost_device_is_an_error_and_a_new_one_draws() {
    let Some(lost) = plain_device_or_skip("a lost device") else {
        return;
    };
    let (stage, min_max) = (with_lights(&crowd(), &[0, 1]), technique("min-max", &[]));
    let effect = on::effect(&lost);
    let mut run = Run::new(&lost, &effect, REUSE[1]);
    let picture = run.frame(&stage, &min_max);
    let errors = Arc::new(Mutex::new(Vec::new()));
    let heard = Arc::clone(&errors);
    lost.device.on_uncaptured_error(Arc::new(move |error| {
        heard.lock().expect("nobody panics").push(error.to_string());
    }));
    lost.device.destroy();
    let refused = run.prepare_with(&stage, &min_max, None);
    let output = run.view().output().texture().clone();
    let read = lost.read_texture::<[f32; 4]>(&output);
    // Preparing succeeds and does nothing, as all calls on a lost device; reading the picture fails.
    assert_eq!(refused, Ok(()));
    assert!(read.is_err());
    let errors = errors.lock().expect("nobody panics");
    let last = errors.last().expect("wgpu says what is wrong");
    assert!(last.contains("'read back' label is invalid"), "{last}");

    let Some(new) = plain_device_or_skip("a new device") else {
        return;
    };
    let effect = on::effect(&new);
    let mut run = Run::new(&new, &effect, REUSE[1]);
    assert_eq!(run.frame(&stage, &min_max), picture);
}
