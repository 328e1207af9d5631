//! 8-bit pictures for people.

use std::io::{Error, Result};

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

use crate::{
    layer::Layer,
    picture::{Picture, develop, encode as encode_as_is},
};

/// Exposes and tone-maps light; transmittance is in the display's range as it is.
pub(super) fn encode(layer: Layer, picture: &Picture, ev: f32) -> Result<Vec<u8>> {
    let pixels = match layer {
        Layer::Final | Layer::Inscatter | Layer::Surface => develop(picture, ev),
        Layer::Transmittance | Layer::Depth => encode_as_is(picture),
    };
    let [width, height] = picture.size;
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(
            pixels.as_flattened(),
            width,
            height,
            ExtendedColorType::Rgb8,
        )
        .map_err(Error::other)?;
    Ok(bytes)
}
