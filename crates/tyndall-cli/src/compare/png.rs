//! Pictures as PNGs in memory.

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

use crate::picture::{Picture, develop};

/// In-scattered radiance, exposed and tone-mapped.
pub(super) fn developed(picture: &Picture, ev: f32) -> Result<Vec<u8>, image::ImageError> {
    png(&develop(picture, ev), picture.size)
}

/// 8-bit sRGB as a PNG.
pub(super) fn png(pixels: &[[u8; 3]], size: [u32; 2]) -> Result<Vec<u8>, image::ImageError> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(
        pixels.as_flattened(),
        size[0],
        size[1],
        ExtendedColorType::Rgb8,
    )?;
    Ok(bytes)
}
