//! Trees along a path, towards a low sun.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3, vec2, vec3};

use super::{
    builder::SceneBuilder,
    noise::{Random, gradient_noise},
    triangles::Triangles,
};
use crate::scene::Scene;

const SEED: u64 = 5;
/// Different trees; every one stands in many places.
const KINDS: u64 = 6;
/// Branches of a tree, and leaves (of two triangles) at the end of each.
const BRANCHES: u32 = 26;
const LEAVES: u32 = 70;
/// Half a leaf's length and width \[m].
const LEAF: [f32; 2] = [0.19, 0.10];
/// Distance between trees, before they are moved at random \[m].
const SPACING: f32 = 6.0;
/// Trees to both sides of the middle and along the path.
const COLUMNS: i32 = 5;
const ROWS: i32 = 6;
/// Half the path's width, free of trees \[m].
const CLEARANCE: f32 = 2.6;

pub(super) fn make() -> Scene {
    let mut builder = SceneBuilder::default();
    let bark = builder.plain([0.16, 0.11, 0.07]);
    let leaf = builder.plain([0.16, 0.30, 0.06]);
    let soil = builder.plain([0.17, 0.15, 0.08]);
    let ground_mesh = builder.mesh([(soil, ground())]);
    builder.instance("ground", ground_mesh, Affine3A::IDENTITY);
    let kinds: Vec<usize> = (0..KINDS)
        .map(|kind| {
            let (wood, leaves) = tree(&mut Random::new(SEED + kind));
            builder.mesh([(bark, wood), (leaf, leaves)])
        })
        .collect();
    for (i, place) in places().enumerate() {
        let kind = kinds[i % kinds.len()];
        builder.instance(&format!("tree {i}"), kind, place);
    }
    builder.camera(on_path(26.0, 1.7), on_path(2.0, 4.6), 58.0, [0.05, 120.0]);
    builder.sun(vec3(0.30, -0.46, 0.84), [10.0, 8.8, 6.6]);
    builder.finish()
}

fn path_middle(z: f32) -> f32 {
    1.6 * (z / 11.0).sin()
}

fn ground_height(x: f32, z: f32) -> f32 {
    0.9 * gradient_noise(vec2(x, z) / 13.0, SEED as u32)
}

fn on_path(z: f32, height: f32) -> Vec3 {
    let x = path_middle(z);
    vec3(x, ground_height(x, z) + height, z)
}

fn ground() -> Triangles {
    const POINTS: u32 = 97;
    const STEP: f32 = 1.25;
    let mut ground = Triangles::default();
    ground.surface([POINTS; 2], |column, row| {
        let [x, z] = [column, row].map(|i| STEP * (i as f32 - 0.5 * (POINTS - 1) as f32));
        vec3(x, ground_height(x, z), z)
    });
    ground
}

/// Places of the trees: a grid, moved at random, without the path.
fn places() -> impl Iterator<Item = Affine3A> {
    let mut random = Random::new(SEED);
    let grid = (-ROWS..=ROWS).flat_map(|row| (-COLUMNS..=COLUMNS).map(move |column| (row, column)));
    grid.filter_map(move |(row, column)| {
        let [x, z] = [column, row].map(|i| SPACING * (i as f32 + random.between(-0.38, 0.38)));
        let (turn, size) = (random.between(0.0, TAU), random.between(0.8, 1.2));
        if (x - path_middle(z)).abs() < CLEARANCE {
            return None;
        }
        Some(Affine3A::from_scale_rotation_translation(
            Vec3::splat(size),
            Quat::from_rotation_y(turn),
            vec3(x, ground_height(x, z) - 0.2, z),
        ))
    })
}

/// Wood and leaves of a tree at the origin.
fn tree(random: &mut Random) -> (Triangles, Triangles) {
    let (mut wood, mut leaves) = (Triangles::default(), Triangles::default());
    let height = random.between(9.0, 12.5);
    let lean = vec3(random.between(-0.6, 0.6), height, random.between(-0.6, 0.6));
    let trunk = |t: f32| lean * t + 0.12 * (7.0 * t).sin() * vec3(1.0, 0.0, 0.6);
    let thickness = |t: f32| 0.24 * (1.0 - t).powf(0.8) + 0.015;
    let rings: Vec<(Vec3, f32)> = (0..=12)
        .map(|i| i as f32 / 12.0)
        .map(|t| (trunk(t), thickness(t) + 0.16 * (-25.0 * t).exp()))
        .collect();
    wood.tube(&rings, 12);
    for i in 0..BRANCHES {
        let t = 0.36 + 0.62 * (i as f32 + random.unit()) / BRANCHES as f32;
        // The golden angle: branches keep out of each other's light.
        let around = 2.399_963 * i as f32 + random.between(-0.4, 0.4);
        let reach = random.between(1.2, 2.9) * (1.15 - t).powf(0.4);
        let outward = vec3(around.cos(), random.between(0.25, 0.8), around.sin());
        let (start, end) = (trunk(t), trunk(t) + reach * outward);
        let middle = 0.5 * (start + end) - 0.1 * reach * Vec3::Y;
        let width = 0.4 * thickness(t);
        wood.tube(&[(start, width), (middle, 0.7 * width), (end, 0.01)], 6);
        foliage(&mut leaves, end, random.between(0.75, 1.25), random);
    }
    (wood, leaves)
}

/// Leaves round the end of a branch, as diamonds that face anywhere.
fn foliage(leaves: &mut Triangles, center: Vec3, radius: f32, random: &mut Random) {
    for _ in 0..LEAVES {
        let middle = center + radius * random.in_ball();
        let axis = random.direction();
        let (side, _) = axis.any_orthonormal_pair();
        let (along, across) = (LEAF[0] * axis, LEAF[1] * side);
        leaves.plain_quad([
            middle - along,
            middle + across,
            middle + along,
            middle - across,
        ]);
    }
}
