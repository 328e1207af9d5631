//! The sky that pixels without a surface see.

use glam::DVec3;
use tyndall::frame::{Emitter, Light};

use super::surface::vector;

/// Radiance of the sky at the horizon and below, relative to the sun's illuminance [1/sr].
pub const SKY_HORIZON: [f64; 3] = [0.020, 0.024, 0.029];
/// Radiance of the sky overhead, relative to the sun's illuminance [1/sr].
pub const SKY_ZENITH: [f64; 3] = [0.006, 0.011, 0.022];

/// Radiance of the sky in a direction [W/(m^2 sr)] under suns of this illuminance [W/m^2].
pub(super) fn sky(direction: DVec3, sun: DVec3) -> DVec3 {
    sun * DVec3::from(SKY_HORIZON).lerp(SKY_ZENITH.into(), direction.y.clamp(0.0, 1.0))
}

/// Illuminance of a directional light [W/m^2]; zero for all others, which leave the sky black.
pub(crate) fn sun_illuminance(light: &Light) -> DVec3 {
    match light.emitter {
        Emitter::Directional { illuminance, .. } => vector(illuminance),
        _ => DVec3::ZERO,
    }
}
