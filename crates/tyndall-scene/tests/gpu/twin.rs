//! Rasterised images against the tracer's.

use tyndall::frame::ShadowProjection;
use tyndall_scene::{
    gpu::{GBufferTargets, GlassMapTarget, ShadowMapTarget},
    trace::{GBuffer, Tracer},
};
use tyndall_testkit::{
    device::device_or_skip,
    snapping::{nearest, shifts},
};

use crate::{
    scenes::{cameras, clutter, lights_with_maps},
    shifted::{shifted_glass, shifted_map},
    support::{channels, differing, read, record, renderer},
};

#[test]
fn g_buffers_are_the_tracers() {
    let Some(gpu) = device_or_skip("G-buffers against the tracer's") else {
        return;
    };
    let scene = clutter(200);
    let (renderer, tracer) = (renderer(gpu, &scene), Tracer::new(&scene));
    let (size, shifts) = ([160, 120], shifts(gpu, 5).unwrap());
    let targets = GBufferTargets::new(&gpu.device, size).unwrap();
    for (name, camera) in cameras() {
        record(gpu, |encoder| {
            renderer.g_buffer(encoder, &targets, &camera, None)
        });
        let shifted = |&shift: &_| {
            let camera = camera.jittered(size, shift);
            tracer.g_buffer(&camera, size, &|_, _| ())
        };
        let expected: Vec<GBuffer> = shifts.iter().map(shifted).collect();
        let depth = read(gpu, targets.depth());
        let hits = depth.iter().filter(|&&d| d != 0.0 && d != 1.0).count();
        assert!(
            hits > depth.len() / 2,
            "{name}: only {hits} pixels see anything"
        );
        let color = |texture| channels(&read(gpu, texture), 4, 3);
        // lavapipe: but for edges, depth differs by 6e-7, the rest by half floats' and bilinear filters' rounding;
        // the base colour most, where the level of detail is between two levels.
        type Values = fn(&GBuffer) -> Vec<f32>;
        let planes: [(&str, Vec<f32>, Values, f32); 5] = [
            ("depth", depth, |b| b.depth.clone(), 1e-6),
            (
                "normal",
                color(targets.normal()),
                |b| b.normal.concat(),
                1e-3,
            ),
            (
                "base colour",
                color(targets.base_color()),
                |b| b.base_color.concat(),
                2e-2,
            ),
            (
                "emissive",
                color(targets.emissive()),
                |b| b.emissive.concat(),
                1e-3,
            ),
            (
                "view tint",
                color(targets.view_tint()),
                |b| b.view_tint.concat(),
                5e-3,
            ),
        ];
        for (what, found, values, tolerance) in planes {
            let expected: Vec<_> = expected.iter().map(values).collect();
            let expected = nearest(&found, &expected);
            let (fraction, rest) = differing(&found, &expected, tolerance);
            let what =
                format!("{name} {what}: {fraction:.6} differ, the others by up to {rest:.2e}");
            eprintln!("{what}");
            // lavapipe: 4.7e-4 at most, at edges.
            assert!(fraction < 1e-3, "{what}");
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
    let shifts = shifts(gpu, 3).unwrap();
    for (name, emitter, projection) in lights_with_maps() {
        let size = [128, 96];
        let size = if matches!(projection, ShadowProjection::Cube { .. }) {
            [96; 2]
        } else {
            size
        };
        let shadow = ShadowMapTarget::new(&gpu.device, &projection, size).unwrap();
        let glass = GlassMapTarget::new(&gpu.device, &shadow, renderer.glass_layers()).unwrap();
        record(gpu, |encoder| {
            renderer.shadow_map(encoder, &shadow, &emitter, &projection, None);
            renderer.glass_map(encoder, &glass, &shadow, &emitter, &projection, None);
        });
        let found = read(gpu, shadow.texture());
        let map = |&shift: &_| shifted_map(&tracer, &emitter, &projection, size, shift).depth;
        let expected = nearest(&found, &shifts.iter().map(map).collect::<Vec<_>>());
        // lavapipe: 5.6e-3 of the texels differ, the others by 8.3e-6 (a cube with its near plane at 0.2 m): the rasteriser takes the
        // nearest plane of all surfaces that a centre meets, the tracer that of the first. Without the planes' slope it was 9e-5.
        let (fraction, rest) = differing(&found, &expected, 2e-5);
        let what =
            format!("{name} shadow map: {fraction:.6} differ, the others by up to {rest:.2e}");
        eprintln!("{what}");
        assert!(fraction < 8e-3, "{what}");

        let found = glass.read(&gpu.device, &gpu.queue).unwrap().texels.concat();
        let map = |&shift: &_| {
            let glass = shifted_glass(&tracer, &emitter, &projection, size, shift);
            glass.unwrap().texels.concat()
        };
        let expected = nearest(&found, &shifts.iter().map(map).collect::<Vec<_>>());
        // lavapipe: 7.4e-3 of the numbers differ, where the maps do: panes behind a surface's nearest plane are dark in any case. The
        // others differ by 1.7e-3 (10-bit roots, bilinear filter).
        let (fraction, rest) = differing(&found, &expected, 3e-3);
        let what = format!("{name} glass: {fraction:.6} differ, the others by up to {rest:.2e}");
        eprintln!("{what}");
        assert!(fraction < 1e-2, "{what}");
    }
}
