//! Temporal reuse: whatever is kept is bit by bit what computing it again gives.

mod common;

use common::{SIZE, Stage, crowd, gpu as on, noise, run::Run, stages, steps, svd, technique};
use tyndall::{
    Occluder, OccluderMesh,
    techniques::{Technique, Value},
    temporal::{Reuse, ReuseMask, ReuseShow},
};
use tyndall_testkit::device::device_or_skip;

const PIXELS: u32 = SIZE[0] * SIZE[1];

/// Another depth in a small rectangle of a picture of this width.
fn scratch(values: &mut [f32], width: u32, seed: u32) {
    let height = values.len() as u32 / width;
    let side = 1 + (noise(seed) * 5.0) as u32;
    let [x, y] =
        [(seed + 1, width), (seed + 2, height)].map(|(seed, n)| (noise(seed) * n as f32) as u32);
    for row in y..(y + side).min(height) {
        for column in x..(x + side).min(width) {
            let value = &mut values[(row * width + column) as usize];
            *value = if noise(seed + 3) < 0.3 {
                0.0
            } else {
                *value * (0.5 + noise(seed + 4))
            };
            *value = value.clamp(0.0, 1.0);
        }
    }
}

/// Something moves: a few texels of one light's map, and, every second frame, of the depth buffer.
fn disturb(stage: &mut Stage, seed: u32) {
    let light = seed as usize % stage.lights.len();
    if let Some(map) = &mut stage.lights[light].shadow_map {
        scratch(&mut map.depth, map.size[0], 31 * seed);
    }
    if seed.is_multiple_of(2) {
        scratch(&mut stage.depth, SIZE[0], 17 * seed + 5);
    }
}

fn assert_same(kept: &[[u32; 4]], fresh: &[[u32; 4]], what: &str) {
    let differ: Vec<usize> = (0..fresh.len()).filter(|i| kept[*i] != fresh[*i]).collect();
    let first = differ.first().map(|i| {
        let values = [kept[*i], fresh[*i]].map(|p| p.map(f32::from_bits));
        (i % SIZE[0] as usize, i / SIZE[0] as usize, values)
    });
    assert!(
        differ.is_empty(),
        "{what}: {} pixels differ, the first {first:?}",
        differ.len()
    );
}

fn techniques() -> [Technique; 6] {
    [
        technique("ray-march", &[steps(48)]),
        technique("min-max", &[]),
        technique("hybrid", &[steps(48)]),
        technique(
            "epipolar",
            &[
                ("slices", Value::Integer(64)),
                ("samples", Value::Integer(32)),
            ],
        ),
        technique("min-max", &[("slices", Value::Integer(16))]),
        svd(4),
    ]
}

/// Stages without glass, whose pixels are all stale unless the maps' revision stays.
fn clear_stages() -> Vec<Stage> {
    let mut stages = stages();
    for stage in &mut stages {
        stage.lights[0].glass = None;
    }
    stages
}

#[test]
fn kept_pixels_equal_computed_ones() {
    let Some(gpu) = device_or_skip("temporal reuse") else {
        return;
    };
    let effect = on::effect(gpu);
    let (mut computed, mut all) = (0, 0);
    for (i, stage) in clear_stages().into_iter().enumerate() {
        for (k, technique) in techniques().iter().enumerate() {
            // Every light meets every technique, with cameras in turn.
            if (i + i / 6 + k) % 6 != 0 {
                continue;
            }
            let is_flat = stage.name.contains("orthographic");
            if k == 5 && is_flat {
                // Refused.
                continue;
            }
            let mut stage = stage.clone();
            let mut run = Run::new(gpu, &effect, Some(Reuse::default()));
            for frame in 0..4 {
                let kept = run.frame(&stage, technique);
                let fresh = Run::new(gpu, &effect, None).frame(&stage, technique);
                assert_same(
                    &kept,
                    &fresh,
                    &format!("{}, {technique:?}, frame {frame}", stage.name),
                );
                if frame == 0 {
                    assert_eq!(run.stale(), [PIXELS]);
                } else if k == 0 {
                    computed += run.stale()[0];
                    all += PIXELS;
                }
                disturb(&mut stage, frame + 10 * i as u32);
            }
        }
    }
    // Measured: 0.58. Tiles of 8 x 8 pixels are a large part of so small a picture, blocks of 8 x 8 texels of such maps.
    println!("{computed} of {all} pixels computed");
    assert!(
        computed > 0 && 4 * computed < 3 * all,
        "{computed} of {all}"
    );
}

