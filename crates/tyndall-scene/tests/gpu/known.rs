//! Images of rectangles, known in closed form.

use glam::{DAffine3, DMat4, DVec3, Vec3};
use tyndall::{
    cpu::LightTexture,
    frame::{Camera, DepthRange, Emitter, Projection, ShadowProjection},
    gpu::PassTimer,
};
use tyndall_scene::{
    gpu::{
        GBufferTargets, GlassMapTarget, GpuSceneError, SceneRenderer, ShadowMapTarget, connect,
        readback, upload_light_texture,
    },
    scene::{Blocking, Material, Scene},
    texture::linear_from_srgb,
};
use tyndall_testkit::{
    device::{TestDevice, device_or_skip},
    skip::skip,
};

use crate::{
    scenes::{Builder, material, wall},
    support::{read, record, renderer},
};

const RED: [f32; 4] = [0.8, 0.1, 0.05, 1.0];

fn g_buffer(gpu: &TestDevice, scene: &Scene, camera: &Camera, size: [u32; 2]) -> GBufferTargets {
    let targets = GBufferTargets::new(&gpu.device, size).unwrap();
    let renderer = renderer(gpu, scene);
    record(gpu, |encoder| {
        renderer.g_buffer(encoder, &targets, camera, None)
    });
    targets
}

fn shadow_map(
    gpu: &TestDevice,
    scene: &Scene,
    emitter: &Emitter,
    projection: &ShadowProjection,
    size: u32,
) -> Vec<f32> {
    let target = ShadowMapTarget::new(&gpu.device, projection, [size; 2]).unwrap();
    let renderer = renderer(gpu, scene);
    record(gpu, |encoder| {
        renderer.shadow_map(encoder, &target, emitter, projection, None);
    });
    read(gpu, target.texture())
}

const DEPTH_RANGES: [DepthRange; 3] = [
    DepthRange::Standard,
    DepthRange::Reversed,
    DepthRange::ReversedInfinite,
];

/// A camera at the origin that looks along -Z, 90 degrees wide and high.
fn camera(perspective: bool, depth_range: DepthRange) -> Camera {
    let (half_extent, center, near, far) = ([1.0; 2], [0.0; 2], 0.5, 50.0);
    Camera {
        eye: [0.0; 3],
        forward: [0.0, 0.0, -2.0],
        up: [0.0, 1.0, 0.1],
        projection: if perspective {
            Projection::Perspective {
                half_extent,
                center,
                near,
                far,
            }
        } else {
            Projection::Orthographic {
                half_extent,
                center,
                near,
                far,
            }
        },
        depth_range,
    }
}

/// The texel at (x, y) of an image of `N` channels.
fn texel<const N: usize>(image: &[f32], size: u32, x: u32, y: u32) -> [f32; N] {
    let start = (y * size + x) as usize * N;
    image[start..start + N].try_into().unwrap()
}

#[test]
fn a_wall_has_its_depth_normal_and_colour() {
    let Some(gpu) = device_or_skip("a wall's G-buffer") else {
        return;
    };
    let (corner, edges) = wall(5.0, -4.0);
    let mut red = material(RED, Blocking::Opaque);
    red.emissive = [0.0, 2.0, 70_000.0];
    // Turned away: the normal must be turned back.
    let scene = Builder::default()
        .rectangle(corner, [edges[1], edges[0]], red)
        .build();
    for (perspective, depth_range, expected) in [
        (true, DepthRange::Standard, 50.0 * 3.5 / (4.0 * 49.5)),
        (true, DepthRange::Reversed, 0.5 * 46.0 / (4.0 * 49.5)),
        (true, DepthRange::ReversedInfinite, 0.5 / 4.0),
        (false, DepthRange::Standard, 3.5 / 49.5),
        (false, DepthRange::Reversed, 46.0 / 49.5),
    ] {
        let targets = g_buffer(gpu, &scene, &camera(perspective, depth_range), [8; 2]);
        for depth in read(gpu, targets.depth()) {
            // lavapipe: equal to 6e-8.
            assert!((depth - expected as f32).abs() < 2e-7, "{depth} {expected}");
        }
        let (normal, base, emissive, tint) = (
            read(gpu, targets.normal()),
            read(gpu, targets.base_color()),
            read(gpu, targets.emissive()),
            read(gpu, targets.view_tint()),
        );
        assert_eq!(texel(&normal, 8, 3, 3), [0.0, 0.0, 1.0, 0.0]);
        for (found, expected) in texel::<4>(&base, 8, 3, 3).iter().zip(RED) {
            // Half a unit in the last place of f16.
            assert!((found - expected).abs() <= 2.5e-4 * expected);
        }
        // The largest f16, not infinity.
        assert_eq!(texel(&emissive, 8, 3, 3), [0.0, 2.0, 65504.0, 1.0]);
        assert_eq!(texel(&tint, 8, 3, 3), [1.0; 4]);
    }
}

