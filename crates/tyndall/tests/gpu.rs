//! The GPU's techniques against their CPU twins, and the composite against its formula.

mod common;

use common::{
    SIZE, Stage, crowd, epipole_stages, fog_stages, gpu as on, noise, perspective_stages,
    seam_errors, stages, steps, svd, technique,
};
use tyndall::{
    CreateError, FrameInputs,
    camera::CameraRays,
    frame::{Emitter, Projection, ShadowProjection},
    techniques::{TechniqueChoice, Value},
};
use tyndall_testkit::{
    device::{TestDevice, device_or_skip, plain_device_or_skip},
    metrics::compare,
    picture::Picture,
    snapping::{nearest, shifts},
};

/// Same steps, same map; what differs is f32 against f64: texels and depths at a border that fall to the other side.
#[test]
fn marching_agrees_with_the_cpu() {
    let Some(gpu) = device_or_skip("ray march on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in stages().into_iter().chain(fog_stages()).chain([crowd()]) {
        for spacing in ["equal", "equiangular"] {
            let spacing = ("spacing", Value::Word(spacing.into()));
            let march = technique("ray-march", &[steps(128), spacing.clone()]);
            let ours = on::on_gpu(gpu, &effect, &stage, march.clone());
            let error = compare(&ours, &stage.on_cpu(march))
                .expect("same size")
                .rel_mae;
            // Largest measured on lavapipe: 8e-4.
            assert!(error < 2e-3, "{}, {spacing:?}: {error}", stage.name);
        }
    }
}

/// Both have one set of factors. Differences: a light's texture, which the GPU sums up in columns, and the svd's own terms under it.
#[test]
fn svd_agrees_with_the_cpu_and_with_closed_forms() {
    let Some(gpu) = device_or_skip("the svd integrator on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in perspective_stages().into_iter().step_by(2) {
        let ours = on::on_gpu(gpu, &effect, &stage, svd(4));
        let twin = stage.on_cpu(svd(4));
        let analytic = on::on_gpu(gpu, &effect, &stage, technique("min-max", &[]));
        let light = (&stage.frame.lights[0], &stage.lights[0]);
        // Largest measured on lavapipe: 0.038, 0.017 and 7.6e-4; 0.0149.
        let twin_bound = match (light.1.glass.is_some(), light.0.texture.is_some()) {
            (true, _) => 0.05,
            (false, true) => 0.025,
            (false, false) => 0.0015,
        };
        for (other, bound) in [(twin, twin_bound), (analytic, 0.02)] {
            let error = compare(&ours, &other).expect("same size").rel_mae;
            assert!(error < bound, "{}: {error}", stage.name);
        }
    }
}

/// Rays near the epipole are walked, the others go through trees: no seam between them.
#[test]
fn no_seam_about_the_epipole() {
    let Some(gpu) = device_or_skip("the epipole on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    for (stage, axis) in epipole_stages() {
        let truth = stage.on_cpu(of_the_map());
        let errors = seam_errors(&stage, axis, &truth, |t| {
            on::on_gpu(gpu, &effect, &stage, t)
        });
        for (radius, error) in errors {
            // Largest measured on lavapipe: 4.8e-4.
            assert!(error < 8e-4, "{}, {radius}: {error}", stage.name);
        }
    }
}

/// The stages of lights without textures, and one of all of these lights.
fn plain_stages() -> Vec<Stage> {
    let mut stages = stages();
    stages.retain(|stage| stage.frame.lights.iter().all(|l| l.texture.is_none()));
    let mut all = crowd();
    let (lights, pictures) = all
        .frame
        .lights
        .iter()
        .zip(&all.lights)
        .filter(|(light, _)| light.texture.is_none())
        .map(|(light, pictures)| (*light, pictures.clone()))
        .unzip();
    (all.frame.lights, all.lights) = (lights, pictures);
    stages.push(all);
    stages
}

fn light_volume(tolerance: f64) -> tyndall::techniques::Technique {
    technique("light-volume", &[("tolerance", Value::Real(tolerance))])
}

fn of_the_map() -> tyndall::techniques::Technique {
    let visibility = ("visibility", Value::Word("shadow-map".into()));
    technique("reference", &[("tolerance", Value::Real(1e-3)), visibility])
}

