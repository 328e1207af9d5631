//! Images of small scenes against closed forms.

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3, vec3};
use tyndall::{
    camera::CameraRays,
    cpu::CpuLightInputs,
    frame::{Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase},
    light::LightModel,
    physics::medium::Optics,
};

use super::{AMBIENT, AMBIENT_TILT, SKY_HORIZON, SKY_ZENITH, shade, sky::sky, surface::vector};
use crate::{
    geometry::Geometry,
    scene::{Blocking, Scene},
    shadow_fit,
    test_scenes::{ball, block, material, opaque, quad, scene},
    trace::{GLASS_LAYERS, Tracer},
};

/// Ambient share of a surface that faces up: the ground.
const AMBIENT_UP: f64 = AMBIENT * (1.0 + AMBIENT_TILT);

const SIZE: [u32; 2] = [48, 48];

/// Looks down from y = 6 onto 6 x 6 m of the ground.
fn from_above() -> Camera {
    let half = 0.5_f32;
    Camera::perspective(
        [0.0, 6.0, 0.0],
        [0.0; 3],
        [0.0, 0.0, -1.0],
        2.0 * half.atan(),
        1.0,
        0.1,
        50.0,
    )
}

fn ground() -> Vec<[Vec3; 3]> {
    quad(vec3(-20.0, 0.0, -20.0), 40.0 * Vec3::X, 40.0 * Vec3::Z).to_vec()
}

fn light(emitter: Emitter) -> Light {
    Light {
        emitter,
        shadow: None,
        texture: None,
    }
}

fn frame(lights: Vec<Light>, sigma_a: f32) -> Frame {
    Frame {
        camera: from_above(),
        lights,
        medium: Medium {
            components: vec![MediumComponent {
                sigma_s: [0.0; 3],
                sigma_a: [sigma_a; 3],
                phase: Phase::Isotropic,
            }],
        },
    }
}

