//! Rendered layers, and those that both backends compute alike.

use tyndall::{
    camera::CameraRays,
    frame::{Camera, Medium},
    physics::medium::Optics,
    techniques::Technique,
};

use crate::{
    layer::{Layer, Layers},
    load::ShotFrame,
    picture::Picture,
};

/// Layers that a backend rendered, and their cost.
pub struct Rendered {
    /// The layers, in the order they were asked for.
    pub layers: Layers,
    /// The technique that computed each light, in the lights' order.
    pub techniques: Vec<Technique>,
    /// GPU passes and their milliseconds, in order; empty on the CPU and without timestamps.
    pub passes: Vec<(String, f64)>,
    /// Textures and buffers, by what they are for \[bytes].
    pub bytes: Vec<(&'static str, u64)>,
    /// Counts of the technique; empty on the CPU.
    pub counts: Vec<(String, u64)>,
}

/// Length of each pixel's view ray \[m].
pub(super) fn distances(camera: &Camera, size: [u32; 2], depth: &[f32]) -> Vec<f64> {
    let rays = CameraRays::new(camera, size);
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    pixels
        .zip(depth)
        .map(|((x, y), depth)| rays.ray(x, y, *depth).length)
        .collect()
}

/// Transmittance along each pixel's view ray.
pub(super) fn transmittances(medium: &Medium, distances: &[f64]) -> Vec<[f32; 3]> {
    let optics = Optics::new(medium);
    distances
        .iter()
        .map(|distance| optics.transmittance(*distance).as_vec3().to_array())
        .collect()
}

/// A layer that both backends compute from the depth buffer: distance or transmittance.
pub(super) fn depth_layer(layer: Layer, shot_frame: &ShotFrame, depth: &[f32]) -> Picture {
    let distances = distances(&shot_frame.frame.camera, shot_frame.size, depth);
    let pixels = match layer {
        Layer::Transmittance => transmittances(&shot_frame.frame.medium, &distances),
        _ => distances.iter().map(|d| [*d as f32; 3]).collect(),
    };
    Picture {
        size: shot_frame.size,
        pixels,
    }
}

/// Drops the fourth channel.
pub(super) fn rgb(pixels: &[[f32; 4]]) -> Vec<[f32; 3]> {
    pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
}
