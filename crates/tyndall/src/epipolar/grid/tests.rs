//! Random cameras and lights of every kind: coordinates against points in space, cells against light rays.

#[cfg(feature = "gpu")]
mod gpu;

use std::f64::consts::PI;

use super::*;
use crate::{
    camera::CameraRays,
    epipolar::{
        Resolution, rectify,
        tree::{LIT, Node, UNKNOWN},
    },
    frame::{Camera, Emitter, Light, Projection, ShadowProjection},
    inputs::{CpuLightInputs, ShadowMap},
    light::LightModel,
    shadow::Shadows,
};
use glam::{DVec3, Mat4, Vec3};
use tyndall_testkit::samples::in_box;

const SIZE: [u32; 2] = [64, 48];
const MAP: u32 = 64;

/// A camera, a light, and the light's shadow map: blocks at random depths.
struct Case {
    name: String,
    camera: Camera,
    light: Light,
    map: ShadowMap,
}

/// Place of the light, seen from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Placing {
    Anywhere,
    /// The epipole is in the image.
    Ahead,
    Behind,
    /// The sun's epipole is at infinity, the lamp's far beside the image.
    Across,
    /// The lamp is a few centimetres from the eye.
    Near,
}

const PLACINGS: [Placing; 5] = [
    Placing::Anywhere,
    Placing::Ahead,
    Placing::Behind,
    Placing::Across,
    Placing::Near,
];

impl Case {
    /// Number `i` takes its turn of placings, projections and lights; `x` is within [-1, 1].
    fn new(i: usize, x: &[f32; 12]) -> Self {
        let placing = PLACINGS[i % 5];
        let orthographic = i / 5 % 3 == 2;
        let kind = i / 15 % 3;
        let vector = |n: usize| Vec3::new(x[n], x[n + 1], x[n + 2]);
        let unit = |v: Vec3| v.try_normalize().unwrap_or(Vec3::Z);
        let eye = 8.0 * vector(0);
        let forward = unit(vector(3));
        let to_light = match placing {
            Placing::Anywhere => unit(vector(6)),
            Placing::Ahead => unit(forward + 0.2 * vector(6)),
            Placing::Behind => unit(-forward + 0.2 * vector(6)),
            Placing::Across => unit(forward.cross(vector(6))),
            Placing::Near => unit(vector(6)),
        };
        let distance = match placing {
            Placing::Near => 0.001 + 0.05 * (x[9] + 1.0),
            _ => 0.5 + 5.0 * (x[9] + 1.0),
        };
        let up = if forward.x.abs() < 0.9 {
            Vec3::X
        } else {
            Vec3::Y
        };
        // From a telephoto to 150 degrees.
        let yfov = 0.1 + 1.25 * (x[10] + 1.0);
        let aspect = SIZE[0] as f32 / SIZE[1] as f32;
        let target = eye + forward;
        let [eye_, target, up] = [eye, target, up].map(|v| v.to_array());
        let mut camera = Camera::perspective(eye_, target, up, yfov, aspect, 0.1, 30.0);
        if orthographic {
            let half = 0.2 + 3.0 * (x[10] + 1.0);
            camera.projection = Projection::Orthographic {
                half_extent: [half * aspect, half],
                center: [0.1, -0.3],
                near: 0.1,
                far: 30.0,
            };
        }
        let reversed_depth = i.is_multiple_of(2);
        let (emitter, shadow) = lights(
            kind,
            eye + distance * to_light,
            -to_light,
            x[11],
            reversed_depth,
        );
        let light = Light {
            emitter,
            shadow: Some(shadow),
            texture: None,
        };
        Self {
            name: format!("{i}: {placing:?}, orthographic {orthographic}, {emitter:?}"),
            camera,
            light,
            map: blocks(i as u64, kind, reversed_depth),
        }
    }

    fn many(count: usize) -> impl Iterator<Item = Self> {
        let corners = 1 << 12;
        let inputs = in_box(11, count, [const { -1.0..=1.0 }; 12]);
        inputs
            .into_iter()
            .skip(corners)
            .enumerate()
            .map(|(i, x)| Self::new(i, &x))
    }

    fn rays(&self) -> CameraRays {
        CameraRays::new(&self.camera, SIZE)
    }

    fn shadows(&self) -> Shadows<'_> {
        let inputs = CpuLightInputs {
            shadow_map: Some(&self.map),
            ..Default::default()
        };
        let shadow = self.light.shadow.as_ref();
        Shadows::new(&self.light.emitter, shadow, &inputs).expect("the light has a map")
    }

    fn grid(&self, slices: u32) -> Option<EpipolarGrid> {
        let (camera, shadows) = (self.rays(), self.shadows());
        let models = LightModel::samples(&self.light, &self.camera, None);
        let scene = GridScene {
            camera: &camera,
            size: SIZE,
            light: models[0].source(),
            cone: models[0].cone(),
            faces: shadows.faces(),
            side: MAP as usize,
        };
        let resolution = Resolution {
            slices,
            ..Resolution::default()
        };
        EpipolarGrid::new(&scene, &resolution)
    }
}