#[test]
fn nothing_is_as_far_as_the_far_plane() {
    let Some(gpu) = device_or_skip("an empty G-buffer") else {
        return;
    };
    for depth_range in DEPTH_RANGES {
        let targets = g_buffer(gpu, &Scene::default(), &camera(true, depth_range), [4; 2]);
        assert_eq!(read(gpu, targets.depth()), [depth_range.far_value(); 16]);
        assert_eq!(read(gpu, targets.normal()), [0.0; 64]);
        assert_eq!(read(gpu, targets.view_tint()), [1.0; 64]);
    }
}

/// Glass before the wall multiplies, glass behind it does not count.
#[test]
fn glass_before_the_first_surface_tints_the_view() {
    let Some(gpu) = device_or_skip("the view tint") else {
        return;
    };
    let transmissive = |color| material(color, Blocking::Transmissive { transmission: 0.5 });
    let rectangle = |builder: Builder, z, material| {
        let (corner, edges) = wall(20.0, z);
        builder.rectangle(corner, edges, material)
    };
    let builder = rectangle(Builder::default(), -9.0, transmissive([0.1, 0.1, 0.1, 1.0]));
    let builder = rectangle(
        builder,
        -4.0,
        material([1.0, 0.5, 0.0, 0.25], Blocking::Blended),
    );
    let builder = rectangle(builder, -6.0, material(RED, Blocking::Opaque));
    let scene = rectangle(builder, -5.0, transmissive([1.0, 0.5, 0.25, 1.0])).build();
    for depth_range in DEPTH_RANGES {
        let targets = g_buffer(gpu, &scene, &camera(true, depth_range), [4; 2]);
        let tint = read(gpu, targets.view_tint());
        assert_eq!(
            texel(&tint, 4, 2, 1),
            [0.5, 0.25 * 0.875, 0.125 * 0.75, 1.0]
        );
    }
}

/// The upper left quarter of the wall is a hole: the far wall shows there, and light passes.
#[test]
fn masked_surfaces_have_holes() {
    let Some(gpu) = device_or_skip("MASK holes") else {
        return;
    };
    let masked = Material {
        base_color_texture: Some(0),
        ..material([1.0; 4], Blocking::Masked { cutoff: 0.5 })
    };
    let (corner, edges) = wall(4.0, -4.0);
    let scene = Builder::default()
        .texture([4, 4], |x, y| {
            if x < 2 && y < 2 {
                [255, 255, 255, 0]
            } else {
                [255; 4]
            }
        })
        .rectangle(corner, edges, masked)
        .build();
    let expect = |image: &[f32]| {
        for (i, &depth) in image.iter().enumerate() {
            let hole = i % 8 < 4 && i / 8 < 4;
            assert_eq!(depth == 0.0, hole, "pixel {i}: {depth}");
        }
    };
    let targets = g_buffer(gpu, &scene, &camera(true, DepthRange::Reversed), [8; 2]);
    expect(&read(gpu, targets.depth()));
    let sun = SUN;
    expect(&shadow_map(gpu, &scene, &sun, &sun_projection(true), 8));
}

/// Along -Z.
const SUN: Emitter = Emitter::Directional {
    direction: [0.0, 0.0, -1.0],
    illuminance: [1.0; 3],
};

/// An orthographic map along -Z of |x|, |y| <= 4 and z from 0 to -16.
fn sun_projection(reversed_depth: bool) -> ShadowProjection {
    let (scale, offset) = if reversed_depth {
        (1.0 / 16.0, 1.0)
    } else {
        (-1.0 / 16.0, 0.0)
    };
    let clip_from_world = DMat4::from_translation(DVec3::new(0.0, 0.0, offset))
        * DMat4::from_scale(DVec3::new(0.25, 0.25, scale));
    ShadowProjection::Single {
        clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
        reversed_depth,
    }
}

