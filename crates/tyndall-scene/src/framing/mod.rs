//! What to look at, by what light and through what haze, where nobody said.
//!
//! A scene's own first camera and its own lights are taken. What it lacks is chosen so that shafts show: cameras are
//! set up inside, at clear spots with a long free view, where the scene is an interior, and all round, looking down
//! at it, where it is not; each is tried with the scene's lights, or with suns all over the sky. The pair whose
//! in-scattered light differs most from view ray to view ray wins. The same scene gives the same framing.

mod candidates;
mod nodes;
mod probe;

use glam::Vec3;
use rayon::prelude::*;
use tyndall::frame::{Camera, Emitter, Medium, MediumComponent, Phase};

use crate::{geometry::Bounds, scene::Scene, trace::Tracer};
use probe::Probe;

pub use nodes::{cameras, lights};

/// Illuminance of a default sun [W/m^2].
const SUN: [f32; 3] = [10.0, 9.5, 9.0];

/// Elevations of the suns that are tried, and how many stand round the sky at each [degrees].
const SUN_ELEVATIONS: [f32; 4] = [20.0, 33.0, 46.0, 60.0];
const SUN_AZIMUTHS: u32 = 14;

/// Optical depth of the default medium over the mean length of the view rays.
const OPTICAL_DEPTH: f32 = 0.45;

/// Share of scattering in the default medium's extinction.
const ALBEDO: f32 = 0.9;

/// Mean cosine of the default medium.
const MEAN_COSINE: f32 = 0.4;

/// Size of what is seen where there is nothing [m].
const EMPTY_SIZE: f32 = 50.0;

/// A view of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Framing {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// What shines, in world space.
    pub lights: Vec<Emitter>,
    /// A grey haze, thin enough to see the scene through it and thick enough to see light in it.
    pub medium: Medium,
}

/// Frames a scene for pictures of this aspect ratio (width / height).
pub fn frame_scene(scene: &Scene, tracer: &Tracer, aspect: f32) -> Framing {
    let bounds = tracer.geometry().bounds().unwrap_or(Bounds {
        min: Vec3::splat(-0.5 * EMPTY_SIZE),
        max: Vec3::splat(0.5 * EMPTY_SIZE),
    });
    let cameras = match cameras(scene, aspect).into_iter().next() {
        Some((_, camera)) => vec![camera],
        None => candidates::cameras(tracer, &bounds, aspect),
    };
    let own_lights: Vec<Emitter> = lights(scene).into_iter().map(|(_, light)| light).collect();
    let has_lights = !own_lights.is_empty();
    let light_sets = if has_lights {
        vec![own_lights]
    } else {
        suns().map(|sun| vec![sun]).collect()
    };

    let probes: Vec<Probe> = cameras
        .iter()
        .map(|camera| Probe::new(tracer, camera, &bounds))
        .collect();
    let pairs: Vec<(usize, usize)> = (0..probes.len())
        .flat_map(|camera| (0..light_sets.len()).map(move |lights| (camera, lights)))
        .collect();
    let contrasts: Vec<f32> = pairs
        .par_iter()
        .map(|&(camera, lights)| probes[camera].contrast(tracer, &light_sets[lights]))
        .collect();
    let best = index_of_largest(&contrasts);
    let (camera, lights) = pairs[best];
    let view_length = probes[camera].mean_length();
    let lights = if has_lights || contrasts[best] > 0.0 || tracer.geometry().is_empty() {
        light_sets[lights].clone()
    } else {
        vec![probes[camera].lamp(SUN)]
    };
    Framing {
        camera: cameras[camera],
        lights,
        medium: haze(view_length),
    }
}

/// Suns all over the sky.
fn suns() -> impl Iterator<Item = Emitter> {
    SUN_ELEVATIONS.into_iter().flat_map(|elevation| {
        (0..SUN_AZIMUTHS).map(move |i| {
            // Half a step off the axes, along which walls tend to stand.
            let azimuth = std::f32::consts::TAU * (i as f32 + 0.5) / SUN_AZIMUTHS as f32;
            let (sin, cos) = elevation.to_radians().sin_cos();
            Emitter::Directional {
                direction: [cos * azimuth.cos(), -sin, cos * azimuth.sin()],
                illuminance: SUN,
            }
        })
    })
}

/// A haze for view rays of this length [m].
fn haze(view_length: f32) -> Medium {
    let sigma_t = OPTICAL_DEPTH / view_length;
    Medium {
        components: vec![MediumComponent {
            sigma_s: [ALBEDO * sigma_t; 3],
            sigma_a: [(1.0 - ALBEDO) * sigma_t; 3],
            phase: Phase::HenyeyGreenstein { g: MEAN_COSINE },
        }],
    }
}

/// The first of the largest values.
fn index_of_largest(values: &[f32]) -> usize {
    (1..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}