/// The image of a scene under one light with its fitted map of `texels` a side; without a map it is unblocked, but for a
/// rectangle.
fn image(scene: &Scene, emitter: Emitter, texels: Option<u32>, sigma_a: f32) -> Vec<DVec3> {
    let tracer = Tracer::new(scene);
    let mut light = light(emitter);
    light.shadow = texels.and_then(|_| shadow_fit::fit(tracer.geometry(), &emitter));
    let map_size = [texels.unwrap_or(1); 2];
    let quiet = |_, _| ();
    let map = light
        .shadow
        .map(|p| tracer.shadow_map(&emitter, &p, map_size, &quiet));
    let glass = light
        .shadow
        .and_then(|p| tracer.glass_map(&emitter, &p, map_size, GLASS_LAYERS, &quiet));
    let inputs = CpuLightInputs {
        shadow_map: map.as_ref(),
        glass: glass.as_ref(),
        texture: None,
    };
    let frame = frame(vec![light], sigma_a);
    let g_buffer = tracer.g_buffer(&frame.camera, SIZE, &quiet);
    let traced = texels.is_some() || matches!(emitter, Emitter::Rect { .. });
    let image = shade(&g_buffer, &frame, &[inputs], traced.then_some(&tracer));
    assert!(image.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    image.into_iter().map(vector).collect()
}

/// World-space point of the ground at a pixel.
fn ground_point(pixel: usize) -> DVec3 {
    let ray = CameraRays::new(&from_above(), SIZE).ray(pixel as u32 % 48, pixel as u32 / 48, 0.0);
    ray.at(ray.origin.y / -ray.direction.y)
}

const SUN: Emitter = Emitter::Directional {
    direction: [0.6, -0.8, 0.0],
    illuminance: [10.0, 5.0, 2.0],
};

#[test]
fn unblocked_ground_is_lambert_s() {
    let spot_axis = DVec3::new(0.0, -1.0, 0.0);
    let (inner, outer) = (0.3_f32, 0.6_f32);
    let lamp = DVec3::new(0.5, 3.0, -0.5);
    let position = [0.5, 3.0, -0.5];
    let spot = Emitter::Spot {
        position,
        direction: [0.0, -2.0, 0.0],
        intensity: [7.0; 3],
        inner,
        outer,
        radius: 0.0,
    };
    let point = Emitter::Point {
        position,
        intensity: [7.0; 3],
        radius: 0.0,
    };
    let falloff = |to: DVec3| {
        let (c, i, o) = (
            to.dot(spot_axis),
            f64::from(inner).cos(),
            f64::from(outer).cos(),
        );
        ((c - o) / (i - o)).clamp(0.0, 1.0).powi(2)
    };
    let local = |p: DVec3, cone: bool| {
        let d = (p - lamp).length();
        let to = (p - lamp) / d;
        let irradiance = 7.0 * (-0.1 * d).exp() / (d * d);
        irradiance * (-to.y * if cone { falloff(to) } else { 1.0 } + AMBIENT_UP)
    };
    type Expected<'a> = &'a dyn Fn(DVec3) -> f64;
    let cases: [(Emitter, Expected<'_>); 3] = [
        (SUN, &|_| 10.0 * (0.8 + AMBIENT_UP)),
        (point, &|p| local(p, false)),
        (spot, &|p| local(p, true)),
    ];
    for (emitter, expected) in cases {
        // With its own shadow map as well: the ground must not shadow itself.
        for texels in [None, Some(64)] {
            for (pixel, found) in image(&opaque(&ground()), emitter, texels, 0.1)
                .iter()
                .enumerate()
            {
                let expected = 0.5 / PI * expected(ground_point(pixel));
                // Measured: 1.1e-6; parameters are f32.
                assert!(
                    (found.x / expected - 1.0).abs() < 4e-6,
                    "{emitter:?}: {}, {expected}",
                    found.x
                );
            }
        }
    }
}

#[test]
fn shadows_have_the_place_and_size_of_their_blocker() {
    let plate = quad(vec3(-1.0, 2.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z);
    let with_plate = opaque(&[ground(), plate.to_vec()].concat());
    let ambient = 0.5 / PI * 10.0 * AMBIENT_UP;
    let lit = 0.5 / PI * 10.0 * (0.8 + AMBIENT_UP);
    let found = image(&with_plate, SUN, Some(2048), 0.0);
    let mut counts = [0; 2];
    for (pixel, value) in found.iter().enumerate() {
        let p = ground_point(pixel);
        // The plate hides a square of 3 m of the ground itself; its shadow is 1.5 m to the right.
        if p.x.abs().max(p.z.abs()) < 1.55 {
            continue;
        }
        let outside = (p.x - 1.5).abs().max(p.z.abs()) - 1.0;
        // The map covers 40 m: half a shadow border is two texels of 20 mm.
        if outside.abs() < 0.05 {
            continue;
        }
        let expected = if outside < 0.0 { ambient } else { lit };
        counts[usize::from(outside < 0.0)] += 1;
        assert!(
            (value.x / expected - 1.0).abs() < 1e-5,
            "at {p}: {} for {expected}",
            value.x
        );
    }
    assert!(counts[0] > 1000 && counts[1] > 100, "{counts:?}");
}

#[test]
fn curved_and_flat_surfaces_do_not_shadow_themselves() {
    for emitter in [
        SUN,
        Emitter::Point {
            position: [1.0, 5.0, 2.0],
            intensity: [9.0; 3],
            radius: 0.0,
        },
    ] {
        let round = opaque(&[ground(), ball(0.8 * Vec3::Y, 0.8, 48)].concat());
        let (with, without) = (
            image(&round, emitter, Some(512), 0.0),
            image(&round, emitter, None, 0.0),
        );
        let tracer = Tracer::new(&round);
        let g_buffer = tracer.g_buffer(&from_above(), SIZE, &|_, _| ());
        let source = LightModel::samples(&light(emitter), &from_above(), None).remove(0);
        let mut acne = 0;
        let mut compared = 0;
        for (pixel, (with, without)) in with.iter().zip(&without).enumerate() {
            let ray = CameraRays::new(&from_above(), SIZE).ray(
                pixel as u32 % 48,
                pixel as u32 / 48,
                g_buffer.depth[pixel],
            );
            let normal = vector(g_buffer.normal[pixel]);
            let incident =
                source.incident(ray.at(ray.length), &Optics::new(&frame(vec![], 0.0).medium));
            // On the ball's lit side, the first thing light meets.
            if ray.at(ray.length).y > 0.01 && -normal.dot(incident.direction) > 0.15 {
                compared += 1;
                acne += usize::from((with.x / without.x - 1.0).abs() > 1e-6);
            }
        }
        assert!(compared > 80, "only {compared} pixels of the ball");
        assert_eq!(acne, 0, "{emitter:?}: of {compared}");
    }
}

#[test]
fn glass_colours_the_ground() {
    let pane = quad(vec3(-2.0, 2.0, -2.0), 4.0 * Vec3::X, 4.0 * Vec3::Z);
    let red = material(
        Blocking::Transmissive { transmission: 1.0 },
        [0.8, 0.1, 0.2, 1.0],
    );
    let mut both = scene(&pane, |_| Vec2::ZERO, red, None);
    let mut floor = opaque(&ground());
    floor.meshes[0].primitives[0].material = 1;
    both.materials.extend(floor.materials);
    both.meshes[0]
        .primitives
        .extend(floor.meshes.remove(0).primitives);
    let found = image(&both, SUN, Some(256), 0.0);
    // Seen through the pane and lit through it: the middle of the image.
    let expected =
        0.5 / PI * DVec3::new(10.0, 5.0, 2.0) * (0.8 * DVec3::new(0.8, 0.1, 0.2) + AMBIENT_UP);
    let expected = DVec3::new(0.8, 0.1, 0.2) * expected;
    let middle = found[24 * 48 + 24];
    assert!(
        (middle / expected - 1.0).abs().max_element() < 1e-5,
        "{middle}, {expected}"
    );
}

#[test]
fn the_sky_follows_the_sun() {
    let empty = image(&Scene::default(), SUN, Some(16), 0.0);
    let below = DVec3::from(SKY_HORIZON) * DVec3::new(10.0, 5.0, 2.0);
    assert!(empty.iter().all(|found| (*found - below).length() < 1e-6));
    let lamp = Emitter::Point {
        position: [0.0; 3],
        intensity: [1.0; 3],
        radius: 0.0,
    };
    assert!(
        image(&Scene::default(), lamp, Some(16), 0.0)
            .iter()
            .all(|found| *found == DVec3::ZERO)
    );
    assert_eq!(sky(DVec3::Y, DVec3::ONE), DVec3::from(SKY_ZENITH));
}

#[test]
fn a_rectangle_is_a_point_from_afar() {
    let height = 40.0;
    let rect = Emitter::Rect {
        center: [0.0, height, 0.0],
        edge_x: [0.5, 0.0, 0.0],
        edge_y: [0.0, 0.0, 0.5],
        radiance: [100.0; 3],
        samples: 256,
    };
    let found = image(&opaque(&ground()), rect, None, 0.0)[24 * 48 + 24];
    // cross(edge_x, edge_y) points down: the ground is on the bright side.
    let expected = 0.5 / PI * 25.0 / f64::from(height * height) * (1.0 + AMBIENT_UP);
    assert!(
        (found.x / expected - 1.0).abs() < 1e-3,
        "{}, {expected}",
        found.x
    );
}

/// Under a plate that hides it: dark in the middle, half lit where the plate's edge halves it, lit far away.
#[test]
fn a_rectangle_casts_a_soft_shadow() {
    let rect = Emitter::Rect {
        center: [0.0, 10.0, 0.0],
        edge_x: [0.2, 0.0, 0.0],
        edge_y: [0.0, 0.0, 0.2],
        radiance: [100.0; 3],
        samples: 256,
    };
    // Above the camera, so that it hides nothing of the ground.
    let plate = quad(vec3(-0.1, 8.0, -0.1), 0.2 * Vec3::X, 0.2 * Vec3::Z);
    let open = image(&opaque(&ground()), rect, None, 0.0);
    let hidden = image(
        &opaque(&[ground(), plate.to_vec()].concat()),
        rect,
        None,
        0.0,
    );
    let seen = |x: f64| {
        let pixel = (0..hidden.len())
            .min_by_key(|i| (1e6 * (ground_point(*i) - DVec3::new(x, 0.0, 0.0)).length()) as u64)
            .unwrap();
        let ambient = AMBIENT_UP / (1.0 + AMBIENT_UP);
        (hidden[pixel].x / open[pixel].x - ambient) / (1.0 - ambient)
    };
    // The umbra ends at 0.1, the penumbra at 0.9; pixels are 0.125 m.
    assert!(seen(0.0).abs() < 0.01, "{}", seen(0.0));
    assert!((seen(0.5) - 0.5).abs() < 0.15, "{}", seen(0.5));
    assert!((seen(2.0) - 1.0).abs() < 1e-6, "{}", seen(2.0));
}

#[test]
fn a_light_inside_a_corner_stays_finite() {
    let room = block(vec3(-2.0, 0.0, -2.0), vec3(2.0, 5.9, 2.0));
    for position in [[0.0, 0.0, 0.0], [-2.0, 0.0, -2.0], [0.0, 5.9, 0.0]] {
        image(
            &opaque(&room),
            Emitter::Point {
                position,
                intensity: [1.0; 3],
                radius: 0.0,
            },
            Some(32),
            0.0,
        );
    }
    assert!(Geometry::new(&opaque(&room)).bounds().is_some());
}

/// Without a map a light's shadows are traced, sharp and of no texels: those of a fine map but for its borders.
#[test]
fn without_a_map_all_lights_are_traced() {
    let plate = quad(vec3(-1.0, 2.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z);
    let scene = opaque(&[ground(), plate.to_vec()].concat());
    let tracer = Tracer::new(&scene);
    let g_buffer = tracer.g_buffer(&from_above(), SIZE, &|_, _| ());
    let (position, intensity) = ([0.5, 5.0, -0.5], [90.0; 3]);
    let lamp = Emitter::Point {
        position,
        intensity,
        radius: 0.0,
    };
    let spot = Emitter::Spot {
        position,
        direction: [0.0, -1.0, 0.0],
        intensity,
        inner: 0.5,
        outer: 0.9,
        radius: 0.0,
    };
    for emitter in [SUN, lamp, spot] {
        let traced = shade(
            &g_buffer,
            &frame(vec![light(emitter)], 0.0),
            &[CpuLightInputs::default()],
            Some(&tracer),
        );
        let mapped = image(&scene, emitter, Some(2048), 0.0);
        let open = image(&scene, emitter, None, 0.0);
        let differs = |a: DVec3, b: DVec3| (a - b).length() > 1e-4 * a.max(b).length();
        let count = |of: &dyn Fn(usize) -> bool| (0..open.len()).filter(|&i| of(i)).count();
        let shaded = count(&|i| differs(vector(traced[i]), open[i]));
        let apart = count(&|i| differs(vector(traced[i]), mapped[i]));
        assert!(
            shaded > 100 && apart < shaded / 10,
            "{emitter:?}: {shaded}, {apart}"
        );
    }
}
