//! Surfaces lit by the frame's lights: Lambert, shadow-mapped. The arithmetic is spelled out so that a shader can do
//! the same.
//!
//! Radiance towards the eye of a surface with base colour `c`, unit normal `n` and point `p`:
//!
//! `view_tint * (emissive + c / pi * sum over lights of (visibility * max(-n . l, 0) * full + ambient * bare))`
//!
//! where `l` is the direction the light travels in and `full` the irradiance on a surface facing it: with the spot's cone
//! and the light's texture, and for local lights exp(-sigma_t d) / d^2 ([`LightModel::incident`]). `bare` leaves cone and
//! texture out; times `ambient` = [`AMBIENT`] * (1 + [`AMBIENT_TILT`] * n.y) it keeps what is unlit from being quite black.
//! Attenuation between surface and eye is left to the composite.
//!
//! **Visibility** compares depths at the four texels round a point, weighted bilinearly, each multiplied by the tints of
//! the glass layers before the point. The point is `p` moved along `n` by [`NORMAL_OFFSET_TEXELS`] and, times the sine between `n`
//! and `l`, [`NORMAL_OFFSET_GRAZING_TEXELS`] texels, as large as texels are at `p`. The four texels are at most sqrt(2) texels
//! away and hold their plane's nearest depth, half as much nearer; on a plane of any slope an offset of 1.5 sqrt(2) times the sine
//! clears the depths there, and the rest is for curved surfaces. Texels outside the map are lit; a cube's are clamped to
//! the face. A texel where nothing was drawn is lit.
//!
//! **Traced** is, on the CPU, the visibility of lights that are given no shadow map, through glass as well.
//!
//! **Rectangles** have no shadow map. They shine as [`RECT_SAMPLES`] points, unblocked; visibility is the share of their
//! light that arrives of as many samples as the light itself says: traced on the CPU; the GPU is given the visibility that
//! a technique of tyndall's found.
//!
//! **Sky**, where there is no surface: from [`SKY_HORIZON`] to [`SKY_ZENITH`] with the height of the view ray's
//! direction, times the directional lights' illuminance and the view tint. A scene without a sun has a black sky.
//!
//! | file | what |
//! |---|---|
//! | `radiance` | all pixels: sky, emission and every light |
//! | `light` | the irradiance of one light on a surface |
//! | `shadow_map` | its visibility by a shadow map with glass |
//! | `traced` | its visibility by rays, where it has no map |
//! | `sky` | radiance where there is no surface |
//! | `surface` | the point that a pixel sees |
//!
//! [`LightModel::incident`]: tyndall::light::LightModel::incident

mod light;
mod radiance;
mod shadow_map;
mod sky;
mod surface;
mod traced;

pub use light::{AMBIENT, AMBIENT_TILT, RECT_SAMPLES};
pub use radiance::shade;
pub use shadow_map::{NORMAL_OFFSET_GRAZING_TEXELS, NORMAL_OFFSET_TEXELS};
#[cfg(feature = "gpu")]
pub(crate) use sky::sun_illuminance;
pub use sky::{SKY_HORIZON, SKY_ZENITH};

#[cfg(test)]
mod tests;
