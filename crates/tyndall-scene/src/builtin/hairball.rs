//! A ball of thin tubes over a floor.

use std::f32::consts::TAU;

use glam::{Affine3A, Vec3, vec3};

use super::{builder::SceneBuilder, noise::Random, triangles::Triangles};
use crate::scene::Scene;

const SEED: u64 = 11;
const HAIRS: u32 = 2400;
/// Rings of a hair's tube, and sides.
const RINGS: u32 = 14;
const SIDES: u32 = 4;
/// Middle and radius of the ball \[m].
const CENTER: Vec3 = vec3(0.0, 1.3, 0.0);
const RADIUS: f32 = 1.0;
/// Thickness of a hair at its root \[m].
const THICKNESS: f32 = 0.006;

pub(super) fn make() -> Scene {
    let mut builder = SceneBuilder::default();
    let hair = builder.plain([0.5, 0.33, 0.2]);
    let stone = builder.plain([0.4, 0.4, 0.42]);
    let mesh = builder.mesh([(hair, hairs()), (stone, floor())]);
    builder.instance("hairball", mesh, Affine3A::IDENTITY);
    builder.camera(vec3(0.6, 1.7, 5.2), vec3(0.0, 1.2, 0.0), 45.0, [0.05, 16.0]);
    builder.sun(vec3(0.45, -0.8, 0.35), [10.0, 9.4, 8.2]);
    builder.finish()
}

fn hairs() -> Triangles {
    let mut random = Random::new(SEED);
    let mut hairs = Triangles::default();
    for _ in 0..HAIRS {
        let out = random.direction();
        let (x, y) = out.any_orthonormal_pair();
        let reach = RADIUS * random.between(0.7, 1.0);
        let (curl, turns, phase) = (
            random.between(0.05, 0.22),
            random.between(0.4, 1.6),
            random.between(0.0, TAU),
        );
        let ring = |i: u32| {
            let t = i as f32 / (RINGS - 1) as f32;
            let angle = TAU * turns * t + phase;
            let aside = curl * t * (angle.cos() * x + angle.sin() * y);
            let place = CENTER + (0.12 + 0.88 * t) * reach * out + aside;
            (place, THICKNESS * (1.0 - 0.7 * t))
        };
        hairs.tube(&(0..RINGS).map(ring).collect::<Vec<_>>(), SIDES);
    }
    hairs
}

fn floor() -> Triangles {
    let mut floor = Triangles::default();
    floor.cuboid(vec3(-6.0, -0.2, -6.0), vec3(6.0, 0.0, 6.0));
    floor
}