/// Six small walls round a light, each at a distance and a place of its own, so that no face, mirrored or turned,
/// is taken for another.
#[test]
fn cube_faces_are_webgpus() {
    let Some(gpu) = device_or_skip("cube faces") else {
        return;
    };
    let light = Vec3::new(100.0, -20.0, 7.0);
    // By the table of the WebGPU specification: the world-space axes of u (right), v (down) and the face.
    let faces = [
        [Vec3::NEG_Z, Vec3::NEG_Y, Vec3::X],
        [Vec3::Z, Vec3::NEG_Y, Vec3::NEG_X],
        [Vec3::X, Vec3::Z, Vec3::Y],
        [Vec3::X, Vec3::NEG_Z, Vec3::NEG_Y],
        [Vec3::X, Vec3::NEG_Y, Vec3::Z],
        [Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z],
    ];
    let size = 8;
    // Each wall covers the texels from (1, 2) up to and without (3, 5).
    let covered = |x: usize, y: usize| (1..3).contains(&x) && (2..5).contains(&y);
    let builder = faces
        .iter()
        .enumerate()
        .fold(Builder::default(), |b, (i, [u, v, axis])| {
            let distance = 2.0 + i as f32;
            let at = |texel: f32| distance * (2.0 * texel / 8.0 - 1.0);
            let corner = light + distance * axis + at(1.0) * u + at(2.0) * v;
            let edges = [(at(3.0) - at(1.0)) * u, (at(5.0) - at(2.0)) * v];
            b.rectangle(corner, edges, material(RED, Blocking::Opaque))
        });
    let scene = builder.build();
    let emitter = Emitter::Point {
        position: light.to_array(),
        intensity: [1.0; 3],
        radius: 0.0,
    };
    let (near, far) = (0.5, 20.0);
    for reversed_depth in [false, true] {
        let projection = ShadowProjection::Cube {
            near,
            far,
            reversed_depth,
        };
        let map = shadow_map(gpu, &scene, &emitter, &projection, size);
        for (i, depth) in map.iter().enumerate() {
            let (face, y, x) = (i / 64, i / 8 % 8, i % 8);
            let distance = if covered(x, y) {
                2.0 + face as f32
            } else {
                far
            };
            let from_far = near * (far - distance) / (distance * (far - near));
            let expected = if reversed_depth {
                from_far
            } else {
                1.0 - from_far
            };
            // lavapipe: equal to 1.2e-7.
            assert!(
                (depth - expected).abs() < 3e-7,
                "face {face} ({x}, {y}): {depth} {expected}"
            );
        }
    }
}