#[test]
fn lights_that_stay_are_kept_whole() {
    let Some(gpu) = device_or_skip("reuse of several lights") else {
        return;
    };
    let effect = on::effect(gpu);
    let mut stage = crowd();
    // A texture that is uploaded anew in each frame is another one.
    let plain = |light: &tyndall::frame::Light| light.texture.is_none();
    let is_plain: Vec<bool> = stage.frame.lights.iter().map(plain).collect();
    let mut keep = is_plain.iter();
    stage.lights.retain(|_| *keep.next().expect("as many"));
    stage.frame.lights.retain(plain);
    for light in &mut stage.lights {
        light.glass = None;
    }
    let technique = technique("ray-march", &[steps(32)]);
    let mut run = Run::new(gpu, &effect, Some(Reuse::default()));
    run.frame(&stage, &technique);
    for changed in [0, 2, 4] {
        let map = stage.lights[changed]
            .shadow_map
            .as_mut()
            .expect("it has one");
        let row = map.size[0] as usize;
        for depth in &mut map.depth[20 * row..24 * row] {
            *depth = 0.5 * *depth + 0.01;
        }
        let kept = run.frame(&stage, &technique);
        let fresh = Run::new(gpu, &effect, None).frame(&stage, &technique);
        assert_same(&kept, &fresh, &format!("light {changed}"));
        for (light, stale) in run.stale().into_iter().enumerate() {
            assert_eq!(
                stale > 0,
                light == changed,
                "light {light} of {changed}: {stale}"
            );
        }
    }
}

#[test]
fn whatever_else_changes_makes_all_pixels_stale() {
    let Some(gpu) = device_or_skip("staleness of all pixels") else {
        return;
    };
    let effect = on::effect(gpu);
    let march = technique("ray-march", &[steps(16)]);
    let mut stage = clear_stages().swap_remove(0);
    let mut run = Run::new(gpu, &effect, Some(Reuse::default()));
    let mut stale = |stage: &Stage, technique: &Technique| {
        let kept = run.frame(stage, technique);
        assert_same(
            &kept,
            &Run::new(gpu, &effect, None).frame(stage, technique),
            "changed",
        );
        run.stale()[0]
    };
    assert_eq!(stale(&stage, &march), PIXELS);
    assert_eq!(stale(&stage, &march), 0);
    stage.frame.camera.eye[0] += 0.1;
    assert_eq!(stale(&stage, &march), PIXELS, "camera");
    assert_eq!(stale(&stage, &march), 0);
    stage.frame.medium.components[0].sigma_a[1] += 0.01;
    assert_eq!(stale(&stage, &march), PIXELS, "medium");
    let tyndall::frame::Emitter::Directional { illuminance, .. } =
        &mut stage.frame.lights[0].emitter
    else {
        unreachable!("the first stage has a sun");
    };
    illuminance[2] += 1.0;
    assert_eq!(stale(&stage, &march), PIXELS, "light");
    assert_eq!(stale(&stage, &march), 0);
    assert_eq!(
        stale(&stage, &technique("ray-march", &[steps(17)])),
        PIXELS,
        "technique"
    );
}

/// A frame that was prepared and never recorded leaves nothing behind.
#[test]
fn frames_that_are_not_recorded_do_not_count() {
    let Some(gpu) = device_or_skip("frames that are not recorded") else {
        return;
    };
    let effect = on::effect(gpu);
    let march = technique("ray-march", &[steps(16)]);
    let mut stage = clear_stages().swap_remove(0);
    let mut run = Run::new(gpu, &effect, Some(Reuse::default()));
    run.frame(&stage, &march);
    let before = stage.frame.camera.eye;
    stage.frame.camera.eye[1] += 0.5;
    disturb(&mut stage, 8);
    run.prepare(&stage, &march);
    stage.frame.camera.eye = before;
    disturb(&mut stage, 4);
    let kept = run.frame(&stage, &march);
    assert_same(
        &kept,
        &Run::new(gpu, &effect, None).frame(&stage, &march),
        "after",
    );
}

/// All pixels every `frames` + 1 frames, and where the mask covers too much, no mask for a while.
#[test]
fn reuse_is_limited_and_switches_itself_off() {
    let Some(gpu) = device_or_skip("limits of reuse") else {
        return;
    };
    let effect = on::effect(gpu);
    let march = technique("ray-march", &[steps(8)]);
    let stage = clear_stages().swap_remove(0);
    let limited = Reuse {
        frames: Some(2),
        ..Reuse::default()
    };
    let mut run = Run::new(gpu, &effect, Some(limited));
    let stale: Vec<u32> = (0..7)
        .map(|_| {
            run.frame(&stage, &march);
            run.stale()[0]
        })
        .collect();
    assert_eq!(stale, [PIXELS, 0, 0, PIXELS, 0, 0, PIXELS]);

    let mut run = Run::new(gpu, &effect, Some(Reuse::default()));
    let mut stage = stage;
    let mut frame = |run: &mut Run<'_>, moves: bool| {
        if moves {
            stage.depth.iter_mut().for_each(|depth| *depth *= 0.999);
        }
        let kept = run.frame(&stage, &march);
        assert_same(
            &kept,
            &Run::new(gpu, &effect, None).frame(&stage, &march),
            "off",
        );
        run.stale()[0]
    };
    for _ in 0..4 {
        // The far plane stays where it is.
        assert!(frame(&mut run, true) >= PIXELS - 64);
    }
    // Nothing moves any more: it takes a while until anybody asks.
    let quiet: Vec<u32> = (0..40).map(|_| frame(&mut run, false)).collect();
    let first = quiet
        .iter()
        .position(|stale| *stale == 0)
        .expect("asked again");
    assert!((20..32).contains(&first), "{quiet:?}");
    assert!(quiet[first..].iter().all(|stale| *stale == 0), "{quiet:?}");
}

