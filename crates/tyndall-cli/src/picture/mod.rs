//! From scene-referred radiance to the bytes of a picture: exposure, tone mapping, sRGB, dithering.

mod dither;
mod encode;
mod exposure;
mod linear;
mod tone;

pub use encode::{develop, encode};
pub use exposure::automatic_exposure;
pub use linear::Picture;
pub use tone::pbr_neutral;
