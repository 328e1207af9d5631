//! Cameras that may show a scene well.

use std::f32::consts::{PI, TAU};

use glam::{DVec3, Vec3, vec3};
use rayon::prelude::*;
use tyndall::frame::Camera;

use crate::{
    geometry::Bounds,
    trace::Tracer,
    view::{Ray, View},
};

/// Vertical field of view inside and outside \[degrees].
const INSIDE_YFOV: f32 = 65.0;
const OUTSIDE_YFOV: f32 = 45.0;

/// Points at which a scene is asked whether it is an interior, and directions from each.
const POINTS: u32 = 384;
const DIRECTIONS: u32 = 32;

/// Share of directions that end at the front of a surface where a point counts as inside. Windows and doors let the
/// others out; the backs of surfaces are seen from inside of solid things.
const ENCLOSED: f32 = 0.7;

/// Share of points inside that makes a scene an interior.
const INTERIOR: f32 = 0.15;

/// Spots inside that are looked at closely, headings of the cameras at each, and cameras that remain.
const SPOTS: usize = 64;
const HEADINGS: u32 = 12;
const KEPT: usize = 6;

/// Least distance of a camera inside from surfaces, as a share of the scene's diagonal.
const CLEARANCE: f32 = 0.02;

/// Views from all round a thing.
const OUTSIDE_VIEWS: u32 = 12;
/// Pitches below the horizon of a camera outside, and above it of one inside \[rad].
const OUTSIDE_PITCH: f32 = 0.35;
const INSIDE_PITCH: f32 = 0.10;

/// A person's eye, and the least and largest share of a room's height it may be at.
const EYE_HEIGHT: f32 = 1.7;
const EYE_SHARE: [f32; 2] = [0.15, 0.45];

/// At least one camera.
pub(super) fn cameras(tracer: &Tracer, bounds: &Bounds, aspect: f32) -> Vec<Camera> {
    let inside: Vec<Vec3> = halton(POINTS)
        .map(|unit| bounds.min + unit * bounds.extent())
        .collect::<Vec<_>>()
        .into_par_iter()
        .filter(|&point| is_enclosed(tracer, point, bounds))
        .collect();
    if inside.len() as f32 >= INTERIOR * POINTS as f32 {
        let cameras = inside_cameras(tracer, &inside, bounds, aspect);
        if !cameras.is_empty() {
            return cameras;
        }
    }
    (0..OUTSIDE_VIEWS)
        .map(|i| {
            outside_camera(
                bounds,
                aspect,
                TAU * (i as f32 + 0.5) / OUTSIDE_VIEWS as f32,
            )
        })
        .collect()
}

fn is_enclosed(tracer: &Tracer, point: Vec3, bounds: &Bounds) -> bool {
    let normals = &tracer.geometry().normals;
    let far = f64::from(bounds.extent().length());
    let fronts = sphere(DIRECTIONS)
        .filter(|&direction| {
            let ray = ray(point, direction);
            tracer
                .closest(&ray, [0.0, far])
                .is_some_and(|hit| normals[hit.triangle][0].dot(direction) < 0.0)
        })
        .count();
    fronts as f32 >= ENCLOSED * DIRECTIONS as f32
}

/// The cameras with the longest free views, none of them much like another.
fn inside_cameras(tracer: &Tracer, inside: &[Vec3], bounds: &Bounds, aspect: f32) -> Vec<Camera> {
    let far = bounds.extent().length();
    let mut views: Vec<(f32, Camera)> = inside
        .par_iter()
        .take(SPOTS)
        .filter_map(|&point| at_eye_height(tracer, point, far))
        .filter(|&eye| is_enclosed(tracer, eye, bounds))
        .filter(|&eye| clearance(tracer, eye, far) >= CLEARANCE * far)
        .flat_map_iter(|eye| {
            (0..HEADINGS).map(move |i| {
                let heading = TAU * i as f32 / HEADINGS as f32;
                let target = eye + looking(heading, INSIDE_PITCH);
                let camera = perspective(eye, target, INSIDE_YFOV, aspect, [1e-3 * far, far]);
                (openness(tracer, &camera, far), camera)
            })
        })
        .collect();
    views.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut kept: Vec<Camera> = Vec::new();
    for (_, camera) in views {
        if kept.len() < KEPT && !kept.iter().any(|other| are_alike(&camera, other, far)) {
            kept.push(camera);
        }
    }
    kept
}

/// True if two cameras stand close together and look in about the same direction.
fn are_alike(a: &Camera, b: &Camera, far: f32) -> bool {
    let distance = Vec3::from(a.eye).distance(Vec3::from(b.eye));
    distance < 0.1 * far && Vec3::from(a.forward).dot(Vec3::from(b.forward)) > 0.7
}

