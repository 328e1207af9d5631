//! A sun's map of what a camera sees.

use glam::{DVec2, Vec3, vec3};
use tyndall::{
    cpu::{self, CpuInputs, CpuLightInputs},
    frame::{Camera, Frame, Light, Medium, MediumComponent, Phase, ShadowProjection},
    techniques::{Technique, TechniqueChoice},
};

use super::{clip, sun};
use crate::{
    scene::Scene,
    shadow_fit::{Seen, fit, fit_seen},
    test_scenes::{block, opaque, quad},
    trace::Tracer,
};

/// A few metres of pillars and a roof on a plain that reaches so far to all sides \[m].
fn on_plain(reach: f32) -> Scene {
    let corner = vec3(-reach, 0.0, -reach);
    let plain = quad(corner, 2.0 * reach * Vec3::Z, 2.0 * reach * Vec3::X).to_vec();
    let pillar = |i: i32| {
        let foot = vec3(-3.0 + 1.5 * i as f32, 0.0, -1.0);
        block(foot, foot + vec3(0.4, 2.5, 0.4))
    };
    let roof = block(vec3(-4.0, 2.5, -2.0), vec3(1.0, 2.6, 0.5));
    let pillars = (0..4).flat_map(pillar);
    opaque(
        &plain
            .into_iter()
            .chain(pillars)
            .chain(roof)
            .collect::<Vec<_>>(),
    )
}

/// A camera whose far plane is behind the plain's farthest corner.
fn before_plain(eye: [f32; 3], reach: f32) -> Camera {
    let target = [-1.0, 1.8, -2.0];
    Camera::perspective(
        eye,
        target,
        [0.0, 1.0, 0.0],
        1.0,
        4.0 / 3.0,
        0.05,
        2.0 * reach,
    )
}

const EVENING: [f32; 3] = [0.8, -0.5, 0.1];

const IMAGE: [u32; 2] = [48, 36];

fn haze(sigma_s: f32) -> Medium {
    Medium {
        components: vec![MediumComponent {
            sigma_s: [sigma_s; 3],
            sigma_a: [0.1 * sigma_s; 3],
            phase: Phase::HenyeyGreenstein { g: 0.5 },
        }],
    }
}

fn fit_before(tracer: &Tracer, camera: &Camera, medium: &Medium) -> Option<ShadowProjection> {
    let seen = Seen {
        tracer,
        camera,
        medium,
        size: IMAGE,
    };
    fit_seen(tracer.geometry(), &sun(EVENING), &seen)
}

/// Relative error of in-scattered light by a map of 256^2 texels against traced shadows.
fn error_of_map(
    tracer: &Tracer,
    shadow: Option<ShadowProjection>,
    seen_by: (Camera, Medium),
) -> f64 {
    let (camera, medium) = seen_by;
    let (emitter, quiet) = (sun(EVENING), |_, _| ());
    let map = shadow.map(|p| tracer.shadow_map(&emitter, &p, [256; 2], &quiet));
    let depth = tracer.g_buffer(&camera, IMAGE, &quiet).depth;
    let light = Light {
        emitter,
        shadow,
        texture: None,
    };
    let frame = Frame {
        camera,
        lights: vec![light],
        medium,
    };
    let maps = CpuLightInputs {
        shadow_map: map.as_ref(),
        ..Default::default()
    };
    let inputs = CpuInputs {
        size: IMAGE,
        depth: &depth,
        lights: &[maps],
        occluders: Some(tracer),
    };
    let render = |technique: &str| {
        let techniques = TechniqueChoice::from(Technique::from_name(technique).unwrap());
        cpu::render(&frame, &inputs, &techniques, &quiet)
            .unwrap()
            .pixels
    };
    let values = |pixels: Vec<[f32; 4]>| pixels.into_iter().flat_map(|p| [p[0], p[1], p[2]]);
    let (found, truth) = (render("min-max"), render("reference"));
    let apart: f32 = values(found)
        .zip(values(truth.clone()))
        .map(|(a, b)| (a - b).abs())
        .sum();
    f64::from(apart / values(truth).sum::<f32>())
}

