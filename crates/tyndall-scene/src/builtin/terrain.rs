//! Mountains.

use glam::{Affine3A, Vec2, vec2, vec3};

use super::{builder::SceneBuilder, noise::gradient_noise, triangles::Triangles};
use crate::scene::Scene;

/// Points a side.
const POINTS: u32 = 513;
/// Length of a side \[m].
const SIDE: f32 = 10_000.0;
/// Height of the tallest ridges \[m].
const RELIEF: f32 = 1_500.0;
const SEED: u32 = 17;

pub(super) fn make() -> Scene {
    let heights: Vec<f32> = (0..POINTS * POINTS)
        .map(|i| height(place(i % POINTS, i / POINTS)))
        .collect();
    let mut builder = SceneBuilder::default();
    let rock = builder.plain([0.32, 0.29, 0.25]);
    let mut ground = Triangles::default();
    ground.surface([POINTS; 2], |column, row| {
        let place = place(column, row);
        vec3(place.x, heights[(row * POINTS + column) as usize], place.y)
    });
    let mesh = builder.mesh([(rock, ground)]);
    builder.instance("mountains", mesh, Affine3A::IDENTITY);
    builder.camera(
        vec3(600.0, 1_450.0, 4_600.0),
        vec3(-200.0, 700.0, 0.0),
        50.0,
        [10.0, 15_000.0],
    );
    builder.sun(vec3(0.42, -0.26, 0.87), [10.0, 8.6, 6.8]);
    builder.finish()
}

/// Position of a grid point, seen from above \[m].
fn place(column: u32, row: u32) -> Vec2 {
    let step = SIDE / (POINTS - 1) as f32;
    vec2(column as f32, row as f32) * step - Vec2::splat(0.5 * SIDE)
}

/// A ridged multifractal (Musgrave 1994, in "Texturing and Modeling"): octaves of folded noise, each weighted by the
/// one before, so that ridges are rough and valleys smooth.
fn height(place: Vec2) -> f32 {
    const OCTAVES: u32 = 8;
    const LACUNARITY: f32 = 2.03;
    const GAIN: f32 = 2.0;
    const WAVELENGTH: f32 = 4_200.0;
    let mut point = place / WAVELENGTH;
    let (mut sum, mut weight, mut amplitude) = (0.0, 1.0f32, 0.5);
    for octave in 0..OCTAVES {
        let ridge = 1.0 - gradient_noise(point, SEED + octave).abs();
        let signal = ridge * ridge * weight;
        sum += amplitude * signal;
        weight = (GAIN * signal).min(1.0);
        amplitude *= 0.5;
        point *= LACUNARITY;
    }
    RELIEF * sum
}