/// The point moved up or down to where somebody on the floor has his eyes; `None` without floor or ceiling.
fn at_eye_height(tracer: &Tracer, point: Vec3, far: f32) -> Option<Vec3> {
    let down = free_length(tracer, point, Vec3::NEG_Y, far)?;
    let up = free_length(tracer, point, Vec3::Y, far)?;
    let [least, most] = EYE_SHARE.map(|share| share * (up + down));
    Some(point + (EYE_HEIGHT.clamp(least, most) - down) * Vec3::Y)
}

/// Distance to the nearest surface, as far as a few directions tell.
fn clearance(tracer: &Tracer, point: Vec3, far: f32) -> f32 {
    sphere(DIRECTIONS)
        .filter_map(|direction| free_length(tracer, point, direction, far))
        .fold(far, f32::min)
}

/// Sum of the square roots of a few view rays' lengths: long views, but none blocked close by. A ray that leaves
/// the interior sees nothing of it.
fn openness(tracer: &Tracer, camera: &Camera, far: f32) -> f32 {
    const RAYS: [u32; 2] = [7, 5];
    let view = View::new(camera, RAYS);
    (0..RAYS[0] * RAYS[1])
        .map(|i| view.ray(i % RAYS[0], i / RAYS[0]))
        .filter_map(|ray| tracer.closest(&ray, [0.0, f64::from(far)]))
        .map(|hit| hit.distance.sqrt() as f32)
        .sum()
}

/// Looks at the middle of the bounds from a heading, from so far that all of them are in the image.
fn outside_camera(bounds: &Bounds, aspect: f32, heading: f32) -> Camera {
    const MARGIN: f32 = 1.03;
    let forward = looking(heading, -OUTSIDE_PITCH);
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let tangent = (0.5 * OUTSIDE_YFOV.to_radians()).tan() / MARGIN;
    let half = 0.5 * bounds.extent();
    let distance = [-1.0, 1.0]
        .iter()
        .flat_map(|x| [-1.0, 1.0].map(|y| (*x, y)))
        .flat_map(|(x, y)| [-1.0, 1.0].map(|z| half * vec3(x, y, z)))
        .map(|corner| {
            let across = corner.dot(right).abs() / (tangent * aspect);
            let along = corner.dot(up).abs() / tangent;
            across.max(along) - corner.dot(forward)
        })
        .fold(f32::MIN_POSITIVE, f32::max);
    let far = distance + 2.0 * half.length();
    let eye = bounds.center() - distance * forward;
    perspective(
        eye,
        bounds.center(),
        OUTSIDE_YFOV,
        aspect,
        [1e-3 * far, far],
    )
}

fn perspective(eye: Vec3, target: Vec3, yfov: f32, aspect: f32, [near, far]: [f32; 2]) -> Camera {
    let (eye, target) = (eye.to_array(), target.to_array());
    Camera::perspective(
        eye,
        target,
        [0.0, 1.0, 0.0],
        yfov.to_radians(),
        aspect,
        near,
        far,
    )
}

/// The unit vector of a heading round Y and a pitch above the horizon \[rad].
fn looking(heading: f32, pitch: f32) -> Vec3 {
    vec3(
        heading.cos() * pitch.cos(),
        pitch.sin(),
        heading.sin() * pitch.cos(),
    )
}

fn free_length(tracer: &Tracer, origin: Vec3, direction: Vec3, far: f32) -> Option<f32> {
    tracer
        .closest(&ray(origin, direction), [0.0, f64::from(far)])
        .map(|hit| hit.distance as f32)
}

fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray {
        origin: origin.as_dvec3(),
        direction: DVec3::normalize(direction.as_dvec3()),
    }
}

/// Directions spread evenly over the sphere: a Fibonacci lattice.
fn sphere(count: u32) -> impl Iterator<Item = Vec3> {
    let golden_angle = PI * (3.0 - 5f32.sqrt());
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
        let radius = (1.0 - y * y).sqrt();
        let angle = golden_angle * i as f32;
        vec3(radius * angle.cos(), y, radius * angle.sin())
    })
}

/// Points spread evenly over the unit cube (Halton 1960).
fn halton(count: u32) -> impl Iterator<Item = Vec3> {
    (1..=count).map(|i| Vec3::from([2, 3, 5].map(|base| radical_inverse(i, base))))
}

fn radical_inverse(mut index: u32, base: u32) -> f32 {
    let (mut inverse, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f32;
        inverse += digit * (index % base) as f32;
        index /= base;
    }
    inverse
}
