//! Suns and the haze for scenes that have none.

use tyndall::frame::{Emitter, Medium, MediumComponent, Phase};

/// Illuminance of a default sun [W/m^2].
pub(super) const SUN: [f32; 3] = [10.0, 9.5, 9.0];

/// Elevations of the suns that are tried \[degrees], and their number round the sky at each.
const SUN_ELEVATIONS: [f32; 4] = [20.0, 33.0, 46.0, 60.0];
const SUN_AZIMUTHS: u32 = 14;

/// Optical depth of the default medium over the mean length of the view rays.
const OPTICAL_DEPTH: f32 = 0.45;

/// Share of scattering in the default medium's extinction.
const ALBEDO: f32 = 0.9;

/// Mean cosine of the default medium.
pub(super) const MEAN_COSINE: f32 = 0.4;

/// Suns all over the sky.
pub(super) fn suns() -> impl Iterator<Item = Emitter> {
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

/// A haze for view rays of this length \[m].
pub(super) fn haze(view_length: f32) -> Medium {
    let sigma_t = OPTICAL_DEPTH / view_length;
    Medium {
        components: vec![MediumComponent {
            sigma_s: [ALBEDO * sigma_t; 3],
            sigma_a: [(1.0 - ALBEDO) * sigma_t; 3],
            phase: Phase::HenyeyGreenstein { g: MEAN_COSINE },
        }],
    }
}