/// The thesis's mask: what moved and its shadow volumes, where they were and where they are.
#[test]
fn moving_occluders_are_drawn_twice() {
    let Some(gpu) = device_or_skip("the geometry's mask") else {
        return;
    };
    let effect = on::effect(gpu);
    let march = technique("ray-march", &[steps(8)]);
    let corners = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.2]];
    let mesh = OccluderMesh::new(&gpu.device, &corners, &[0, 1, 2]).expect("a good mesh");
    let at = |x: f32| Occluder {
        mesh: &mesh,
        world_from_mesh: [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [x, 0.5, 1.0, 1.0],
        ],
    };
    let geometry = Reuse {
        mask: ReuseMask::Geometry,
        ..Reuse::default()
    };
    let plain = clear_stages()
        .into_iter()
        .filter(|stage| stage.lights[0].texture.is_none());
    for stage in plain.step_by(8) {
        let mut run = Run::new(gpu, &effect, Some(geometry));
        let refused = run
            .prepare_with(&stage, &march, None)
            .expect_err("no occluders");
        let expected = "`inputs.lights[0].occluders` is missing: the mask is drawn from what moves";
        assert_eq!(refused.to_string(), expected);
        let mut stale = |places: &[f32]| {
            let occluders: Vec<Occluder<'_>> = places.iter().map(|x| at(*x)).collect();
            run.prepare_with(&stage, &march, Some(&occluders))
                .expect("a good stage");
            run.record();
            run.stale()[0]
        };
        assert_eq!(stale(&[0.0, 1.0]), PIXELS, "{}", stage.name);
        assert_eq!(stale(&[0.0, 1.0]), 0, "{}", stage.name);
        let [near, far, both] = [&[0.1, 1.0][..], &[0.1, -2.0], &[0.3, -1.0]].map(&mut stale);
        assert!(near > 0 && near < PIXELS / 2, "{}: {near}", stage.name);
        assert!(
            far > 0 && both > far / 2 && both < PIXELS,
            "{}: {far} {both}",
            stage.name
        );
        // One that vanishes was somewhere.
        assert!(stale(&[0.3]) > 0, "{}", stage.name);
        assert_eq!(stale(&[0.3]), 0, "{}", stage.name);
    }
}

#[test]
fn views_of_mask_and_age_show_what_was_computed() {
    let Some(gpu) = device_or_skip("views of temporal reuse") else {
        return;
    };
    let effect = on::effect(gpu);
    let march = technique("ray-march", &[steps(8)]);
    let mut stage = clear_stages().swap_remove(0);
    let mut runs = [ReuseShow::Mask, ReuseShow::Age].map(|show| {
        let shown = Reuse {
            show,
            ..Reuse::default()
        };
        Run::new(gpu, &effect, Some(shown))
    });
    for frame in 0..3 {
        let [mask, age] = runs.each_mut().map(|run| run.frame(&stage, &march));
        let computed = |pixel: &&[u32; 4]| f32::from_bits(pixel[0]) == 1.0;
        let stale = runs[0].stale()[0] as usize;
        assert_eq!(mask.iter().filter(computed).count(), stale, "{frame}");
        let now = |pixel: &&[u32; 4]| f32::from_bits(pixel[2]) == 1.0;
        assert_eq!(age.iter().filter(now).count(), stale, "{frame}");
        // Kept pixels are a thirty-second redder each frame.
        let oldest = age
            .iter()
            .map(|pixel| f32::from_bits(pixel[0]))
            .fold(0.0, f32::max);
        assert_eq!(oldest, frame as f32 / 32.0);
        stage.depth[0] *= 0.9;
    }
}

/// Data derived from a map for the frame before is there still when passes that would derive it again are left out.
#[test]
fn revisions_and_reuse_go_together() {
    let Some(gpu) = device_or_skip("revisions and reuse") else {
        return;
    };
    let effect = on::effect(gpu);
    for technique in [technique("min-max", &[]), technique("light-volume", &[])] {
        let mut stage = clear_stages().swap_remove(0);
        let mut run = Run::new(gpu, &effect, Some(Reuse::default()));
        // The map's revision, and whether map and depth change before the frame.
        for (revision, map, depth) in [
            (1, false, false),
            (1, false, false),
            (2, true, false),
            (2, false, true),
            (3, false, false),
            (3, false, true),
            (4, true, true),
        ] {
            if map {
                let map = stage.lights[0].shadow_map.as_mut().expect("it has one");
                scratch(&mut map.depth, map.size[0], 7 * revision as u32);
            }
            if depth {
                scratch(&mut stage.depth, SIZE[0], 3 * revision as u32);
            }
            run.revision = Some(revision);
            let kept = run.frame(&stage, &technique);
            let fresh = Run::new(gpu, &effect, None).frame(&stage, &technique);
            assert_same(
                &kept,
                &fresh,
                &format!("{technique:?}, {revision}, {map}, {depth}"),
            );
        }
    }
}