/// Six panes and a wall among them: the four nearest to the light before the wall, in order, in any order of drawing.
#[test]
fn glass_is_peeled_from_the_light_on() {
    let Some(gpu) = device_or_skip("glass layers") else {
        return;
    };
    let pane = |z: f32, half: f32, red: f32| {
        let (corner, edges) = wall(half, -z);
        (
            corner,
            edges,
            material(
                [red, 1.0, 0.25, 1.0],
                Blocking::Transmissive { transmission: 1.0 },
            ),
        )
    };
    let clear = material([1.0; 4], Blocking::Transmissive { transmission: 1.0 });
    // The pane at 3 covers the inner half only, the wall the left half.
    let panes = [
        pane(9.0, 9.0, 0.9),
        pane(2.0, 9.0, 0.2),
        pane(3.0, 2.0, 0.3),
        pane(12.0, 9.0, 0.8),
        pane(1.0, 9.0, 0.1),
        pane(10.0, 9.0, 0.7),
    ];
    let builder = panes
        .into_iter()
        .fold(Builder::default(), |b, (corner, edges, m)| {
            b.rectangle(corner, edges, m)
        });
    let (corner, edges) = wall(9.0, -1.5);
    let builder = builder.rectangle(corner, edges, clear);
    let (corner, edges) = wall(8.0, -5.0);
    let scene = builder
        .rectangle(
            corner,
            [0.5 * edges[0], edges[1]],
            material(RED, Blocking::Opaque),
        )
        .build();

    let sun = SUN;
    for reversed in [false, true] {
        let projection = sun_projection(reversed);
        let shadow = ShadowMapTarget::new(&gpu.device, &projection, [8; 2]).unwrap();
        let renderer = renderer(gpu, &scene);
        let glass = GlassMapTarget::new(&gpu.device, &shadow, renderer.glass_layers()).unwrap();
        assert!(renderer.has_tinted_glass());
        record(gpu, |encoder| {
            renderer.shadow_map(encoder, &shadow, &sun, &projection, None);
            renderer.glass_map(encoder, &glass, &shadow, &sun, &projection, None);
        });
        let texels = readback::texture_u32(&gpu.device, &gpu.queue, glass.texture()).unwrap();
        for (x, y, expected) in [
            (0, 0, vec![(1.0, 0.1), (2.0, 0.2)]),
            (3, 4, vec![(1.0, 0.1), (2.0, 0.2), (3.0, 0.3)]),
            (7, 7, vec![(1.0, 0.1), (2.0, 0.2), (9.0, 0.9), (10.0, 0.7)]),
            (4, 4, vec![(1.0, 0.1), (2.0, 0.2), (3.0, 0.3), (9.0, 0.9)]),
        ] {
            for layer in 0..4 {
                let start = 2 * ((layer * 8 + y) * 8 + x);
                let (depth, tint) = (f32::from_bits(texels[start]), texels[start + 1]);
                let from_light = if reversed {
                    16.0 * (1.0 - depth)
                } else {
                    16.0 * depth
                };
                let unpack = |shift: u32| (f64::from(tint >> shift & 1023) / 1023.0).powi(2);
                let (z, red) = expected.get(layer).copied().unwrap_or((16.0, 1.0));
                let blue = if layer < expected.len() { 0.25 } else { 1.0 };
                assert!(
                    (from_light - z).abs() < 1e-5,
                    "({x}, {y}) layer {layer}: {from_light} {z}"
                );
                // A step of 1/1023 of the root is 2/1023 of the tint at most, rounded half of that.
                assert!(
                    (unpack(0) - red).abs() < 1e-3,
                    "({x}, {y}) layer {layer}: {} {red}",
                    unpack(0)
                );
                assert!((unpack(20) - blue).abs() < 1e-3);
                assert_eq!(unpack(10), 1.0);
            }
        }
    }
}

#[test]
fn clear_glass_is_no_glass() {
    let Some(gpu) = device_or_skip("clear glass") else {
        return;
    };
    let (corner, edges) = wall(1.0, -1.0);
    let textured = |m: Material| Material {
        base_color_texture: Some(0),
        ..m
    };
    let white = [1.0; 4];
    for (what, m, texel, expected) in [
        ("opaque", material(RED, Blocking::Opaque), [255; 4], false),
        (
            "clear",
            material(white, Blocking::Transmissive { transmission: 1.0 }),
            [255; 4],
            false,
        ),
        (
            "dim",
            material(white, Blocking::Transmissive { transmission: 0.5 }),
            [255; 4],
            true,
        ),
        (
            "red",
            material(RED, Blocking::Transmissive { transmission: 1.0 }),
            [255; 4],
            true,
        ),
        (
            "red texture",
            textured(material(
                white,
                Blocking::Transmissive { transmission: 1.0 },
            )),
            [255, 0, 0, 255],
            true,
        ),
        (
            "white texture",
            textured(material(white, Blocking::Blended)),
            [255; 4],
            false,
        ),
        (
            "red blended texture",
            textured(material(white, Blocking::Blended)),
            [255, 0, 0, 255],
            true,
        ),
        (
            "invisible texture",
            textured(material(white, Blocking::Blended)),
            [255, 0, 0, 0],
            false,
        ),
    ] {
        let scene = Builder::default()
            .texture([1, 1], |_, _| texel)
            .rectangle(corner, edges, m)
            .build();
        assert_eq!(renderer(gpu, &scene).has_tinted_glass(), expected, "{what}");
    }
}

/// All 256 codes, one a pixel.
#[test]
fn textures_are_decoded_to_linear() {
    let Some(gpu) = device_or_skip("decoding of textures") else {
        return;
    };
    let (corner, edges) = wall(4.0, -4.0);
    let textured = Material {
        base_color_texture: Some(0),
        ..material([1.0; 4], Blocking::Opaque)
    };
    let scene = Builder::default()
        .texture([16; 2], |x, y| [(16 * y + x) as u8; 4])
        .rectangle(corner, edges, textured)
        .build();
    let targets = g_buffer(gpu, &scene, &camera(true, DepthRange::Reversed), [16; 2]);
    let base_color = read(gpu, targets.base_color());
    let mut worst = 0.0_f64;
    for (code, texel) in base_color.chunks_exact(4).enumerate() {
        let expected = linear_from_srgb(code as f64 / 255.0);
        worst = worst.max((f64::from(texel[0]) - expected).abs() / expected.max(1e-3));
    }
    // lavapipe: 2.5e-2 of the darkest codes (it decodes by a polynomial).
    assert!(worst < 4e-2, "{worst:.2e}");
}

