//! Rasterised pictures against the tracer's.

use glam::{DMat4, DVec3, dcamera::rh};
use tyndall::frame::{Camera, Emitter, Projection, ShadowProjection};
use tyndall_scene::{
    gpu::{GBufferTargets, GlassMapTarget, SceneRenderer, ShadowMapTarget, readback},
    trace::{GLASS_LAYERS, Tracer},
};
use tyndall_testkit::device::{TestDevice, device_or_skip};

use crate::{
    known::{read, record, renderer},
    scenes::clutter,
};

/// Fraction of values that differ by more than `tolerance`, and the largest difference among the others.
fn differing(found: &[f32], expected: &[f32], tolerance: f32) -> (f64, f32) {
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().chain(expected).all(|v| v.is_finite()));
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let (more, less): (Vec<f32>, Vec<f32>) = differences.partition(|&d| d > tolerance);
    (
        more.len() as f64 / found.len() as f64,
        less.into_iter().fold(0.0, f32::max),
    )
}

#[test]
fn differences_are_counted() {
    assert_eq!(differing(&[0.0, 1.0], &[0.0, 1.0], 0.1), (0.0, 0.0));
    assert_eq!(differing(&[0.0, 1.0], &[0.0, 1.5], 0.1), (0.5, 0.0));
    assert_eq!(differing(&[0.0, 1.0], &[0.0, 1.5], 1.0), (0.0, 0.5));
}

/// Cameras of all kinds among the clutter.
fn cameras() -> Vec<(&'static str, Camera)> {
    let perspective = Projection::Perspective {
        half_extent: [0.8, 0.6],
        center: [0.1, -0.05],
        near: 0.1,
        far: 40.0,
    };
    let orthographic = Projection::Orthographic {
        half_extent: [4.0, 3.0],
        center: [0.5, 0.2],
        near: -1.0,
        far: 30.0,
    };
    [
        ("perspective", perspective, false),
        ("perspective reversed", perspective, true),
        ("orthographic", orthographic, false),
        ("orthographic reversed", orthographic, true),
    ]
    .map(|(name, projection, reversed_depth)| {
        let camera = Camera {
            eye: [1.0, 2.0, 9.0],
            forward: [-0.1, -0.2, -1.0],
            up: [0.1, 1.0, 0.0],
            projection,
            reversed_depth,
        };
        (name, camera)
    })
    .into()
}

/// The first `kept` of every `of` numbers.
fn channels(values: &[f32], of: usize, kept: usize) -> Vec<f32> {
    let texels = values.chunks_exact(of);
    texels.flat_map(|texel| &texel[..kept]).copied().collect()
}

#[test]
fn g_buffers_are_the_tracers() {
    let Some(gpu) = device_or_skip("G-buffers against the tracer's") else {
        return;
    };
    let scene = clutter(200);
    let (renderer, tracer) = (renderer(gpu, &scene), Tracer::new(&scene));
    let size = [160, 120];
    let targets = GBufferTargets::new(&gpu.device, size).unwrap();
    for (name, camera) in cameras() {
        record(gpu, |encoder| {
            renderer.g_buffer(encoder, &targets, &camera, None)
        });
        let expected = tracer.g_buffer(&camera, size, &|_, _| ());
        let depth = read(gpu, targets.depth());
        let hits = depth.iter().filter(|&&d| d != 0.0 && d != 1.0).count();
        assert!(
            hits > depth.len() / 2,
            "{name}: only {hits} pixels see anything"
        );
        let color = |texture| channels(&read(gpu, texture), 4, 3);
        for (what, found, expected, tolerance) in [
            ("depth", depth, expected.depth, 1e-5),
            (
                "normal",
                color(targets.normal()),
                expected.normal.concat(),
                1e-3,
            ),
            (
                "base colour",
                color(targets.base_color()),
                expected.base_color.concat(),
                2e-2,
            ),
            (
                "emissive",
                color(targets.emissive()),
                expected.emissive.concat(),
                1e-3,
            ),
            (
                "view tint",
                color(targets.view_tint()),
                expected.view_tint.concat(),
                5e-3,
            ),
        ] {
            let (fraction, rest) = differing(&found, &expected, tolerance);
            eprintln!("{name} {what}: {fraction:.6} differ, the others by up to {rest:.2e}");
        }
    }
}

