//! The CPU's techniques against closed forms and against each other.

mod common;

use common::{
    SIZE, crowd, epipole_stages, fog_stages, perspective_stages, seam_errors, stages, steps, svd,
    technique,
};
use glam::{DVec3, Vec3};
use tyndall::{
    camera::CameraRays,
    cpu::{self, CpuInputs},
    frame::{Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase, Projection},
    light::light_radius,
    physics::{
        airlight::{AirlightTable, PointOnRay},
        transmittance::transmittance_integral,
    },
    techniques::{Technique, TechniqueChoice, Value},
};
use tyndall_testkit::metrics::compare;

const SHADOW_MAP: (&str, &str) = ("visibility", "shadow-map");

fn reference() -> Technique {
    let word = Value::Word(SHADOW_MAP.1.into());
    technique(
        "reference",
        &[(SHADOW_MAP.0, word), ("tolerance", Value::Real(1e-6))],
    )
}

fn simple(
    medium: MediumComponent,
    emitter: Emitter,
    technique: Technique,
) -> (Frame, TechniqueChoice) {
    let frame = Frame {
        camera: Camera::perspective(
            [0.0; 3],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            1.0,
            4.0 / 3.0,
            0.1,
            30.0,
        ),
        lights: vec![Light {
            emitter,
            shadow: None,
            texture: None,
        }],
        medium: Medium {
            components: vec![medium],
        },
    };
    (frame, technique.into())
}

fn render(frame: &(Frame, TechniqueChoice)) -> Vec<[f32; 4]> {
    attempt(frame).expect("a good frame")
}

/// The picture, or the words of a refusal.
fn attempt((frame, techniques): &(Frame, TechniqueChoice)) -> Result<Vec<[f32; 4]>, String> {
    let depth = common::depth(true);
    let inputs = CpuInputs {
        size: SIZE,
        depth: &depth,
        lights: &[Default::default()],
        occluders: None,
    };
    cpu::render(frame, &inputs, techniques, &|_, _| {})
        .map(|rendered| rendered.pixels)
        .map_err(|error| error.to_string())
}

/// Each pixel's ray, with the depth that `render` uses.
fn rays(camera: &Camera) -> Vec<tyndall::camera::Ray> {
    let rays = CameraRays::new(camera, SIZE);
    let depth = common::depth(true);
    (0..SIZE[0] * SIZE[1])
        .map(|i| rays.ray(i % SIZE[0], i / SIZE[0], depth[i as usize]))
        .collect()
}

#[test]
fn a_slab_in_the_sun_is_the_closed_form() {
    let direction = Vec3::new(0.2, -1.0, 0.4);
    let medium = MediumComponent {
        sigma_s: [0.05, 0.1, 0.2],
        sigma_a: [0.01, 0.0, 0.1],
        phase: Phase::HenyeyGreenstein { g: 0.4 },
    };
    let sun = Emitter::Directional {
        direction: direction.to_array(),
        illuminance: [3.0, 2.0, 1.0],
    };
    for technique in [reference(), technique("ray-march", &[steps(2000)])] {
        let name = technique.info().name;
        let frame = simple(medium, sun, technique);
        for (pixel, ray) in render(&frame).iter().zip(rays(&frame.0.camera)) {
            let cos_theta = -direction.normalize().as_dvec3().dot(ray.direction);
            for channel in 0..3 {
                let (s, a) = (
                    f64::from(medium.sigma_s[channel]),
                    f64::from(medium.sigma_a[channel]),
                );
                let exact = s
                    * medium.phase.evaluate(cos_theta)
                    * [3.0, 2.0, 1.0][channel]
                    * transmittance_integral(s + a, 0.0, ray.length);
                // f32 output: 6e-8; 2000 midpoint steps of 9 optical depths: 1e-6.
                assert!(
                    (f64::from(pixel[channel]) / exact - 1.0).abs() < 2e-6,
                    "{name}: {pixel:?} {exact}"
                );
            }
            let left = [0.06, 0.1, 0.3].map(|k: f64| (-k * ray.length).exp());
            let mean = left.iter().sum::<f64>() / 3.0;
            assert!((f64::from(pixel[3]) - mean).abs() < 1e-6);
        }
    }
}

