//! Rasterised pictures against the tracer's.

use glam::{DMat4, DVec3, dcamera::rh};
use tyndall::{
    LightInputs,
    cpu::{CpuLightInputs, GlassMap, LightTexture, ShadowMap},
    frame::{
        Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase, Projection,
        ShadowProjection, TexturePlacement,
    },
    techniques::Technique,
};
use tyndall_scene::{
    gpu::{
        GBufferTargets, GlassMapTarget, SceneRenderer, ShadowMapTarget, readback,
        upload_light_texture,
    },
    shading::shade,
    trace::{GBuffer, GLASS_LAYERS, Tracer},
};
use tyndall_testkit::device::{TestDevice, device_or_skip};

use crate::{
    known::{FORMAT, read, record, renderer},
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
        // lavapipe: but for edges, depth differs by 3.2e-7, the rest by half floats' and bilinear filters' rounding;
        // the base colour most, where the level of detail is between two levels.
        for (what, found, expected, tolerance) in [
            ("depth", depth, expected.depth, 1e-6),
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
            let what =
                format!("{name} {what}: {fraction:.6} differ, the others by up to {rest:.2e}");
            eprintln!("{what}");
            // lavapipe: 3.0e-4 at most, at edges.
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
    for (name, emitter, projection) in lights_with_maps() {
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
        // lavapipe: at edges 3.6e-5 of the texels differ, the others by 8.3e-6 (the cube: near planes at 0.2 m).
        let (fraction, rest) = differing(&read(gpu, shadow.texture()), &expected.depth, 2e-5);
        let what =
            format!("{name} shadow map: {fraction:.6} differ, the others by up to {rest:.2e}");
        eprintln!("{what}");
        assert!(fraction < 2e-4, "{what}");

        let expected = tracer
            .glass_map(&emitter, &projection, size, GLASS_LAYERS, &|_, _| ())
            .unwrap();
        let texels = readback::texture_u32(&gpu.device, &gpu.queue, glass.texture()).unwrap();
        let found: Vec<f32> = texels
            .chunks_exact(2)
            .flat_map(|t| unpack(t[0], t[1]))
            .collect();
        // lavapipe: at edges 1.6e-4 of the numbers differ, the others by 1.7e-3 (10-bit roots, bilinear filter).
        let (fraction, rest) = differing(&found, &expected.texels.concat(), 3e-3);
        let what = format!("{name} glass: {fraction:.6} differ, the others by up to {rest:.2e}");
        eprintln!("{what}");
        assert!(fraction < 5e-4, "{what}");
    }
}

/// The same scene under every kind of light, lit on both sides from the same maps but for rasterisation.
#[test]
fn lit_surfaces_are_the_cpus() {
    let Some(gpu) = device_or_skip("lit surfaces against the CPU's") else {
        return;
    };
    let mut scene = clutter(200);
    // What glows of itself would outshine the differences.
    for material in &mut scene.materials {
        material.emissive = [0.0; 3];
    }
    let (renderer, tracer) = (renderer(gpu, &scene), Tracer::new(&scene));
    let size = [160, 120];
    let g_buffer = GBufferTargets::new(&gpu.device, size).unwrap();
    let target = color_target(gpu, size);
    let view = target.create_view(&Default::default());
    let lights: Vec<_> = shaded_lights()
        .into_iter()
        .map(|(name, light)| (name, light, LightMaps::new(gpu, &renderer, &tracer, &light)))
        .collect();
    for (camera_name, camera) in cameras() {
        record(gpu, |encoder| renderer.g_buffer(encoder, &g_buffer, &camera, None));
        // Of the same G-buffer: this is about lighting alone.
        let cpu_g_buffer = read_g_buffer(gpu, &g_buffer);
        for (name, light, maps) in &lights {
            let frame = frame(camera, *light);
            record(gpu, |encoder| {
                renderer.shade(encoder, &view, &g_buffer, &frame, &[maps.gpu()], None);
            });
            let found = channels(&read(gpu, &target), 4, 3);
            let expected = shade(&cpu_g_buffer, &frame, &[maps.cpu()]).concat();
            assert!(found.iter().all(|v| v.is_finite()));
            let error = rel_mae(&found, &expected);
            eprintln!("{camera_name} {name}: relMAE {error:.2e}");
            assert!(error < 1.0, "{camera_name} {name}: relMAE {error:.2e}");
        }
    }
}

fn rel_mae(found: &[f32], expected: &[f32]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let differences = found
        .iter()
        .zip(expected)
        .map(|(a, b)| f64::from((a - b).abs()));
    differences.sum::<f64>() / expected.iter().map(|&e| f64::from(e)).sum::<f64>()
}

fn frame(camera: Camera, light: Light) -> Frame {
    let air = MediumComponent {
        sigma_s: [0.02, 0.03, 0.05],
        sigma_a: [0.01, 0.0, 0.0],
        phase: Phase::Isotropic,
    };
    Frame {
        camera,
        lights: vec![light],
        medium: Medium {
            components: vec![air],
        },
        technique: Technique::from_name("ray-march").unwrap(),
    }
}

fn color_target(gpu: &TestDevice, [width, height]: [u32; 2]) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn read_g_buffer(gpu: &TestDevice, targets: &GBufferTargets) -> GBuffer {
    let color = |texture| {
        let texels = read(gpu, texture);
        texels.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
    };
    GBuffer {
        size: targets.size(),
        depth: read(gpu, targets.depth()),
        normal: color(targets.normal()),
        base_color: color(targets.base_color()),
        emissive: color(targets.emissive()),
        view_tint: color(targets.view_tint()),
    }
}

/// A light's pictures on both sides; the shadow map is the GPU's, so that edges don't differ.
struct LightMaps {
    shadow: Option<(ShadowMapTarget, ShadowMap)>,
    glass: Option<(GlassMapTarget, GlassMap)>,
    texture: Option<(wgpu::TextureView, LightTexture)>,
}

impl LightMaps {
    fn new(gpu: &TestDevice, renderer: &SceneRenderer, tracer: &Tracer, light: &Light) -> Self {
        let size = [128; 2];
        let texture = light.texture.map(|_| {
            let texel = |i: usize| [i as f32, (i % 5) as f32, 1.0];
            let texture = LightTexture {
                size: [5, 4],
                texels: (0..20).map(texel).collect(),
            };
            let uploaded = upload_light_texture(&gpu.device, &gpu.queue, &texture).unwrap();
            (uploaded.create_view(&Default::default()), texture)
        });
        let Some(projection) = light.shadow else {
            return Self {
                shadow: None,
                glass: None,
                texture,
            };
        };
        let shadow = ShadowMapTarget::new(&gpu.device, &projection, size).unwrap();
        let glass = GlassMapTarget::new(&gpu.device, &shadow).unwrap();
        record(gpu, |encoder| {
            renderer.shadow_map(encoder, &shadow, &light.emitter, &projection, None);
            renderer.glass_map(encoder, &glass, &shadow, &light.emitter, &projection, None);
        });
        let map = ShadowMap {
            size,
            depth: read(gpu, shadow.texture()),
        };
        let cpu_glass = tracer
            .glass_map(&light.emitter, &projection, size, GLASS_LAYERS, &|_, _| ())
            .unwrap();
        Self {
            shadow: Some((shadow, map)),
            glass: Some((glass, cpu_glass)),
            texture,
        }
    }

    fn gpu(&self) -> LightInputs<'_> {
        LightInputs {
            shadow_map: self.shadow.as_ref().map(|(target, _)| target.view()),
            glass: self.glass.as_ref().map(|(target, _)| target.view()),
            texture: self.texture.as_ref().map(|(view, _)| view),
        }
    }

    fn cpu(&self) -> CpuLightInputs<'_> {
        CpuLightInputs {
            shadow_map: self.shadow.as_ref().map(|(_, map)| map),
            glass: self.glass.as_ref().map(|(_, map)| map),
            texture: self.texture.as_ref().map(|(_, texture)| texture),
        }
    }
}

