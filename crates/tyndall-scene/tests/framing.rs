//! Cameras, suns and hazes for scenes that have none.

use std::path::Path;

use glam::{Affine3A, Quat, Vec2, Vec3, vec3};
use tyndall::frame::{Camera, Emitter, Projection};
use tyndall_scene::{
    builtin::builtin,
    framing::{Framing, cameras, frame_scene, lights},
    load::load,
    scene::{Blocking, Material, Mesh, Node, Primitive, Scene},
    trace::Tracer,
    view::{Ray, View},
};

const ASPECT: f32 = 4.0 / 3.0;

fn node(parent_from_local: Affine3A) -> Node {
    Node {
        name: "node".to_owned(),
        parent: None,
        parent_from_local: parent_from_local.as_daffine3(),
        mesh: None,
        camera: None,
        light: None,
    }
}

/// A unit cube's faces, seen from outside or from inside, stretched.
fn cube_scene(size: Vec3, from_inside: bool) -> Scene {
    let mut cube = Primitive::default();
    for axis in 0..3 {
        for sign in [-0.5, 0.5] {
            let normal = Vec3::AXES[axis] * sign * 2.0;
            let u = Vec3::AXES[(axis + 1) % 3] * 0.5 * if from_inside { -1.0 } else { 1.0 };
            let v = normal.cross(u);
            let first = cube.positions.len() as u32;
            let corners = [-u - v, u - v, u + v, v - u].map(|corner| corner + 0.5 * normal);
            cube.positions.extend(corners.map(|corner| corner * size));
            cube.normals
                .extend([if from_inside { -normal } else { normal }; 4]);
            cube.uvs.extend([Vec2::ZERO; 4]);
            cube.indices
                .extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        }
    }
    Scene {
        nodes: vec![Node {
            mesh: Some(0),
            ..node(Affine3A::IDENTITY)
        }],
        meshes: vec![Mesh {
            primitives: vec![cube],
        }],
        materials: vec![Material {
            base_color: [1.0; 4],
            base_color_texture: None,
            blocking: Blocking::Opaque,
            emissive: [0.0; 3],
        }],
        ..Scene::default()
    }
}

fn frame(scene: &Scene) -> (Tracer, Framing) {
    let tracer = Tracer::new(scene);
    let framing = frame_scene(scene, &tracer, ASPECT);
    (tracer, framing)
}

/// Normalised device coordinates of a point in the image, each in [-1, 1], if it is between the planes.
fn project(camera: &Camera, point: Vec3) -> Option<Vec2> {
    let Projection::Perspective {
        half_extent,
        near,
        far,
        ..
    } = camera.projection
    else {
        return None;
    };
    let forward = Vec3::from(camera.forward).normalize();
    let right = forward.cross(camera.up.into()).normalize();
    let from_eye = point - Vec3::from(camera.eye);
    let depth = from_eye.dot(forward);
    let tangents = Vec2::new(from_eye.dot(right), from_eye.dot(right.cross(forward))) / depth;
    (near..=far)
        .contains(&depth)
        .then(|| tangents / Vec2::from(half_extent))
}

#[test]
fn things_are_seen_whole_from_outside() {
    for size in [Vec3::ONE, vec3(100.0, 3.0, 100.0), vec3(0.1, 5.0, 0.2)] {
        let (_, framing) = frame(&cube_scene(size, false));
        let mut reach: f32 = 0.0;
        for corner in 0..8 {
            let unit = [0, 1, 2].map(|i| (corner >> i & 1) as f32 - 0.5);
            let seen = project(&framing.camera, Vec3::from(unit) * size);
            reach = reach.max(seen.expect("between the planes").abs().max_element());
        }
        // The camera's margin is 3 %.
        assert!((0.9..1.0).contains(&reach), "{size}: {reach}");
    }
}

#[test]
fn closed_rooms_are_seen_from_inside_by_a_lamp() {
    let size = vec3(8.0, 3.0, 5.0);
    let (_, framing) = frame(&cube_scene(size, true));
    let eye = Vec3::from(framing.camera.eye);
    assert!(eye.abs().cmplt(0.5 * size).all(), "{eye}");
    // Eyes are at most 45 % up.
    assert!(eye.y < 0.0, "{eye}");
    let [Emitter::Point { position, .. }] = framing.lights[..] else {
        panic!("{:?}", framing.lights)
    };
    assert!(Vec3::from(position).abs().cmplt(0.5 * size).all());
}

#[test]
fn solid_things_are_not_rooms() {
    let (_, framing) = frame(&cube_scene(Vec3::ONE, false));
    assert!(Vec3::from(framing.camera.eye).abs().max_element() > 0.5);
    assert!(matches!(framing.lights[..], [Emitter::Directional { .. }]));
}

#[test]
fn nothing_is_framed_too() {
    let (_, framing) = frame(&Scene::default());
    assert!(matches!(framing.lights[..], [Emitter::Directional { .. }]));
    let sigma_t = framing.medium.components[0].sigma_s[0];
    assert!(sigma_t.is_finite() && sigma_t > 0.0);
}