/// The error of a rasterised picture of a stage against the map. If it is past the bound, what the device's grid of sub-pixels
/// moves is allowed: pixels may show what is seen beside their centres.
fn raster_error(gpu: &TestDevice, stage: &Stage, found: &Picture, bound: f64) -> f64 {
    let error = |truth: &Picture| compare(found, truth).expect("same size").rel_mae;
    let at_centers = error(&stage.on_cpu(of_the_map()));
    if at_centers < bound {
        return at_centers;
    }
    let seen_from = |shift| {
        let mut stage = stage.clone();
        stage.frame.camera = stage.frame.camera.jittered(SIZE, shift);
        let picture = stage.on_cpu(technique("min-max", &[]));
        picture.pixels().as_flattened().to_vec()
    };
    let shifts = shifts(gpu, 2).expect("readable");
    let allowed: Vec<_> = shifts.into_iter().map(seen_from).collect();
    let values = nearest(found.pixels().as_flattened(), &allowed);
    let (pixels, _) = values.as_chunks::<3>();
    error(&Picture::new(found.size(), pixels.to_vec()).expect("as many pixels"))
}

/// Both have one map, the CPU with its exact texels. Differences: corners where three depths meet, and edges of a cube;
/// with half floats, where the device blends no others, their rounding.
#[test]
fn light_volumes_agree_with_the_map() {
    let Some(gpu) = device_or_skip("light volumes on the GPU") else {
        return;
    };
    let Some(plain) = plain_device_or_skip("light volumes without FLOAT32_BLENDABLE") else {
        return;
    };
    // Device, tolerance, and the bound of errors. Largest measured on lavapipe: 3.9e-3, 3.8e-3, 5.2e-3; on SwiftShader, whose grid
    // moves each vertex of three depths' corners for itself, 6.02e-3.
    let cases = [(gpu, 0.0, 6.5e-3), (gpu, 0.5, 6.5e-3), (&plain, 0.5, 8e-3)];
    let effects = cases.map(|(device, ..)| on::effect(device));
    for stage in plain_stages() {
        for ((device, tolerance, bound), effect) in cases.iter().zip(&effects) {
            let ours = on::on_gpu(device, effect, &stage, light_volume(*tolerance));
            let error = raster_error(device, &stage, &ours, *bound);
            assert!(error < *bound, "{}, {tolerance}: {error}", stage.name);
        }
    }
}

/// A stage with one depth, or nothing, all over its maps, and no glass.
fn with_flat_maps(mut stage: Stage, is_empty: bool) -> Stage {
    for (light, pictures) in stage.frame.lights.iter().zip(&mut stage.lights) {
        pictures.glass = None;
        let Some(map) = &mut pictures.shadow_map else {
            continue;
        };
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) =
            light.shadow.expect("a map has a projection");
        let nothing = if reversed_depth { 0.0 } else { 1.0 };
        let surface = map.depth.iter().copied().find(|d| *d != nothing);
        map.depth
            .fill(surface.filter(|_| !is_empty).unwrap_or(nothing));
    }
    stage
}

/// Rays that go from one face of a cube to another at a flat angle, where rounding decides on which side of the border they
/// are: they are walked to their end.
#[test]
fn rays_along_the_border_of_two_faces_are_walked_to_their_end() {
    let Some(gpu) = device_or_skip("the borders of a cube's faces") else {
        return;
    };
    let effect = on::effect(gpu);
    let lamps = plain_stages().into_iter();
    for stage in lamps.filter(|s| s.name.starts_with("lamp") && s.name.contains("orthographic")) {
        let mut stage = with_flat_maps(stage, false);
        let Emitter::Point { position, .. } = stage.frame.lights[0].emitter else {
            panic!("{} has a lamp", stage.name);
        };
        let camera = &mut stage.frame.camera;
        let from_light = [-10.954643, -17.829666, -2.179267];
        camera.eye = std::array::from_fn(|i| position[i] + from_light[i]);
        camera.forward = [0.48768044, 0.28731632, -0.8243885];
        camera.up = [-0.14628683, 0.95783573, 0.24728727];
        camera.projection = Projection::Orthographic {
            half_extent: [4.0, 3.0],
            center: [2.0, 8.0],
            near: 0.05,
            far: 113.0,
        };
        let exact = stage.on_cpu(of_the_map());
        let ours = on::on_gpu(gpu, &effect, &stage, technique("min-max", &[]));
        let error = compare(&ours, &exact).expect("same size");
        // Measured on lavapipe: 1.7e-3; 0.12 where a walk may go to and fro over a border.
        assert!(error.rel_mae < 3e-3, "{}: {}", stage.name, error.rel_mae);
    }
}

/// A surface that is everywhere equally far has an exact shadow volume; what differs are the airlight tables.
#[test]
fn light_volumes_of_flat_maps_are_exact() {
    let Some(gpu) = device_or_skip("light volumes of flat maps") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in plain_stages().into_iter().step_by(2) {
        let stage = with_flat_maps(stage, false);
        let ours = on::on_gpu(gpu, &effect, &stage, light_volume(0.5));
        let error = raster_error(gpu, &stage, &ours, 6e-4);
        // Largest measured on lavapipe: 4.2e-4.
        assert!(error < 6e-4, "{}: {error}", stage.name);
    }
}

