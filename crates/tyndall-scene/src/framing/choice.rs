//! The choice of camera and lights whose shafts show most.

use glam::Vec3;
use rayon::prelude::*;
use tyndall::frame::{Camera, Emitter, Medium};

use super::{
    candidates,
    defaults::{SUN, haze, suns},
    nodes::{cameras, lights},
    probe::Probe,
};
use crate::{geometry::Bounds, scene::Scene, trace::Tracer};

/// Edge of the box that stands for an empty scene's bounds \[m].
const EMPTY_SIZE: f32 = 50.0;

/// A view of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Framing {
    /// The camera, in world space.
    pub camera: Camera,
    /// The lights, in world space.
    pub lights: Vec<Emitter>,
    /// A grey haze, thin enough to see the scene through it and thick enough to see light in it.
    pub medium: Medium,
}

/// Frames a scene for images of this aspect ratio (width / height).
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
    let best = best_pair(tracer, &probes, &light_sets);
    let probe = &probes[best.camera];
    let lights = if has_lights || best.contrast > 0.0 || tracer.geometry().is_empty() {
        light_sets[best.lights].clone()
    } else {
        vec![probe.lamp(SUN)]
    };
    Framing {
        camera: cameras[best.camera],
        lights,
        medium: haze(probe.mean_length()),
    }
}

/// A camera with a set of lights, by their indices.
struct Pair {
    camera: usize,
    lights: usize,
    contrast: f32,
}

/// The pair of camera and lights whose shafts show most.
fn best_pair(tracer: &Tracer, probes: &[Probe], light_sets: &[Vec<Emitter>]) -> Pair {
    let pairs: Vec<(usize, usize)> = (0..probes.len())
        .flat_map(|camera| (0..light_sets.len()).map(move |lights| (camera, lights)))
        .collect();
    let contrasts: Vec<f32> = pairs
        .par_iter()
        .map(|&(camera, lights)| probes[camera].contrast(tracer, &light_sets[lights]))
        .collect();
    let best = index_of_largest(&contrasts);
    let (camera, lights) = pairs[best];
    Pair {
        camera,
        lights,
        contrast: contrasts[best],
    }
}

/// The first of the largest values.
fn index_of_largest(values: &[f32]) -> usize {
    (1..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}