#[test]
fn light_maps_are_the_tracers() {
    let Some(gpu) = device_or_skip("light maps against the tracer's") else {
        return;
    };
    let scene = clutter(200);
    let (renderer, tracer) = (renderer(gpu, &scene), Tracer::new(&scene));
    for (name, emitter, projection) in lights() {
        let size = [128, 96];
        let size = if matches!(projection, ShadowProjection::Cube { .. }) {
            [96; 2]
        } else {
            size
        };
        let shadow = ShadowMapTarget::new(&gpu.device, &projection, size).unwrap();
        let glass = GlassMapTarget::new(&gpu.device, &shadow).unwrap();
        record(gpu, |encoder| {
            renderer.shadow_map(encoder, &shadow, &emitter, &projection, None);
            renderer.glass_map(encoder, &glass, &shadow, &emitter, &projection, None);
        });
        let expected = tracer.shadow_map(&emitter, &projection, size, &|_, _| ());
        let (fraction, rest) = differing(&read(gpu, shadow.texture()), &expected.depth, 1e-5);
        eprintln!("{name} shadow map: {fraction:.6} differ, the others by up to {rest:.2e}");

        let expected = tracer
            .glass_map(&emitter, &projection, size, GLASS_LAYERS, &|_, _| ())
            .unwrap();
        let texels = readback::texture_u32(&gpu.device, &gpu.queue, glass.texture()).unwrap();
        let found: Vec<f32> = texels
            .chunks_exact(2)
            .flat_map(|t| unpack(t[0], t[1]))
            .collect();
        let (fraction, rest) = differing(&found, &expected.texels.concat(), 3e-3);
        eprintln!("{name} glass: {fraction:.6} differ, the others by up to {rest:.2e}");
    }
}

/// A texel of the glass map as the CPU has it: linear tint, then depth.
fn unpack(depth: u32, tint: u32) -> [f32; 4] {
    let [r, g, b] = [0, 10, 20].map(|shift| ((tint >> shift & 1023) as f32 / 1023.0).powi(2));
    [r, g, b, f32::from_bits(depth)]
}

/// Lights of all kinds that have shadow maps.
fn lights() -> Vec<(&'static str, Emitter, ShadowProjection)> {
    let position = [0.5, 0.7, 1.0];
    let single = |clip_from_world: DMat4, reversed_depth| ShadowProjection::Single {
        clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
        reversed_depth,
    };
    let cube = |reversed_depth| ShadowProjection::Cube {
        near: 0.2,
        far: 30.0,
        reversed_depth,
    };
    let sun = Emitter::Directional {
        direction: [-0.3, -1.0, -0.5],
        illuminance: [1.0; 3],
    };
    let sun_view = rh::view::look_to_mat4(
        DVec3::new(3.0, 12.0, 6.0),
        DVec3::new(-0.3, -1.0, -0.5),
        DVec3::X,
    );
    let ortho = |near, far| rh::proj::directx::orthographic(-9.0, 9.0, -8.0, 8.0, near, far) * sun_view;
    let spot = Emitter::Spot {
        position,
        direction: [0.2, 0.1, -1.0],
        intensity: [1.0; 3],
        inner: 0.1,
        outer: 0.7,
    };
    let spot_view = rh::view::look_to_mat4(
        DVec3::from(position.map(f64::from)),
        DVec3::new(0.2, 0.1, -1.0),
        DVec3::Y,
    );
    let point = Emitter::Point {
        position,
        intensity: [1.0; 3],
    };
    let fov = |near, far| rh::proj::directx::perspective(1.4, 1.0, near, far) * spot_view;
    vec![
        ("sun", sun, single(ortho(0.5, 40.0), false)),
        ("sun reversed", sun, single(ortho(40.0, 0.5), true)),
        ("spot", spot, single(fov(0.2, 30.0), false)),
        ("spot reversed", spot, single(fov(30.0, 0.2), true)),
        ("point", point, cube(false)),
        ("point reversed", point, cube(true)),
    ]
}