/// A node that moves takes its triangles along.
#[test]
fn nodes_move() {
    let Some(gpu) = device_or_skip("moving nodes") else {
        return;
    };
    let (corner, edges) = wall(5.0, 0.0);
    let mut scene = Builder::default()
        .rectangle(corner, edges, material(RED, Blocking::Opaque))
        .build();
    let renderer = renderer(gpu, &scene);
    let targets = GBufferTargets::new(&gpu.device, [4; 2]).unwrap();
    let camera = camera(false, DepthRange::Standard);
    for z in [2.0, 4.0] {
        scene.nodes[0].parent_from_local =
            DAffine3::from_translation(DVec3::new(0.0, 0.0, -f64::from(z)));
        renderer.place(&gpu.queue, &scene);
        record(gpu, |encoder| {
            renderer.g_buffer(encoder, &targets, &camera, None);
        });
        let depth = read(gpu, targets.depth())[5];
        assert!((depth - (z - 0.5) / 49.5).abs() < 2e-7, "{depth} at {z} m");
    }
}

#[test]
fn passes_are_timed_by_name() {
    let Some(gpu) = device_or_skip("pass names") else {
        return;
    };
    let Some(mut timer) = PassTimer::new(&gpu.device, 16) else {
        return skip("pass names", "the device has no timestamps");
    };
    let renderer = renderer(gpu, &Scene::default());
    let targets = GBufferTargets::new(&gpu.device, [4; 2]).unwrap();
    let (projection, sun) = (sun_projection(true), SUN);
    let shadow = ShadowMapTarget::new(&gpu.device, &projection, [4; 2]).unwrap();
    record(gpu, |encoder| {
        renderer.g_buffer(
            encoder,
            &targets,
            &camera(true, DepthRange::Reversed),
            Some(&mut timer),
        );
        renderer.shadow_map(encoder, &shadow, &sun, &projection, Some(&mut timer));
    });
    assert_eq!(timer.names(), ["g-buffer", "view tint", "shadow map"]);
}

#[test]
fn sizes_are_checked_against_the_device() {
    let Some(gpu) = device_or_skip("texture sizes") else {
        return;
    };
    let limit = gpu.device.limits().max_texture_dimension_2d;
    for size in [[0, 4], [4, 0], [limit + 1, 4]] {
        let error = GBufferTargets::new(&gpu.device, size).err().unwrap();
        let GpuSceneError::TextureSize { size: found, .. } = error else {
            panic!("{error}");
        };
        assert_eq!(found, size);
        assert!(ShadowMapTarget::new(&gpu.device, &sun_projection(true), size).is_err());
    }
    let short = LightTexture {
        size: [2, 2],
        texels: vec![[1.0; 3]; 3],
    };
    let error = upload_light_texture(&gpu.device, &gpu.queue, &short).err();
    assert_eq!(
        error.unwrap().to_string(),
        "light texture must have 4 texels, found 3"
    );
}

#[test]
fn a_format_that_cannot_blend_is_refused() {
    let Some(gpu) = device_or_skip("target formats") else {
        return;
    };
    let format = wgpu::TextureFormat::Rgba32Uint;
    let error = SceneRenderer::new(&gpu.device, &gpu.queue, &Scene::default(), format).err();
    assert_eq!(error, Some(GpuSceneError::TargetFormat { format }));
}

/// WebGPU's default limits are what every device has: all tests that draw keep within them.
#[test]
fn tests_have_no_more_than_webgpus_default_limits() {
    if let Some(gpu) = device_or_skip("limits of the tests' device") {
        assert_eq!(gpu.device.limits(), wgpu::Limits::default());
    }
}

#[test]
fn a_device_is_found_where_there_is_one() {
    if device_or_skip("connect").is_none() {
        return;
    }
    let (adapter, device, _) = connect(wgpu::PowerPreference::HighPerformance).unwrap();
    let (found, offered) = (device.limits(), adapter.limits());
    assert_eq!(
        found.max_texture_dimension_2d,
        offered.max_texture_dimension_2d
    );
    assert_eq!(found.max_buffer_size, offered.max_buffer_size);
}