/// An endless non-absorbing medium scatters all light there is: L -> E rho, whatever sigma_s.
#[test]
fn a_furnace_glows_by_its_phase_function() {
    for sigma_s in [5.0, 50.0] {
        let medium = MediumComponent {
            sigma_s: [sigma_s; 3],
            sigma_a: [0.0; 3],
            phase: Phase::Isotropic,
        };
        let sun = Emitter::Directional {
            direction: [0.0, -1.0, 0.0],
            illuminance: [1.0; 3],
        };
        for pixel in render(&simple(medium, sun, reference())) {
            let exact = 1.0 / (4.0 * std::f32::consts::PI);
            // The nearest wall is 3 m away: exp(-15).
            assert!((pixel[0] / exact - 1.0).abs() < 1e-6, "{pixel:?}");
        }
    }
}

#[test]
fn no_medium_scatters_nothing_and_lets_all_through() {
    for components in [
        Vec::new(),
        vec![MediumComponent {
            sigma_s: [0.0; 3],
            sigma_a: [0.0; 3],
            phase: Phase::Rayleigh,
        }],
    ] {
        let mut stage = crowd();
        stage.frame.medium = Medium { components };
        let lights = stage.cpu_lights();
        let inputs = CpuInputs {
            size: SIZE,
            depth: &stage.depth,
            lights: &lights,
            occluders: None,
        };
        let result = cpu::render(
            &stage.frame,
            &inputs,
            &TechniqueChoice::default(),
            &|_, _| {},
        )
        .expect("a good frame");
        assert!(result.pixels.iter().all(|p| *p == [0.0, 0.0, 0.0, 1.0]));
    }
}

#[test]
fn an_unshadowed_lamp_is_the_airlight_integral() {
    let medium = MediumComponent {
        sigma_s: [0.05, 0.1, 0.2],
        sigma_a: [0.01, 0.0, 0.1],
        phase: Phase::HenyeyGreenstein { g: 0.3 },
    };
    let table = AirlightTable::new(medium.phase);
    for position in [[0.5, 0.8, -6.0], [-3.0, 0.5, 4.0], [0.01, 0.02, 0.03]] {
        let lamp = Emitter::Point {
            position,
            intensity: [1.0; 3],
            radius: 0.0,
        };
        let frame = simple(medium, lamp, reference());
        for (pixel, ray) in render(&frame).iter().zip(rays(&frame.0.camera)) {
            let light = PointOnRay::new(
                DVec3::from(position.map(f64::from)) - ray.origin,
                ray.direction,
                light_radius(&lamp, &frame.0.camera),
            );
            for channel in 0..3 {
                let (s, a) = (
                    f64::from(medium.sigma_s[channel]),
                    f64::from(medium.sigma_a[channel]),
                );
                let exact = s * table.segment(s + a, light, [0.0, ray.length]);
                // The table's own error: 3e-4 of the whole ray; lamps behind the eye at three optical depths: 1e-3.
                assert!(
                    (f64::from(pixel[channel]) / exact - 1.0).abs() < 2e-3,
                    "{position:?} {pixel:?} {exact}"
                );
            }
        }
    }
}

/// Marching converges to the walk through the same map: its limit, found without steps.
#[test]
fn marching_converges_to_the_reference() {
    for stage in stages().into_iter().chain(fog_stages()) {
        let truth = stage.on_cpu(reference());
        let error = |n: i64, spacing: &str| {
            let spacing = ("spacing", Value::Word(spacing.into()));
            let march = stage.on_cpu(technique("ray-march", &[steps(n), spacing]));
            compare(&march, &truth).expect("same size").rel_mae
        };
        let (coarse, fine) = (error(64, "equal"), error(1024, "equal"));
        // Largest measured: 0.0026, a lamp in view. 16 times the steps leave a sixteenth of the error in the mean.
        assert!(fine < 0.005, "{}: {fine}", stage.name);
        assert!(
            fine < 0.3 * coarse + 1e-7,
            "{}: {coarse} {fine}",
            stage.name
        );
        let equiangular = error(1024, "equiangular");
        assert!(equiangular < 0.005, "{}: {equiangular}", stage.name);
    }
}

