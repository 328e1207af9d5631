//! Scenes with things that can be moved: `sponge`, of high genus, and `crowd`, of many.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3, vec3};

use super::{builder::SceneBuilder, triangles::Triangles};
use crate::scene::Scene;

/// Half the floor's side \[m].
const FLOOR: f32 = 6.0;
/// Things that stand about, in groups of one name.
const TOYS: usize = 24;
const GROUPS: [&str; 3] = ["red toy", "green toy", "blue toy"];
const COLOURS: [[f32; 3]; 3] = [[0.7, 0.2, 0.15], [0.2, 0.6, 0.25], [0.2, 0.3, 0.7]];

/// Menger's sponge after three steps: 8000 cubes, and as many tunnels as they leave.
pub(super) fn sponge() -> Scene {
    let mut builder = stage();
    let stone = builder.plain([0.65, 0.62, 0.55]);
    let sponge = builder.mesh([(stone, menger(3))]);
    builder.instance("sponge", sponge, place(1.2, [0.0, 0.9, 0.0]));
    builder.finish()
}

/// A large sponge, and rings round it.
pub(super) fn crowd() -> Scene {
    let mut builder = stage();
    let stone = builder.plain([0.65, 0.62, 0.55]);
    let sponge = builder.mesh([(stone, menger(2))]);
    builder.instance("sponge", sponge, place(1.5, [0.0, 0.9, 0.0]));
    let rings = COLOURS.map(|colour| {
        let material = builder.plain(colour);
        builder.mesh([(material, ring())])
    });
    for toy in 0..TOYS {
        let turn = TAU * toy as f32 / TOYS as f32;
        let (sin, cos) = turn.sin_cos();
        let height = 0.25 + 0.6 * (toy % 4) as f32;
        let at = Affine3A::from_rotation_translation(
            Quat::from_rotation_y(2.0 * turn),
            vec3(1.5 * sin, height, 1.1 * cos),
        );
        builder.instance(GROUPS[toy % GROUPS.len()], rings[toy % GROUPS.len()], at);
    }
    builder.finish()
}

/// A floor, a camera and a sun behind the things on the floor.
fn stage() -> SceneBuilder {
    let mut builder = SceneBuilder::default();
    let ground = builder.plain([0.4, 0.4, 0.4]);
    let mut floor = Triangles::default();
    floor.plain_quad(
        [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| FLOOR * vec3(x, 0.0, z)),
    );
    let floor = builder.mesh([(ground, floor)]);
    builder.instance("floor", floor, Affine3A::IDENTITY);
    builder.camera(vec3(0.3, 1.0, 4.2), vec3(0.0, 0.8, 0.0), 45.0, [0.05, 12.0]);
    builder.sun(vec3(0.18, -0.6, 0.9), [10.0, 9.2, 8.0]);
    builder
}

fn place(size: f32, at: [f32; 3]) -> Affine3A {
    Affine3A::from_scale_rotation_translation(Vec3::splat(size), Quat::IDENTITY, at.into())
}

/// The sponge of this many steps, in a unit cube about the origin.
fn menger(steps: u32) -> Triangles {
    let side = 3_i32.pow(steps);
    let is_solid = |cell: [i32; 3]| {
        let is_inside = cell.iter().all(|n| (0..side).contains(n));
        // In none of the steps two of the three digits are in the middle.
        let is_kept = |step: u32| {
            let digits = cell.map(|n| n / 3_i32.pow(step) % 3);
            digits.iter().filter(|digit| **digit == 1).count() < 2
        };
        is_inside && (0..steps).all(is_kept)
    };
    let corner = |cell: [i32; 3]| Vec3::from(cell.map(|n| n as f32 / side as f32 - 0.5));
    let mut faces = Triangles::default();
    for i in 0..side.pow(3) {
        let cell = [i % side, i / side % side, i / side / side];
        if !is_solid(cell) {
            continue;
        }
        for axis in 0..3 {
            for (step, up) in [(-1, 0), (1, 1)] {
                let mut beside = cell;
                beside[axis] += step;
                if is_solid(beside) {
                    continue;
                }
                let at = |u: i32, v: i32| {
                    let mut at = cell;
                    at[axis] += up;
                    at[(axis + 1) % 3] += u;
                    at[(axis + 2) % 3] += v;
                    corner(at)
                };
                let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
                faces.plain_quad(if up == 1 { [a, b, c, d] } else { [a, d, c, b] });
            }
        }
    }
    faces
}

/// A ring that stands upright.
fn ring() -> Triangles {
    const ROUND: u32 = 48;
    const ABOUT: u32 = 20;
    let mut ring = Triangles::default();
    ring.surface([ABOUT + 1, ROUND + 1], |column, row| {
        // Back at the start the same numbers: no seam.
        let [about, round] =
            [(column % ABOUT, ABOUT), (row % ROUND, ROUND)].map(|(i, n)| TAU * i as f32 / n as f32);
        let radius = 0.16 + 0.05 * about.cos();
        vec3(
            radius * round.cos(),
            radius * round.sin(),
            0.05 * about.sin(),
        )
    });
    ring
}
