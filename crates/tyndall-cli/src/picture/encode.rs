//! Pictures as 8-bit sRGB: exposed and tone-mapped, or as they are.

use tyndall_scene::texture::srgb_from_linear;

use super::{dither::quantize, linear::Picture, tone::pbr_neutral};

/// Exposes by `ev` (a pixel is multiplied by 2^ev), maps the tones into the display's range and encodes as 8-bit sRGB.
pub fn develop(picture: &Picture, ev: f32) -> Vec<[u8; 3]> {
    let scale = ev.exp2();
    encode_with(picture, |pixel| pbr_neutral(pixel.map(|x| x * scale)))
}

/// Encodes values that are in the display's range already, such as transmittance.
pub fn encode(picture: &Picture) -> Vec<[u8; 3]> {
    encode_with(picture, |pixel| pixel)
}

fn encode_with(picture: &Picture, map: impl Fn([f32; 3]) -> [f32; 3]) -> Vec<[u8; 3]> {
    let width = picture.size[0] as usize;
    picture
        .pixels
        .iter()
        .enumerate()
        .map(|(index, pixel)| {
            let position = [(index % width) as u32, (index / width) as u32];
            map(*pixel).map(|linear| quantize(display_code(linear), position))
        })
        .collect()
}

/// The display's code of a linear value; anything below 0, above 1 or not a number is clamped.
fn display_code(linear: f32) -> f32 {
    srgb_from_linear(linear.clamp(0.0, 1.0).max(0.0).into()) as f32
}

#[cfg(test)]
mod tests {
    use tyndall_scene::texture::linear_from_srgb;

    use super::*;

    #[test]
    fn every_code_survives_decoding_and_encoding() {
        let codes = (0..=255_u8).cycle().take(256 * 64);
        let picture = Picture {
            size: [256, 64],
            pixels: codes
                .clone()
                .map(|code| [linear_from_srgb(f64::from(code) / 255.0) as f32; 3])
                .collect(),
        };
        assert!(encode(&picture).into_iter().eq(codes.map(|code| [code; 3])));
    }

    #[test]
    fn what_is_no_light_is_black_and_what_is_too_much_is_white() {
        let picture = Picture {
            size: [4, 1],
            pixels: [f32::NAN, -1.0, 0.0, f32::INFINITY]
                .map(|x| [x; 3])
                .to_vec(),
        };
        assert_eq!(encode(&picture), [[0; 3], [0; 3], [0; 3], [255; 3]]);
        assert_eq!(develop(&picture, 0.0), [[0; 3], [0; 3], [0; 3], [255; 3]]);
    }
}
