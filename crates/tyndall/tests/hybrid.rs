//! `hybrid`: its bounds hold every shadow, and its light is that of the same steps without bounds.

mod common;

use common::{SIZE, Stage, gpu as on, noise, stages, steps, technique};
use glam::{Affine3A, DVec3, Mat4, Quat, Vec3};
use tyndall::{
    Effect, FrameInputs, LightInputs, Occluder, OccluderMesh,
    camera::{CameraRays, Ray},
    frame::Emitter,
    techniques::{Technique, TechniqueChoice, Value},
};
use tyndall_testkit::{
    device::{TestDevice, device_or_skip},
    metrics::compare,
};

/// Triangles, not indexed.
type Soup = Vec<[Vec3; 3]>;

fn random_point(seed: u32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|k| 2.0 * noise(3 * seed + k) - 1.0))
}

/// Small triangles all over the place: open, and of no orientation.
fn scattered(seed: u32) -> Soup {
    let triangle = |i: u32| {
        let center = 3.0 * random_point(seed + 4 * i);
        [1, 2, 3].map(|k| center + 0.6 * random_point(seed + 4 * i + k))
    };
    (0..24).map(triangle).collect()
}

/// A closed box.
fn block() -> Soup {
    let corner =
        |i: usize| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 }));
    [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ]
    .iter()
    .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
    .map(|triangle| triangle.map(corner))
    .collect()
}

/// Five triangles that share one edge.
fn fins() -> Soup {
    let tip = |i: u32| 1.5 * random_point(77 + i);
    (0..5).map(|i| [Vec3::NEG_Y, Vec3::Y, tip(i)]).collect()
}

/// A ball without its lower quarter.
fn bowl() -> Soup {
    let point = |i: i32, j: i32| {
        let (polar, azimuth) = (0.3 * i as f32, 0.7 * j as f32);
        Quat::from_rotation_y(azimuth) * Quat::from_rotation_x(polar) * Vec3::Y
    };
    (0..8)
        .flat_map(|i| (0..9).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// A mesh somewhere.
struct Placed {
    soup: Soup,
    place: Affine3A,
}

fn worlds() -> Vec<(&'static str, Vec<Placed>)> {
    let placed = |soup: Soup, scale: f32, turn: f32, at: [f32; 3]| Placed {
        soup,
        place: Affine3A::from_scale_rotation_translation(
            Vec3::new(scale, 0.8 * scale, -scale),
            Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), turn),
            at.into(),
        ),
    };
    vec![
        ("scattered", vec![placed(scattered(1), 1.0, 0.3, [0.0; 3])]),
        (
            "boxes",
            vec![
                placed(block(), 0.7, 0.4, [0.5, 0.0, 1.0]),
                placed(block(), 0.2, 2.0, [-1.0, 1.0, -1.0]),
            ],
        ),
        ("fins", vec![placed(fins(), 1.0, 1.0, [0.3, 0.5, 0.0])]),
        (
            "a bowl, and a box about everything",
            vec![
                placed(bowl(), 0.9, 0.2, [0.0, 0.6, 0.4]),
                placed(block(), 40.0, 0.1, [0.0; 3]),
            ],
        ),
        ("nothing", vec![]),
    ]
}

/// The shadowed part of a ray, by asking many of its points; triangles are taken a little smaller than they are, for the
/// borders of their shadows may fall to either side.
fn shadowed(ray: &Ray, emitter: &Emitter, triangles: &[[DVec3; 3]]) -> Option<[f64; 2]> {
    const POINTS: u32 = 48;
    const SHRUNK: f64 = 4e-3;
    let is_dark = |point: DVec3| {
        let (way, reach) = match *emitter {
            Emitter::Directional { direction, .. } => {
                (-DVec3::from(direction.map(f64::from)), f64::INFINITY)
            }
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                (DVec3::from(position.map(f64::from)) - point, 1.0)
            }
            Emitter::Rect { .. } => unreachable!("no stage has one"),
        };
        triangles.iter().any(|[a, b, c]| {
            let (ab, ac) = (b - a, c - a);
            let across = way.cross(ac);
            let inverse = across.dot(ab).recip();
            let offset = point - a;
            let u = inverse * across.dot(offset);
            let v = inverse * offset.cross(ab).dot(way);
            let t = inverse * offset.cross(ab).dot(ac);
            u > SHRUNK && v > SHRUNK && u + v < 1.0 - SHRUNK && t > 1e-6 && t < reach
        })
    };
    let dark = (0..POINTS)
        .map(|i| (f64::from(i) + 0.5) / f64::from(POINTS) * ray.length)
        .filter(|s| is_dark(ray.origin + *s * ray.direction));
    dark.fold(None, |range, s| {
        Some([range.map_or(s, |[first, _]: [f64; 2]| first), s])
    })
}