#[test]
fn lights_add_up() {
    let crowd = crowd();
    let all = crowd.on_cpu(technique("ray-march", &[steps(64)]));
    let mut sum = vec![[0.0; 3]; all.pixels().len()];
    for (light, pictures) in crowd.frame.lights.iter().zip(&crowd.lights) {
        let alone = common::Stage {
            name: String::new(),
            frame: Frame {
                lights: vec![*light],
                ..crowd.frame.clone()
            },
            depth: crowd.depth.clone(),
            lights: vec![pictures.clone()],
        };
        let one = alone.on_cpu(technique("ray-march", &[steps(64)]));
        for (sum, one) in sum.iter_mut().zip(one.pixels()) {
            *sum = std::array::from_fn(|i| sum[i] + one[i]);
        }
    }
    for (sum, all) in sum.iter().zip(all.pixels()) {
        for i in 0..3 {
            assert!((sum[i] - all[i]).abs() <= 1e-6 * all[i], "{sum:?} {all:?}");
        }
    }
}

fn fine(extra: &[(&'static str, Value)]) -> Vec<(&'static str, Value)> {
    let fine = [
        ("slices", Value::Integer(2000)),
        ("samples", Value::Integer(1000)),
    ];
    fine.iter().chain(extra).cloned().collect()
}

/// Whatever the number of slices and samples: what leaves cannot tell is walked.
#[test]
fn min_max_is_the_reference() {
    let coarse = [
        ("slices", Value::Integer(50)),
        ("samples", Value::Integer(64)),
    ];
    for stage in stages().into_iter().chain(fog_stages()) {
        let truth = stage.on_cpu(reference());
        for params in [&[][..], &coarse] {
            let found = stage.on_cpu(technique("min-max", params));
            let error = compare(&found, &truth).expect("same size").rel_mae;
            // The quadrature's own tolerance of 1e-3.
            assert!(error < 1e-3, "{}, {params:?}: {error}", stage.name);
        }
    }
}

/// Every phase function and a medium of many colours are among the stages.
#[test]
fn svd_agrees_with_the_closed_forms() {
    // Terms, and the bound of the error. Largest measured: 0.22, 0.069, 0.0177, 0.0039.
    let ranks = [(1, 0.3), (2, 0.08), (4, 0.02), (8, 0.005)];
    let mut worst_of_one = 0.0_f64;
    for stage in perspective_stages() {
        let analytic = stage.on_cpu(technique("min-max", &[]));
        let mut fewer = f64::INFINITY;
        for (rank, bound) in ranks {
            let found = stage.on_cpu(svd(rank));
            let error = compare(&found, &analytic).expect("same size").rel_mae;
            assert!(error < bound, "{}, {rank}: {error}", stage.name);
            // Where the terms are exact, there is left the interpolation between samples of the factors.
            let more_is_better = error <= fewer + 1e-4;
            assert!(more_is_better, "{}, {rank}: {error} {fewer}", stage.name);
            fewer = error;
            worst_of_one = worst_of_one.max(if rank == 1 { error } else { 0.0 });
        }
    }
    // One term is not enough: the integrator is not the analytic one.
    assert!(worst_of_one > 0.1, "{worst_of_one}");
}

/// Rays near the epipole are walked, the others go through trees: no seam between them.
#[test]
fn no_seam_about_the_epipole() {
    for (stage, axis) in epipole_stages() {
        let truth = stage.on_cpu(reference());
        let errors = seam_errors(&stage, axis, &truth, |t| stage.on_cpu(t));
        if stage.frame.lights[0].shadow.is_some() {
            let mut bare = stage.clone();
            (bare.frame.lights[0].shadow, bare.lights[0].shadow_map) = (None, None);
            let without = seam_errors(&stage, axis, &truth, |t| bare.on_cpu(t));
            let seen = without.iter().any(|(_, error)| *error > 1e-3);
            assert!(seen, "{}: shadows by the seam, {without:?}", stage.name);
        }
        for (radius, error) in errors {
            // Largest measured: 1.6e-9.
            assert!(error < 1e-6, "{}, {radius}: {error}", stage.name);
        }
    }
}

#[test]
fn svd_refuses_orthographic_cameras() {
    let mut stages = stages();
    stages.retain(|s| matches!(s.frame.camera.projection, Projection::Orthographic { .. }));
    for stage in stages {
        let frame = stage.frame.clone();
        let frame_by = TechniqueChoice::from(svd(4));
        let lights = stage.cpu_lights();
        let inputs = CpuInputs {
            size: SIZE,
            depth: &stage.depth,
            lights: &lights,
            occluders: None,
        };
        let refused = cpu::render(&frame, &inputs, &frame_by, &|_, _| {}).expect_err("refused");
        assert_eq!(
            refused.to_string(),
            "technique `min-max` cannot do the svd integrator with an orthographic camera"
        );
    }
}

#[test]
fn incremental_agrees_with_min_max() {
    let plain = |stage: &common::Stage| {
        let light = &stage.frame.lights[0];
        light.texture.is_none() && !matches!(light.emitter, Emitter::Spot { .. })
    };
    for stage in stages().into_iter().filter(plain) {
        let min_max = stage.on_cpu(technique("min-max", &fine(&[])));
        let rank = ("rank", Value::Integer(6));
        let found = stage.on_cpu(technique("incremental", &fine(&[rank])));
        let error = compare(&found, &min_max).expect("same size").rel_mae;
        // Largest measured: 0.0084, a lamp seen straight up; the low rank's own error.
        assert!(error < 0.012, "{}: {error}", stage.name);
    }
}

#[test]
fn an_eye_that_single_precision_cannot_hold_is_refused() {
    let mut frame = simple(
        MediumComponent {
            sigma_s: [0.1; 3],
            sigma_a: [0.0; 3],
            phase: Phase::Isotropic,
        },
        Emitter::Point {
            position: [0.0; 3],
            intensity: [1.0; 3],
            radius: 0.0,
        },
        reference(),
    );
    // The far plane is 30 m away.
    for (x, holds) in [(2.4e5, true), (-2.5e5, false)] {
        frame.0.camera.eye[0] = x;
        let refused = attempt(&frame).err();
        assert_eq!(refused.is_none(), holds, "{refused:?}");
        let names = |text: String| text.contains("camera.eye") && text.contains("relative to");
        assert!(refused.is_none_or(names));
    }
}

#[test]
fn a_spot_of_a_half_space_has_no_texture() {
    let mut stage = stages()
        .into_iter()
        .find(|stage| stage.name.starts_with("spot through a picture"))
        .expect("a spot with a texture");
    let mut refusal = |angle: f32| {
        if let Emitter::Spot { outer, .. } = &mut stage.frame.lights[0].emitter {
            *outer = angle;
        }
        let lights = stage.cpu_lights();
        let inputs = CpuInputs {
            size: SIZE,
            depth: &stage.depth,
            lights: &lights,
            occluders: None,
        };
        let techniques = TechniqueChoice::from(technique("ray-march", &[]));
        let result = cpu::render(&stage.frame, &inputs, &techniques, &|_, _| {});
        result.err().map(|error| error.to_string())
    };
    let half = std::f32::consts::FRAC_PI_2;
    assert_eq!(refusal(half.next_down()), None);
    let words = refusal(half).expect("refused");
    let expected = "`lights[0].emitter.outer` must be below pi/2 rad with a texture, ";
    assert!(words.starts_with(expected), "{words}");
    let words = refusal(half.next_up()).expect("refused");
    let expected = "`lights[0].emitter.outer` must be an angle above 0 and up to pi/2 rad, ";
    assert!(words.starts_with(expected), "{words}");
}
