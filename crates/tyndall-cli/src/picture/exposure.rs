//! Automatic exposure: scenes range over five orders of magnitude and more.

use super::linear::{Picture, luminance};

/// Target of the middle tones' mean: middle grey (Reinhard et al. 2002, "Photographic Tone Reproduction").
const KEY: f32 = 0.18;
/// The share of pixels, from the brightest down, that may be clipped nearly to white (lamps, windows).
const HIGHLIGHT_SHARE: f32 = 0.03;
/// Largest brightness of the rest after exposure: the tone mapper shows 2.5 as 0.97.
const HIGHLIGHT: f32 = 2.5;
/// Pixels darker than this fraction of the highlight count as that dark: black holes don't brighten the picture.
const FLOOR: f32 = 1e-3;

/// The exposure \[EV] that shows this picture well: the logarithmic mean of its luminance goes to middle grey,
/// unless that would burn out more than the brightest few percent. 0 for a black picture.
pub fn automatic_exposure(picture: &Picture) -> f32 {
    let mut values: Vec<f32> = picture
        .pixels
        .iter()
        .map(|pixel| luminance(*pixel))
        .filter(|y| y.is_finite() && *y > 0.0)
        .collect();
    if values.is_empty() {
        return 0.0;
    }
    let highlight = percentile(&mut values, 1.0 - HIGHLIGHT_SHARE);
    let dark = picture.pixels.len() - values.len();
    let floor = (FLOOR * highlight).max(f32::MIN_POSITIVE);
    let logarithms: f64 = values.iter().map(|y| f64::from(y.max(floor).ln())).sum();
    let sum = logarithms + dark as f64 * f64::from(floor.ln());
    let mean = (sum / picture.pixels.len() as f64).exp() as f32;
    (KEY / mean).min(HIGHLIGHT / highlight).log2()
}

/// The value that this share of the values is below.
fn percentile(values: &mut [f32], share: f32) -> f32 {
    let index = ((values.len() - 1) as f32 * share) as usize;
    *values.select_nth_unstable_by(index, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(pixels: impl IntoIterator<Item = f32>) -> Picture {
        let pixels: Vec<[f32; 3]> = pixels.into_iter().map(|x| [x; 3]).collect();
        Picture {
            size: [pixels.len() as u32, 1],
            pixels,
        }
    }

    #[test]
    fn an_even_picture_goes_to_middle_grey_at_any_brightness() {
        for brightness in [1e-6, 0.18, 1.0, 68_300.0] {
            let ev = automatic_exposure(&picture([brightness; 100]));
            assert!(
                (brightness * ev.exp2() - KEY).abs() < 1e-5,
                "{brightness}: {ev}"
            );
        }
    }

    #[test]
    fn a_few_lamps_and_broken_pixels_change_little() {
        let even = automatic_exposure(&picture([1.0; 1000]));
        let lamps = (0..1000).map(|i| match i {
            0..3 => 1e6,
            3 => f32::NAN,
            4 => f32::INFINITY,
            _ => 1.0,
        });
        // Measured: 0.04 EV.
        assert!((automatic_exposure(&picture(lamps)) - even).abs() < 0.1);
    }

    #[test]
    fn a_shaft_in_the_dark_is_not_burnt_out() {
        let shaft = (0..100).map(|i| if i < 10 { 5.0 } else { 1e-4 });
        let ev = automatic_exposure(&picture(shaft));
        assert!((5.0 * ev.exp2() - HIGHLIGHT).abs() < 1e-4, "{ev}");
    }

    #[test]
    fn black_needs_no_exposure() {
        assert_eq!(automatic_exposure(&picture([0.0; 10])), 0.0);
        assert_eq!(automatic_exposure(&picture([])), 0.0);
    }
}