fn mesh(gpu: &TestDevice, soup: &Soup) -> OccluderMesh {
    let positions: Vec<[f32; 3]> = soup.iter().flatten().map(|p| p.to_array()).collect();
    let indices: Vec<u32> = (0..positions.len() as u32).collect();
    OccluderMesh::new(&gpu.device, &positions, &indices).expect("a good mesh")
}

/// The output of `hybrid` in a world.
fn output(
    gpu: &TestDevice,
    effect: &Effect,
    stage: &Stage,
    world: &[Placed],
    technique: Technique,
) -> Vec<[f32; 4]> {
    let meshes: Vec<OccluderMesh> = world.iter().map(|placed| mesh(gpu, &placed.soup)).collect();
    let places = world.iter().map(|placed| placed.place);
    let occluders: Vec<Occluder<'_>> = meshes.iter().zip(places).map(occluder).collect();
    output_of(gpu, effect, stage, &occluders, technique)
}

fn occluder((mesh, place): (&OccluderMesh, Affine3A)) -> Occluder<'_> {
    Occluder {
        mesh,
        world_from_mesh: Mat4::from(place).to_cols_array_2d(),
    }
}

/// The output of `hybrid` with these occluders.
fn output_of(
    gpu: &TestDevice,
    effect: &Effect,
    stage: &Stage,
    occluders: &[Occluder<'_>],
    technique: Technique,
) -> Vec<[f32; 4]> {
    let frame = stage.frame.clone();
    let frame_by = TechniqueChoice::from(technique);
    let uploaded = on::Uploaded::new(gpu, stage);
    let mut lights = uploaded.light_inputs();
    for light in &mut lights {
        *light = LightInputs {
            occluders: Some(occluders),
            ..*light
        };
    }
    let inputs = FrameInputs {
        depth: &uploaded.depth,
        lights: &lights,
    };
    let mut view = effect.create_view(&gpu.device, SIZE).expect("a good size");
    let prepared = effect.prepare(
        &gpu.device,
        &gpu.queue,
        &mut view,
        &inputs,
        &frame,
        &frame_by,
    );
    prepared.expect("a good stage");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    effect.record(&mut encoder, &mut view, None);
    gpu.queue.submit([encoder.finish()]);
    gpu.read_texture(view.output().texture()).expect("readable")
}

/// Lights without textures, without glass.
fn plain_stages() -> Vec<Stage> {
    let mut stages = stages();
    stages.retain(|stage| {
        stage.lights[0].texture.is_none() && stage.frame.lights[0].texture.is_none()
    });
    for stage in &mut stages {
        stage.lights[0].glass = None;
    }
    stages
}

#[test]
fn bounds_hold_every_shadow() {
    let Some(gpu) = device_or_skip("bounds of shadow volumes") else {
        return;
    };
    let effect = on::effect(gpu);
    let bounds = technique("hybrid", &[("show", Value::Word("bounds".into()))]);
    let (mut shadows, mut spare, mut rays_without) = (0, 0.0, 0);
    for mut stage in plain_stages() {
        // The stages' maps are not of these triangles.
        stage.frame.lights[0].shadow = None;
        stage.lights[0].shadow_map = None;
        if stage.name.starts_with("sun without") || stage.name.starts_with("lamp, standard") {
            continue;
        }
        let rays = CameraRays::new(&stage.frame.camera, SIZE);
        for (name, world) in worlds() {
            let shown = output(gpu, &effect, &stage, &world, bounds.clone());
            let triangles: Vec<[DVec3; 3]> = world
                .iter()
                .flat_map(|placed| placed.soup.iter().map(|t| (t, &placed.place)))
                .map(|(triangle, place)| triangle.map(|p| place.transform_point3(p).as_dvec3()))
                .collect();
            for (i, [front, back, ..]) in shown.into_iter().enumerate().step_by(3) {
                let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
                let ray = rays.ray(x, y, stage.depth[i]);
                let [front, back] = [front, back].map(f64::from);
                let Some([first, last]) =
                    shadowed(&ray, &stage.frame.lights[0].emitter, &triangles)
                else {
                    rays_without += usize::from(front >= back);
                    continue;
                };
                assert!(
                    front <= first && last <= back,
                    "{}, {name}, pixel {x} {y}: {front}..{back} m, shadows from {first} to {last}",
                    stage.name
                );
                // Volumes do not know of the cone: a hemisphere's are the lamp's, which are counted once.
                if !stage.name.starts_with("hemisphere") {
                    shadows += 1;
                    spare += (back - front - (last - first)) / ray.length;
                }
            }
        }
    }
    // Most rays without shadows are known to be so, and the bounds of the others are not just the whole ray. What is spare
    // is mostly between the points that are asked, and rays that start in a shadow or end in one beyond their end; and what a
    // tile's other rays see, a twelfth of such a small picture away. Measured: 0.27.
    let spare = spare / f64::from(shadows);
    println!("{shadows} rays with shadows, {rays_without} without, spare {spare}");
    assert!(
        shadows > 5_000 && rays_without > 5_000,
        "{shadows} {rays_without}"
    );
    assert!(spare < 0.3, "{spare}");
}

/// More places of one mesh than a dispatch may have layers: the last of them is looked at as if it were alone.
#[test]
fn no_place_of_many_is_left_out() {
    const PLACES: usize = 66_000;
    let Some(gpu) = device_or_skip("many occluders of one mesh") else {
        return;
    };
    let effect = on::effect(gpu);
    let bounds = technique("hybrid", &[("show", Value::Word("bounds".into()))]);
    let mut stage = plain_stages().swap_remove(0);
    stage.frame.lights[0].shadow = None;
    stage.lights[0].shadow_map = None;
    let block = mesh(gpu, &block());
    // Specks, far off where no ray gets.
    let far = Affine3A::from_scale_rotation_translation(
        Vec3::splat(1e-3),
        Quat::IDENTITY,
        Vec3::new(0.0, -5e3, 0.0),
    );
    let near = Affine3A::from_scale(Vec3::splat(0.7));
    let mut occluders = vec![occluder((&block, far)); PLACES];
    occluders.push(occluder((&block, near)));
    let [many, alone] = [&occluders[..], &occluders[PLACES..]]
        .map(|o| output_of(gpu, &effect, &stage, o, bounds.clone()));
    let without = output_of(gpu, &effect, &stage, &[], bounds);
    assert!(many == alone, "the last of {PLACES} is not as it is alone");
    assert!(alone != without, "{} sees no shadow", stage.name);
}

fn of_the_map() -> Technique {
    let visibility = ("visibility", Value::Word("shadow-map".into()));
    technique("reference", &[("tolerance", Value::Real(1e-4)), visibility])
}

/// Nothing blocks any light: closed forms alone.
#[test]
fn without_shadows_light_is_in_closed_form() {
    let Some(gpu) = device_or_skip("hybrid without shadows") else {
        return;
    };
    let effect = on::effect(gpu);
    for mut stage in plain_stages().into_iter().step_by(2) {
        stage.frame.lights[0].shadow = None;
        stage.lights[0].shadow_map = None;
        let ours = output(gpu, &effect, &stage, &[], technique("hybrid", &[steps(1)]));
        let exact = stage.on_cpu(of_the_map());
        let error = compare(&common::picture(&ours), &exact)
            .expect("same size")
            .rel_mae;
        assert!(error < 6e-4, "{}: {error}", stage.name);
    }
}

/// Rays that are not known to be bounded are marched; so is light through textures and glass.
#[test]
fn without_bounds_rays_are_marched() {
    let Some(gpu) = device_or_skip("hybrid without bounds") else {
        return;
    };
    let effect = on::effect(gpu);
    for stage in stages().into_iter().step_by(3) {
        let march = on::on_gpu(gpu, &effect, &stage, technique("ray-march", &[steps(64)]));
        let ours = on::on_gpu(gpu, &effect, &stage, technique("hybrid", &[steps(64)]));
        let error = compare(&ours, &march).expect("same size").rel_mae;
        // Measured on lavapipe: none.
        assert!(error < 1e-6, "{}: {error}", stage.name);
        let with_picture = stage.lights[0].texture.is_some() || stage.lights[0].glass.is_some();
        if with_picture {
            let bounded = output(gpu, &effect, &stage, &[], technique("hybrid", &[steps(64)]));
            let error = compare(&common::picture(&bounded), &march)
                .expect("same size")
                .rel_mae;
            assert!(error < 1e-6, "{}: {error}", stage.name);
        }
    }
}