/// Lights of every kind, with and without shadows and textures.
fn shaded_lights() -> Vec<(&'static str, Light)> {
    let plain = |emitter| Light {
        emitter,
        shadow: None,
        texture: None,
    };
    let rect = Emitter::Rect {
        center: [0.0, 5.0, 1.0],
        edge_x: [2.0, 0.0, 0.0],
        edge_y: [0.0, 0.0, 1.0],
        radiance: [3.0, 2.0, 1.0],
        samples: 64,
    };
    let picture = |emitter: &Emitter| match emitter {
        Emitter::Directional { .. } => TexturePlacement::Parallelogram {
            center: [0.0; 3],
            edge_x: [6.0, 0.0, 1.0],
            edge_y: [0.0, 0.0, 6.0],
        },
        Emitter::Spot { .. } => TexturePlacement::Cone {
            up: [0.0, 1.0, 0.0],
        },
        Emitter::Point { .. } => TexturePlacement::Sphere {
            up: [0.0, 1.0, 0.2],
            forward: [1.0, 0.0, 0.0],
        },
        Emitter::Rect { .. } => TexturePlacement::Rectangle,
    };
    let mut lights = vec![
        ("rect", plain(rect)),
        (
            "textured rect",
            Light {
                texture: Some(picture(&rect)),
                ..plain(rect)
            },
        ),
    ];
    for (name, emitter, projection) in lights_with_maps() {
        let shadowed = Light {
            shadow: Some(projection),
            ..plain(emitter)
        };
        lights.push((name, shadowed));
        lights.push(("unshadowed", plain(emitter)));
        lights.push((
            "textured",
            Light {
                texture: Some(picture(&emitter)),
                ..shadowed
            },
        ));
    }
    lights
}

/// A texel of the glass map as the CPU has it: linear tint, then depth.
fn unpack(depth: u32, tint: u32) -> [f32; 4] {
    let [r, g, b] = [0, 10, 20].map(|shift| ((tint >> shift & 1023) as f32 / 1023.0).powi(2));
    [r, g, b, f32::from_bits(depth)]
}

/// Lights of all kinds that have shadow maps.
fn lights_with_maps() -> Vec<(&'static str, Emitter, ShadowProjection)> {
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
    let ortho =
        |near, far| rh::proj::directx::orthographic(-9.0, 9.0, -8.0, 8.0, near, far) * sun_view;
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