/// If every texel stands out, the full mesh is drawn: its list would be too long.
#[test]
fn light_volumes_of_noise_are_drawn_in_full() {
    let Some(gpu) = device_or_skip("light volumes of noise") else {
        return;
    };
    let effect = on::effect(gpu);
    for mut stage in plain_stages().into_iter().step_by(6) {
        for pictures in &mut stage.lights {
            pictures.glass = None;
            for (i, depth) in pictures
                .shadow_map
                .iter_mut()
                .flat_map(|m| m.depth.iter_mut().enumerate())
            {
                *depth *= 0.5 + 0.5 * noise(i as u32);
            }
        }
        let [full, merged] = [0.0, 0.5].map(|t| on::on_gpu(gpu, &effect, &stage, light_volume(t)));
        let error = compare(&merged, &full).expect("same size").rel_mae;
        // Measured on lavapipe: none.
        assert!(error < 1e-6, "{}: {error}", stage.name);
    }
}

/// If nothing blocks the light, all jumps of visibility add up to the closed form.
#[test]
fn light_volumes_of_empty_maps_are_the_closed_form() {
    let Some(gpu) = device_or_skip("light volumes of empty maps") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in plain_stages() {
        let stage = with_flat_maps(stage, true);
        let mut bare = with_flat_maps(stage.clone(), true);
        for (light, pictures) in bare.frame.lights.iter_mut().zip(&mut bare.lights) {
            (light.shadow, pictures.shadow_map) = (None, None);
        }
        for tolerance in [0.0, 0.5] {
            let closed = on::on_gpu(gpu, &effect, &bare, light_volume(tolerance));
            let ours = on::on_gpu(gpu, &effect, &stage, light_volume(tolerance));
            let error = compare(&ours, &closed).expect("same size").rel_mae;
            // Measured on lavapipe: none.
            assert!(error < 1e-6, "{}, {tolerance}: {error}", stage.name);
        }
    }
}

fn voxels(resolution: i64) -> tyndall::techniques::Technique {
    technique("vsv", &[("resolution", Value::Integer(resolution))])
}

/// Both have one map, the CPU with its exact texels. Differences: borders, which voxels move by up to half of one, and
/// fewer with finer voxels; textures and glass, which are taken in the middle of a voxel.
#[test]
fn voxels_agree_with_the_map() {
    let Some(gpu) = device_or_skip("voxelized shadow volumes on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in stages().into_iter().step_by(2).chain([crowd()]) {
        let exact = stage.on_cpu(of_the_map());
        // Largest measured on lavapipe: 0.068 and 0.0151.
        for (resolution, bound) in [(64, 0.1), (256, 0.025)] {
            let ours = on::on_gpu(gpu, &effect, &stage, voxels(resolution));
            let error = compare(&ours, &exact).expect("same size").rel_mae;
            assert!(error < bound, "{}, {resolution}: {error}", stage.name);
        }
    }
}

#[test]
fn alpha_is_the_mean_transmittance() {
    let Some(gpu) = device_or_skip("transmittance on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    let mut stage = crowd();
    stage.frame.lights.clear();
    stage.lights.clear();
    let rays = CameraRays::new(&stage.frame.camera, SIZE);
    let optics = tyndall::physics::medium::Optics::new(&stage.frame.medium);
    let output = on::output(gpu, &effect, &stage, technique("ray-march", &[steps(1)]));
    for (i, pixel) in output.iter().enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let ray = rays.ray(x, y, stage.depth[i]);
        let mean = optics.transmittance(ray.length).element_sum() / 3.0;
        assert_eq!(pixel[..3], [0.0; 3]);
        assert!(
            (f64::from(pixel[3]) - mean).abs() < 1e-5,
            "{pixel:?} {mean}"
        );
    }
}

