//! Lit surfaces against the CPU's.

use tyndall::{
    LightInputs,
    cpu::{CpuLightInputs, GlassMap, LightTexture, ShadowMap},
    frame::{Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase, TexturePlacement},
};
use tyndall_scene::{
    gpu::{
        GBufferTargets, GlassMapTarget, SceneRenderer, ShadowMapTarget, SurfaceLights,
        upload_light_texture,
    },
    shading::shade,
    trace::GBuffer,
};
use tyndall_testkit::device::{TestDevice, device_or_skip};

use crate::{
    scenes::{cameras, clutter, lights_with_maps},
    support::{channels, color_target, read, record, rel_mae, renderer},
};

/// Lights one scene with every kind of light, on both sides from the same maps but for rasterisation.
#[test]
fn lit_surfaces_are_the_cpus() {
    let Some(gpu) = device_or_skip("lit surfaces against the CPU's") else {
        return;
    };
    let mut scene = clutter(200);
    // Emission would outshine the differences.
    for material in &mut scene.materials {
        material.emissive = [0.0; 3];
    }
    let renderer = renderer(gpu, &scene);
    let size = [160, 120];
    let g_buffer = GBufferTargets::new(&gpu.device, size).unwrap();
    let target = color_target(gpu, size);
    let view = target.create_view(&Default::default());
    let lights: Vec<_> = shaded_lights()
        .into_iter()
        .map(|(name, light)| (name, light, LightMaps::new(gpu, &renderer, &light)))
        .collect();
    for (camera_name, camera) in cameras() {
        record(gpu, |encoder| {
            renderer.g_buffer(encoder, &g_buffer, &camera, None)
        });
        // Both sides share a G-buffer: this is about lighting alone.
        let cpu_g_buffer = read_g_buffer(gpu, &g_buffer);
        for (name, light, maps) in &lights {
            let frame = frame(camera, *light);
            record(gpu, |encoder| {
                let lights = SurfaceLights {
                    inputs: &[maps.gpu()],
                    visibility: &[],
                };
                renderer.shade(encoder, &view, &g_buffer, &frame, lights, None);
            });
            let found = channels(&read(gpu, &target), 4, 3);
            let expected = shade(&cpu_g_buffer, &frame, &[maps.cpu()], None).concat();
            assert!(found.iter().all(|v| v.is_finite()));
            let error = rel_mae(&found, &expected, size);
            // lavapipe: 7.3e-5 at most with a shadow map (a textured cube), where a texel's depth is that of the point itself
            // within rounding; 6e-7 without. SwiftShader: 1.9e-6 and 6e-7. They were 4.0e-4 and 1.7e-3 with traced glass.
            let bound = if light.shadow.is_some() { 1.5e-4 } else { 2e-6 };
            eprintln!("{camera_name} {name}: relMAE {error:.2e}");
            assert!(error < bound, "{camera_name} {name}: relMAE {error:.2e}");
        }
    }
}

/// Direct light is multiplied by the visibility texture, ambient light is not.
#[test]
fn visibility_scales_direct_light() {
    let Some(gpu) = device_or_skip("surfaces lit through a visibility texture") else {
        return;
    };
    let mut scene = clutter(200);
    for material in &mut scene.materials {
        material.emissive = [0.0; 3];
    }
    let renderer = renderer(gpu, &scene);
    let size = [64, 48];
    let g_buffer = GBufferTargets::new(&gpu.device, size).unwrap();
    let target = color_target(gpu, size);
    let view = target.create_view(&Default::default());
    let (_, camera) = cameras()[0];
    let (_, light) = shaded_lights()[0];
    let frame = frame(camera, light);
    record(gpu, |encoder| {
        renderer.g_buffer(encoder, &g_buffer, &camera, None)
    });
    let lit = |visibility: &[Option<&wgpu::TextureView>]| {
        let lights = SurfaceLights {
            inputs: &[LightInputs::default()],
            visibility,
        };
        record(gpu, |encoder| {
            renderer.shade(encoder, &view, &g_buffer, &frame, lights, None);
        });
        channels(&read(gpu, &target), 4, 3)
    };
    let constant = |value: f32| {
        let texture = LightTexture {
            size,
            texels: vec![[value; 3]; (size[0] * size[1]) as usize],
        };
        let texture = upload_light_texture(&gpu.device, &gpu.queue, &texture).unwrap();
        lit(&[Some(&texture.create_view(&Default::default()))])
    };
    let [none, half, all] = [0.0, 0.5, 1.0].map(constant);
    assert_eq!(lit(&[]), all);
    assert_eq!(lit(&[None]), all);
    let mean: Vec<f32> = none.iter().zip(&all).map(|(a, b)| 0.5 * (a + b)).collect();
    // lavapipe: 3e-8.
    assert!(rel_mae(&half, &mean, size) < 1e-6);
    assert!(rel_mae(&none, &all, size) > 0.3);
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
    }
}

pub(crate) fn read_g_buffer(gpu: &TestDevice, targets: &GBufferTargets) -> GBuffer {
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

/// A light's maps on both sides; they are the GPU's, so that edges don't differ.
struct LightMaps {
    shadow: Option<(ShadowMapTarget, ShadowMap)>,
    glass: Option<(GlassMapTarget, GlassMap)>,
    texture: Option<(wgpu::TextureView, LightTexture)>,
}

impl LightMaps {
    fn new(gpu: &TestDevice, renderer: &SceneRenderer, light: &Light) -> Self {
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
        let glass = GlassMapTarget::new(&gpu.device, &shadow, renderer.glass_layers()).unwrap();
        record(gpu, |encoder| {
            renderer.shadow_map(encoder, &shadow, &light.emitter, &projection, None);
            renderer.glass_map(encoder, &glass, &shadow, &light.emitter, &projection, None);
        });
        let map = ShadowMap {
            size,
            depth: read(gpu, shadow.texture()),
        };
        let cpu_glass = glass.read(&gpu.device, &gpu.queue).unwrap();
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
            ..LightInputs::default()
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
    let texture = |emitter: &Emitter| match emitter {
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
                texture: Some(texture(&rect)),
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
        if name.ends_with("reversed") {
            continue;
        }
        lights.push(("unshadowed", plain(emitter)));
        lights.push((
            "textured",
            Light {
                texture: Some(texture(&emitter)),
                ..shadowed
            },
        ));
    }
    lights
}
