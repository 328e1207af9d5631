//! Streets between towers: long shafts, and roofs for a light to hang over.

use glam::{Affine3A, Vec3, vec3};

use super::{builder::SceneBuilder, noise::Random, triangles::Triangles};
use crate::scene::Scene;

const SEED: u64 = 23;
/// Blocks a side, their distance, and the width of the streets between them \[m].
const BLOCKS: i32 = 12;
const PITCH: f32 = 24.0;
const STREET: f32 = 8.0;
/// Storeys of a tower, and their height \[m].
const STOREYS: [f32; 2] = [3.0, 16.0];
const STOREY: f32 = 3.2;
/// Distance that floors stand out of a tower's walls, and their thickness \[m].
const LEDGE: [f32; 2] = [0.25, 0.3];

pub(super) fn make() -> Scene {
    let mut builder = SceneBuilder::default();
    let stone = builder.plain([0.55, 0.52, 0.47]);
    let asphalt = builder.plain([0.16, 0.16, 0.17]);
    let roof = builder.plain([0.3, 0.22, 0.19]);
    let (towers, tanks) = towers();
    let city = builder.mesh([(stone, towers), (asphalt, ground()), (roof, tanks)]);
    builder.instance("city", city, Affine3A::IDENTITY);
    builder.camera(
        vec3(24.0, 62.0, 132.0),
        vec3(-4.0, 14.0, 30.0),
        55.0,
        [0.5, 400.0],
    );
    builder.sun(vec3(0.62, -0.38, 0.69), [10.0, 9.0, 7.6]);
    builder.finish()
}

fn ground() -> Triangles {
    let mut ground = Triangles::default();
    let half = 0.5 * PITCH * BLOCKS as f32 + STREET;
    ground.cuboid(vec3(-half, -0.5, -half), vec3(half, 0.0, half));
    ground
}

/// A tower a block, and the tanks on their roofs.
fn towers() -> (Triangles, Triangles) {
    let mut random = Random::new(SEED);
    let (mut towers, mut tanks) = (Triangles::default(), Triangles::default());
    for i in 0..BLOCKS * BLOCKS {
        let at = |n: i32| PITCH * (n as f32 - 0.5 * (BLOCKS - 1) as f32);
        let center = vec3(at(i % BLOCKS), 0.0, at(i / BLOCKS));
        let mut side = || 0.5 * (PITCH - STREET) * random.between(0.7, 1.0);
        let half = vec3(side(), 0.0, side());
        let storeys = random.between(STOREYS[0], STOREYS[1]).floor();
        tower(&mut towers, center, half, storeys as u32);
        let top = center + storeys * STOREY * Vec3::Y;
        let aside = vec3(
            half.x * random.between(-0.6, 0.6),
            0.0,
            half.z * random.between(-0.6, 0.6),
        );
        let size = vec3(1.4, 0.0, 1.4);
        tanks.cuboid(top + aside - size, top + aside + size + 2.6 * Vec3::Y);
    }
    (towers, tanks)
}

/// Walls with a ledge at each floor.
fn tower(towers: &mut Triangles, center: Vec3, half: Vec3, storeys: u32) {
    let height = storeys as f32 * STOREY;
    towers.cuboid(center - half, center + half + height * Vec3::Y);
    let out = half + vec3(LEDGE[0], 0.0, LEDGE[0]);
    for storey in 1..=storeys {
        let floor = center + storey as f32 * STOREY * Vec3::Y;
        towers.cuboid(floor - out - LEDGE[1] * Vec3::Y, floor + out);
    }
}