/// The sun, a lamp with a cube, and a spot of any width, and the direction in which each shines.
fn lights(
    kind: usize,
    position: Vec3,
    heading: Vec3,
    width: f32,
    reversed_depth: bool,
) -> (Emitter, ShadowProjection) {
    use glam::camera::rh::{proj::directx, view::look_to_mat4};
    let across = heading.any_orthonormal_vector();
    let single = |clip_from_view: Mat4, from: Vec3, heading: Vec3| ShadowProjection::Single {
        clip_from_world: (clip_from_view
            * look_to_mat4(from, heading, heading.any_orthonormal_vector()))
        .to_cols_array_2d(),
        reversed_depth,
    };
    let depths = |near: f32, far: f32| {
        if reversed_depth {
            [far, near]
        } else {
            [near, far]
        }
    };
    let position_ = position.to_array();
    match kind {
        0 => {
            let half = 6.0 + 4.0 * width;
            let [near, far] = depths(0.5, 40.0);
            let matrix = directx::orthographic(-half, half, -half, half, near, far);
            let emitter = Emitter::Directional {
                direction: heading.to_array(),
                illuminance: [1.0; 3],
            };
            (emitter, single(matrix, -20.0 * heading, heading))
        }
        1 => (
            Emitter::Point {
                position: position_,
                intensity: [1.0; 3],
                radius: 0.0,
            },
            ShadowProjection::Cube {
                near: 0.1,
                far: 25.0,
                reversed_depth,
            },
        ),
        _ => {
            // It need not shine at the eye.
            let outer = 0.7 + 0.6 * width;
            let heading = (heading + width * across).normalize();
            let [near, far] = depths(0.1, 25.0);
            let matrix = directx::perspective(2.0 * outer + 0.05, 1.0, near, far);
            let emitter = Emitter::Spot {
                position: position_,
                direction: heading.to_array(),
                intensity: [1.0; 3],
                inner: 0.0,
                outer,
                radius: 0.0,
            };
            (emitter, single(matrix, position, heading))
        }
    }
}

/// Blocks of 4 x 4 texels at random depths, a third of them empty.
fn blocks(seed: u64, kind: usize, reversed_depth: bool) -> ShadowMap {
    let (faces, side) = (if kind == 1 { 6 } else { 1 }, MAP / 4);
    let heights = in_box(seed, (faces * side * side) as usize, [0.0..=1.0, 0.0..=1.0]);
    let texel = |i: u32| {
        let (face, y, x) = (i / (MAP * MAP), i / MAP % MAP / 4, i % MAP / 4);
        let [is_empty, height] = heights[4 + ((face * side + y) * side + x) as usize];
        let near_is_one = match kind {
            _ if is_empty < 0.3 => 0.0,
            0 => 0.1 + 0.8 * height,
            // 0.2 m to 10 m of a near plane at 0.1 m.
            _ => 0.1 / (0.2 + 9.8 * height),
        };
        if reversed_depth {
            near_is_one
        } else {
            1.0 - near_is_one
        }
    };
    ShadowMap {
        size: [MAP; 2],
        depth: (0..faces * MAP * MAP).map(texel).collect(),
    }
}

/// An image's point, a share of the distance to the far plane, and two more numbers.
fn points(seed: usize, count: usize) -> Vec<[f64; 5]> {
    let [width, height] = SIZE.map(|n| n as f32);
    let ranges = [0.0..=width, 0.0..=height, 0.0..=1.0, 0.0..=1.0, 0.0..=1.0];
    let inputs = in_box(seed as u64, count, ranges);
    inputs[32..].iter().map(|x| x.map(f64::from)).collect()
}