#[test]
fn cameras_and_lights_stand_where_their_nodes_do() {
    let parent = Affine3A::from_scale_rotation_translation(
        Vec3::splat(2.0),
        Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
        vec3(1.0, 2.0, 3.0),
    );
    let spot = Emitter::Spot {
        position: [0.0; 3],
        direction: [0.0, 0.0, -1.0],
        intensity: [5.0; 3],
        inner: 0.1,
        outer: 0.2,
        radius: 0.0,
    };
    let projection = Projection::Perspective {
        half_extent: [9.0, 0.5],
        center: [0.0; 2],
        near: 0.1,
        far: 10.0,
    };
    let scene = Scene {
        nodes: vec![
            node(parent),
            Node {
                parent: Some(0),
                camera: Some(projection),
                light: Some(spot),
                ..node(Affine3A::from_translation(vec3(0.0, 0.0, -1.0)))
            },
            Node {
                camera: Some(projection),
                light: Some(spot),
                ..node(Affine3A::from_scale(Vec3::ZERO))
            },
        ],
        ..Scene::default()
    };
    // A node that is scaled to nothing looks nowhere and is left out.
    let [(_, camera)] = &cameras(&scene, 2.0)[..] else {
        panic!("one camera")
    };
    let [
        (
            _,
            Emitter::Spot {
                position,
                direction,
                intensity,
                ..
            },
        ),
    ] = lights(&scene)[..]
    else {
        panic!("one spot")
    };
    // Measured: 1e-7, rounding.
    let near = |a: [f32; 3], b: Vec3| Vec3::from(a).abs_diff_eq(b, 1e-6);
    assert!(near(camera.eye, vec3(-1.0, 2.0, 3.0)), "{camera:?}");
    assert!(near(camera.forward, Vec3::NEG_X), "{camera:?}");
    assert!(near(camera.up, Vec3::Y), "{camera:?}");
    assert!(near(position, vec3(-1.0, 2.0, 3.0)) && near(direction, Vec3::NEG_X));
    assert_eq!(intensity, [5.0; 3]);
    let Projection::Perspective { half_extent, .. } = camera.projection else {
        panic!("{camera:?}")
    };
    assert_eq!(half_extent, [1.0, 0.5]);
}

/// Share of the medium in a view that the framing's suns reach; not a number where there are none.
fn lit_share(tracer: &Tracer, framing: &Framing) -> f64 {
    const SIZE: [u32; 2] = [24, 18];
    const POINTS: u32 = 16;
    let view = View::new(&framing.camera, SIZE);
    let (mut lit, mut all) = (0, 0);
    for light in &framing.lights {
        let Emitter::Directional { direction, .. } = *light else {
            continue;
        };
        let to_light = -Vec3::from(direction).as_dvec3().normalize();
        for pixel in 0..SIZE[0] * SIZE[1] {
            let ray = view.ray(pixel % SIZE[0], pixel / SIZE[0]);
            let span = view.span(&ray);
            let end = tracer
                .closest(&ray, span)
                .map_or(span[1], |hit| hit.distance);
            for i in 0..POINTS {
                let shadow_ray = Ray {
                    origin: ray.at(end * (f64::from(i) + 0.5) / f64::from(POINTS)),
                    direction: to_light,
                };
                all += 1;
                lit += u32::from(!tracer.blocked(&shadow_ray, [1e-3, 1e6]));
            }
        }
    }
    f64::from(lit) / f64::from(all)
}

#[test]
fn stripped_of_camera_and_sun_the_church_still_shows_shafts() {
    let mut church = builtin("church").unwrap();
    church.nodes.retain(|node| node.mesh.is_some());
    let (tracer, framing) = frame(&church);
    let eye = Vec3::from(framing.camera.eye);
    assert!(
        eye.x.abs() < 8.0 && (0.5..8.0).contains(&eye.y) && eye.z.abs() < 18.0,
        "{eye}"
    );
    let share = lit_share(&tracer, &framing);
    // Measured: 0.09, the light of the rose window.
    assert!((0.005..0.5).contains(&share), "{share}");
    assert_eq!(framing, frame_scene(&church, &tracer, ASPECT));
}

#[test]
fn interiors_made_by_others_show_shafts() {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    if !assets.is_dir() {
        eprintln!(
            "skipped: interiors made by others: there is no {}",
            assets.display()
        );
        return;
    }
    for name in ["hall.glb", "sibenik.glb"] {
        let (tracer, framing) = frame(&load(&assets.join(name)).unwrap());
        let bounds = tracer.geometry().bounds().unwrap();
        let eye = Vec3::from(framing.camera.eye);
        assert!(
            eye.cmpgt(bounds.min).all() && eye.cmplt(bounds.max).all(),
            "{name}: {eye}"
        );
        let share = lit_share(&tracer, &framing);
        // Measured: hall 0.014, sibenik 0.013.
        assert!((0.005..0.5).contains(&share), "{name}: {share}");
    }
}
