//! Limits of a frame's numbers: squares, and their products with coefficients, have to stay numbers in f32.

use super::require::{Checked, require};
use crate::{
    frame::{Camera, Emitter, Frame},
    light::light_radius,
    physics::reals,
};

/// The greatest length and distance from the origin \[m]: farther than the sun is from the earth.
const LONGEST: f32 = 1e12;
/// The least length that has to be more than 0 \[m].
const SHORTEST: f32 = 1e-9;
/// The steepest tangent of a field of view.
const STEEPEST: f32 = 1e6;
/// The greatest coefficient \[1/m].
const DENSEST: f32 = 1e9;
/// The greatest strength of a light, in its own unit.
const STRONGEST: f32 = 1e18;
/// The most light that may be scattered along a ray, but for its phase function, of which the narrowest have a peak of 1e6.
const BRIGHTEST: f64 = 1e30;

pub(super) fn place(field: &str, value: [f32; 3]) -> Checked {
    require(
        value.iter().all(|x| x.abs() <= LONGEST),
        field,
        "three numbers from -1e12 to 1e12 [m]",
        value,
    )
}

pub(super) fn is_length(value: f32) -> bool {
    (SHORTEST..=LONGEST).contains(&value)
}

pub(super) fn is_distance(value: f32) -> bool {
    value.abs() <= LONGEST
}

pub(super) fn is_tangent(value: f32) -> bool {
    (1.0 / STEEPEST..=STEEPEST).contains(&value)
}

/// An edge of a rectangle or of a texture.
pub(super) fn edge(field: &str, value: [f32; 3]) -> Checked {
    let length = reals(value).length() as f32;
    require(
        is_length(length),
        field,
        "a vector from 1e-9 to 1e12 m long",
        value,
    )
}

pub(super) fn coefficient(field: &str, value: [f32; 3]) -> Checked {
    require(
        value.iter().all(|x| (0.0..=DENSEST).contains(x)),
        field,
        "three numbers from 0 to 1e9 [1/m]",
        value,
    )
}

pub(super) fn strength(field: &str, value: [f32; 3]) -> Checked {
    require(
        value.iter().all(|x| (0.0..=STRONGEST).contains(x)),
        field,
        "three numbers from 0 to 1e18",
        value,
    )
}

/// Refuses lights so bright, lamps so small and media so dense together that what is scattered is no number in f32.
pub(super) fn brightness(frame: &Frame) -> Checked {
    let components = frame.medium.components.iter();
    let density: f64 = components
        .flat_map(|c| c.sigma_s)
        .map(f64::from)
        .fold(1.0, f64::max);
    for (i, light) in frame.lights.iter().enumerate() {
        let (key, strength) = of(&light.emitter);
        let brightest = greatest(strength) * nearest(&light.emitter, &frame.camera);
        require(
            brightest * density <= BRIGHTEST,
            format!("lights[{i}].emitter.{key}"),
            "so little that the medium scatters less than 1e30 right at the lamp: a weaker or wider one",
            strength,
        )?;
    }
    Ok(())
}

fn greatest(value: [f32; 3]) -> f64 {
    value.into_iter().fold(0.0, f32::max).into()
}

fn of(emitter: &Emitter) -> (&'static str, [f32; 3]) {
    match *emitter {
        Emitter::Directional { illuminance, .. } => ("illuminance", illuminance),
        Emitter::Point { intensity, .. } | Emitter::Spot { intensity, .. } => {
            ("intensity", intensity)
        }
        Emitter::Rect { radiance, .. } => ("radiance", radiance),
    }
}

/// The light that arrives right at the lamp, relative to its strength: no less than 1.
fn nearest(emitter: &Emitter, camera: &Camera) -> f64 {
    match *emitter {
        // Radiance arrives as it leaves, over half of all directions at most.
        Emitter::Directional { .. } | Emitter::Rect { .. } => 4.0,
        Emitter::Point { .. } | Emitter::Spot { .. } => {
            light_radius(emitter, camera).powi(-2).max(1.0)
        }
    }
}