#[test]
fn composite_attenuates_and_adds_per_channel() {
    let Some(gpu) = device_or_skip("composite on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    let stage = crowd();
    let uploaded = on::Uploaded::new(gpu, &stage);
    let lights = uploaded.light_inputs();
    let inputs = FrameInputs {
        depth: &uploaded.depth,
        lights: &lights,
    };
    let mut view = effect.create_view(&gpu.device, SIZE).expect("a good size");
    effect
        .prepare(
            &gpu.device,
            &gpu.queue,
            &mut view,
            &inputs,
            &stage.frame,
            &TechniqueChoice::default(),
        )
        .expect("a good stage");
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: SIZE[0],
            height: SIZE[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: on::TARGET,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let background = wgpu::Color {
        r: 1.0,
        g: 2.0,
        b: 4.0,
        a: 0.5,
    };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    effect.record(&mut encoder, &mut view, None);
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(background),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        effect.composite(&mut pass, &view);
    }
    gpu.queue.submit([encoder.finish()]);
    let composed: Vec<[u16; 4]> = gpu.read_texture(&target).expect("readable");
    let in_scatter: Vec<[f32; 4]> = gpu.read_texture(view.output().texture()).expect("readable");

    let rays = CameraRays::new(&stage.frame.camera, SIZE);
    let optics = tyndall::physics::medium::Optics::new(&stage.frame.medium);
    for (i, (found, light)) in composed.iter().zip(&in_scatter).enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let left = optics
            .transmittance(rays.ray(x, y, stage.depth[i]).length)
            .to_array();
        for channel in 0..3 {
            let exact = [1.0, 2.0, 4.0][channel] * left[channel] + f64::from(light[channel]);
            let found = half::f16::from_bits(found[channel]).to_f64();
            // Two roundings to 11 bits, which some drivers do by cutting off.
            assert!(
                (found - exact).abs() < 2.2e-3 * exact,
                "{channel}: {found} {exact}"
            );
        }
        assert_eq!(half::f16::from_bits(found[3]).to_f32(), 0.5);
    }
}

#[test]
fn what_cannot_be_made_is_refused() {
    let Some(gpu) = device_or_skip("refusals on the GPU") else {
        return;
    };
    let effect = on::effect(gpu);
    let limit = gpu.device.limits().max_texture_dimension_2d;
    for size in [[0, 4], [4, limit + 1]] {
        let refused = effect.create_view(&gpu.device, size).err();
        assert_eq!(refused, Some(CreateError::Size { size, limit }));
    }
    let stage = crowd();
    let uploaded = on::Uploaded::new(gpu, &stage);
    let lights = uploaded.light_inputs();
    let mut view = effect
        .create_view(&gpu.device, [8, 8])
        .expect("a good size");
    let mut refusal = |lights: &[tyndall::LightInputs<'_>], technique| {
        let frame = stage.frame.clone();
        let frame_by = TechniqueChoice::from(technique);
        let inputs = FrameInputs {
            depth: &uploaded.depth,
            lights,
        };
        effect
            .prepare(
                &gpu.device,
                &gpu.queue,
                &mut view,
                &inputs,
                &frame,
                &frame_by,
            )
            .expect_err("refused")
            .to_string()
    };
    assert_eq!(
        refusal(&lights, technique("ray-march", &[])),
        "`inputs.depth` must be a texture of the view's size, found [48, 36]"
    );
    assert_eq!(
        refusal(&lights, technique("reference", &[])),
        "technique `reference` cannot do its work on the GPU"
    );
    let mut view = effect.create_view(&gpu.device, SIZE).expect("a good size");
    let frame = stage.frame.clone();
    let frame_by = TechniqueChoice::from(light_volume(0.5));
    let inputs = FrameInputs {
        depth: &uploaded.depth,
        lights: &lights,
    };
    let mut flat = stage.frame.clone();
    let flat_by = TechniqueChoice::from(svd(4));
    flat.camera.projection = Projection::Orthographic {
        half_extent: [4.0, 3.0],
        center: [0.0; 2],
        near: 0.5,
        far: 20.0,
    };
    let refused = effect.prepare(&gpu.device, &gpu.queue, &mut view, &inputs, &flat, &flat_by);
    assert_eq!(
        refused.expect_err("no eye").to_string(),
        "technique `min-max` cannot do the svd integrator with an orthographic camera"
    );
    let most = Value::Integer(16384);
    let fine = stage.frame.clone();
    let fine_by = TechniqueChoice::from(technique(
        "min-max",
        &[("slices", most.clone()), ("samples", most)],
    ));
    let refused = effect.prepare(&gpu.device, &gpu.queue, &mut view, &inputs, &fine, &fine_by);
    let limit = gpu.device.limits().max_storage_buffer_binding_size;
    assert_eq!(
        refused.expect_err("2 GiB of nodes").to_string(),
        format!(
            "slices x samples of technique `min-max` (lights[0]): 2147483648 bytes are more than the device's \
             max_storage_buffer_binding_size, {limit}"
        )
    );
    let refused = effect.prepare(
        &gpu.device,
        &gpu.queue,
        &mut view,
        &inputs,
        &frame,
        &frame_by,
    );
    assert_eq!(
        refused.expect_err("a light through a texture").to_string(),
        "technique `light-volume` cannot do light textures (lights[2])"
    );
}
