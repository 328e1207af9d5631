//! The Khronos PBR Neutral tone mapper (Khronos Group 2024, specification "Khronos PBR Neutral Tone Mapper"):
//! colours below the knee keep hue and saturation, highlights roll off towards white.

/// Start of compression, after the Fresnel offset.
const KNEE: f32 = 0.8 - FRESNEL;
/// Reflectance at normal incidence that is taken out, so that base colours come out as they were painted.
const FRESNEL: f32 = 0.04;
/// Rate at which highlights lose their colour.
const DESATURATION: f32 = 0.15;

/// Maps linear RGB of any range into [0, 1). Negative values and NaN are taken as zero.
pub fn pbr_neutral(color: [f32; 3]) -> [f32; 3] {
    let color = color.map(|x| x.clamp(0.0, f32::MAX).max(0.0));
    let least = color.into_iter().fold(f32::MAX, f32::min);
    let offset = if least < 2.0 * FRESNEL {
        least - least * least / (4.0 * FRESNEL)
    } else {
        FRESNEL
    };
    let color = color.map(|x| x - offset);
    let peak = color.into_iter().fold(0.0, f32::max);
    if peak < KNEE {
        return color;
    }
    let range = 1.0 - KNEE;
    let mapped_peak = 1.0 - range * range / (peak + range - KNEE);
    let whiteness = 1.0 - 1.0 / (DESATURATION * (peak - mapped_peak) + 1.0);
    color.map(|x| {
        let compressed = x / peak * mapped_peak;
        compressed + whiteness * (mapped_peak - compressed)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_stay_grey_and_grow_monotonically() {
        let mut before = -1.0;
        for step in 0..4000 {
            let grey = 1e-4 * (step as f32 * 5e-3).exp();
            let [r, g, b] = pbr_neutral([grey; 3]);
            assert!(r == g && g == b, "{grey}: {r} {g} {b}");
            // In single precision the roll-off reaches 1 at a peak of about 1e6.
            assert!(
                r > before || (r == before && grey > 1e3),
                "{grey}: {r} after {before}"
            );
            assert!((0.0..=1.0).contains(&r), "{grey}: {r}");
            before = r;
        }
    }

    #[test]
    fn below_the_knee_only_the_fresnel_offset_is_taken_out() {
        for color in [[0.2, 0.5, 0.7], [0.08, 0.1, 0.79], [0.5; 3]] {
            let mapped = pbr_neutral(color);
            for (x, y) in color.into_iter().zip(mapped) {
                assert!((x - FRESNEL - y).abs() < 1e-6, "{color:?}: {mapped:?}");
            }
        }
    }

    #[test]
    fn meets_itself_at_the_knee() {
        let (below, above) = (pbr_neutral([0.799_99; 3])[0], pbr_neutral([0.800_01; 3])[0]);
        assert!((above - below).abs() < 3e-5, "{below} {above}");
    }

    #[test]
    fn bright_colours_turn_white_and_nothing_is_nan() {
        let white = pbr_neutral([1e4, 1e2, 1e2]);
        assert!(white.into_iter().all(|x| x > 0.95), "{white:?}");
        for x in [f32::NAN, f32::INFINITY, f32::MAX, -1.0, f32::MIN_POSITIVE] {
            for color in [[x, 0.0, 0.0], [x; 3], [1.0, x, 0.5]] {
                let mapped = pbr_neutral(color);
                assert!(
                    mapped.into_iter().all(|y| (0.0..=1.0).contains(&y)),
                    "{color:?}: {mapped:?}"
                );
            }
        }
    }
}