#[test]
fn a_plain_of_any_size_costs_no_texels() {
    let views = [
        ([1.5, 1.6, 4.5], 0.06),
        ([-6.0, 0.4, 3.0], 0.02),
        ([2.0, 9.0, 8.0], 0.003),
    ];
    for (eye, sigma_s) in views {
        for reach in [50.0, 1000.0, 20_000.0] {
            let tracer = Tracer::new(&on_plain(reach));
            let (camera, medium) = (before_plain(eye, reach), haze(sigma_s));
            let of = |shadow| error_of_map(&tracer, shadow, (camera, medium.clone()));
            let seen = of(fit_before(&tracer, &camera, &medium));
            // Measured: 1.7e-4, 4e-5 and 3e-5 of the three views, whatever the plain's size; 0.03 to 0.35 round the whole scene.
            assert!(seen < 3.6e-4, "{eye:?}, {reach} m: {seen}");
            if reach > 100.0 {
                let whole = of(fit(tracer.geometry(), &sun(EVENING)));
                assert!(whole > 10.0 * seen, "{eye:?}, {reach} m: {whole}");
            }
        }
    }
}

#[test]
fn the_map_of_what_is_seen_holds_all_depths_over_it() {
    let scene = on_plain(5000.0);
    let tracer = Tracer::new(&scene);
    let projection = fit_before(&tracer, &before_plain([1.5, 1.6, 4.5], 5000.0), &haze(0.05));
    let projection = projection.unwrap();
    let places = tracer.geometry().positions.iter().flat_map(|triangle| {
        (0..=100).map(|i| triangle[0].lerp(triangle[1].lerp(triangle[2], 0.37), i as f32 / 100.0))
    });
    let mut held = 0;
    for point in places {
        let clip = clip(&projection, point);
        if clip.truncate().truncate().abs().max_element() <= 1.0 {
            held += 1;
            assert!((0.0..=1.0).contains(&clip.z), "{point}: {clip}");
        }
    }
    assert!(held > 500, "{held}");
}

/// Maps move by whole texels, and seldom.
#[test]
fn maps_of_what_is_seen_move_in_steps() {
    let scene = on_plain(1000.0);
    let tracer = Tracer::new(&scene);
    let maps: Vec<_> = (0..40)
        .map(|i| {
            let camera = before_plain([1.5 + 0.02 * i as f32, 1.6, 4.5], 1000.0);
            fit_before(&tracer, &camera, &haze(0.05)).unwrap()
        })
        .collect();
    let moved: Vec<_> = maps.windows(2).filter(|pair| pair[0] != pair[1]).collect();
    assert!(moved.len() < 8, "{} of 39", moved.len());
    // The same place on both, in texels of a map of 1024; a scale that stays moves by whole ones.
    let texel = |map, point| 512.0 * DVec2::new(clip(map, point).x, clip(map, point).y);
    let far_apart = [Vec3::ZERO, vec3(5.0, 0.0, 0.0)];
    for pair in &moved {
        let [a, b] = far_apart.map(|p| texel(&pair[0], p) - texel(&pair[1], p));
        if (a - b).length() < 1e-3 {
            assert!((a - a.round()).length() < 0.02, "{a}");
        }
    }
}

#[test]
fn a_scene_that_is_seen_as_a_whole_has_the_whole_scene_s_map() {
    let scene = opaque(
        &[
            block(vec3(-2.0, 0.0, -2.0), vec3(2.0, 0.1, 2.0)),
            block(vec3(-1.5, 1.0, -1.5), vec3(1.5, 1.1, 1.5)),
        ]
        .concat(),
    );
    let tracer = Tracer::new(&scene);
    let whole = fit(tracer.geometry(), &sun(EVENING));
    let camera = before_plain([6.0, 2.0, 6.0], 10.0);
    assert_eq!(fit_before(&tracer, &camera, &haze(0.05)), whole);
    // So has a camera that sees no shadow at all, and one that sees nothing.
    let away = Camera::perspective(
        [6.0, 2.0, 6.0],
        [20.0, 9.0, 20.0],
        [0.0, 1.0, 0.0],
        1.0,
        1.0,
        0.1,
        20.0,
    );
    assert_eq!(fit_before(&tracer, &away, &haze(0.05)), whole);
    let clear = Medium { components: vec![] };
    assert_eq!(fit_before(&tracer, &away, &clear), whole);
}