/// Coordinates are those of points in space, and `b < S` is what the shadow map itself says.
#[test]
fn a_point_is_lit_where_b_is_less_than_s() {
    let (mut met, mut lit, mut without) = ([0; 5], [0; 2], 0);
    for (i, case) in Case::many(3000).enumerate() {
        let Some(grid) = case.grid(0) else {
            without += 1;
            continue;
        };
        let (camera, shadows) = (case.rays(), case.shadows());
        let [start, step] = grid.slices.start_and_step();
        for [x, y, share, ..] in points(i, 8) {
            let ray = camera.ray_to_far(x, y);
            let Some(place) = grid.ray(&ray) else {
                continue;
            };
            met[i % 5] += 1;
            let s = share * ray.length;
            let point = ray.at(s);
            let (alpha, gamma) = (grid.alpha(&ray), grid.gamma_at(&place, s));
            // The light ray passes through the point.
            let (origin, travel) = grid.light_ray(alpha, gamma);
            let along = (point - origin).dot(travel);
            let apart = (origin + along * travel - point).length();
            // Measured: 3e-13 of up to 90 m.
            assert!(apart < 1e-11, "{}: {apart:e}", case.name);
            // The slice holds the ray.
            let from_slice = alpha - start - place.slice as f64 * step;
            let turns = grid.slices.turns();
            let from_slice = if turns {
                (from_slice + PI).rem_euclid(2.0 * PI) - PI
            } else {
                from_slice
            };
            let within = -1e-9..=step + 1e-9;
            assert!(
                within.contains(&from_slice),
                "{}: {from_slice} of {step}",
                case.name
            );
            // gamma grows along the ray, and borders are crossed where samples change.
            let sample = grid.sample_at(&place, s).floor();
            if (0.0..grid.samples as f64).contains(&sample) {
                let borders = [0, 1].map(|n| grid.crossing(&place, sample as usize + n));
                assert!(
                    borders[0] <= s + 1e-8 * ray.length && s - 1e-8 * ray.length <= borders[1],
                    "{}: {borders:?} {s}",
                    case.name
                );
            }
            let end = shadows.light_end(origin, travel);
            if (end - along).abs() > 1e-6 * along.abs().max(1.0) {
                let [_, shadow] = grid.shadow_range([gamma; 2], [end; 2]);
                let found = place.b < shadow;
                let exact = shadows.tint(point) != DVec3::ZERO;
                assert_eq!(
                    found, exact,
                    "{}: {place:?} {shadow} {end} {along}",
                    case.name
                );
                lit[usize::from(exact)] += 1;
            }
        }
    }
    // Measured: 4300 to 4700 points of each placing, a third of them dark, and 142 cameras without slices.
    assert!(met.iter().all(|n| *n > 4000), "{met:?}");
    assert!(lit.iter().all(|n| *n > 6000), "{lit:?}");
    assert!(without < 200, "{without}");
}

/// Number of cells that say nothing, and of those that hold a narrow range.
#[derive(Debug, Default)]
struct Tightness {
    cells: usize,
    unknown: usize,
    settled: usize,
}

impl Tightness {
    fn add(&mut self, [min, max]: Node) {
        self.cells += 1;
        self.unknown += usize::from([min, max] == UNKNOWN);
        self.settled += usize::from([min, max] == LIT || max - min < 3000);
    }

    /// At most such a share says nothing, and at least such a share is narrow.
    fn check(&self, unknown: f64, settled: f64) {
        let share = |n: usize| n as f64 / self.cells as f64;
        assert!(
            share(self.unknown) < unknown && share(self.settled) > settled,
            "{self:?}"
        );
    }
}

/// S of light rays anywhere in a cell is within the range that the cell's leaf holds.
#[test]
fn cells_hold_every_light_ray_in_them() {
    let mut tightness = Tightness::default();
    for (i, case) in Case::many(600).enumerate() {
        // From few and wide slices to narrow ones.
        let Some(grid) = case.grid([3, 40, 300][i % 3]) else {
            continue;
        };
        let shadows = case.shadows();
        let trees = rectify::trees(&grid, &shadows);
        for [_, _, slice, sample, across] in points(i, 1000) {
            let ray = LightRay::in_cell(&grid, &shadows, [slice, sample, across]);
            let leaf = trees[ray.slice].leaf(ray.sample);
            assert!(ray.is_held_by(leaf), "{}: {leaf:?} {ray:?}", case.name);
            tightness.add(leaf);
        }
    }
    // Measured: 11 % and 54 %.
    tightness.check(0.15, 0.5);
}

/// A light ray of a cell.
#[derive(Debug)]
struct LightRay {
    slice: usize,
    sample: usize,
    /// S, clamped to what nodes can hold.
    shadow: f64,
    is_endless: bool,
}

impl LightRay {
    /// Slice and sample as shares of all, and the place across the slice.
    fn in_cell(grid: &EpipolarGrid, shadows: &Shadows<'_>, place: [f64; 3]) -> Self {
        let [start, step] = grid.slices.start_and_step();
        let count = grid.slices.count as f64;
        let slice = (place[0] * count).min(count - 1.0).floor();
        let sample = (place[1] * grid.samples as f64).min(grid.samples as f64 - 1e-9);
        let alpha = start + (slice + place[2]) * step;
        let gamma = grid.gamma_start + sample * grid.gamma_step;
        let (origin, travel) = grid.light_ray(alpha, gamma);
        let end = shadows.light_end(origin, travel);
        let [_, shadow] = grid.shadow_range([gamma; 2], [end; 2]);
        Self {
            slice: slice as usize,
            sample: sample as usize,
            shadow: shadow.clamp(0.0, 65535.0),
            is_endless: end == f64::INFINITY,
        }
    }

    fn is_held_by(&self, leaf: Node) -> bool {
        let [min, max] = leaf.map(f64::from);
        (min <= self.shadow && self.shadow <= max) || self.is_endless && leaf == LIT
    }
}
