//! Errors as colours: four decades up to the reference's mean, on a logarithmic scale.

use std::ops::RangeInclusive;

use colorgrad::{Gradient, preset};

use crate::picture::Picture;

/// The smallest error that has a colour of its own, relative to the reference's mean.
pub const FLOOR: f64 = 1e-4;
/// Powers of ten above the floor.
const DECADES: f64 = 4.0;
/// Colour of values that are no numbers; neither map has it.
const BROKEN: [u8; 3] = [0, 255, 0];

/// A scale of colours for a pixel's error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorMap {
    /// mean over channels |a - b| / mean(b), from black (small) over purple to yellow.
    Magnitude,
    /// mean over channels (a - b) / mean(b), from blue (too dark) over white to red (too bright).
    Signed,
}

impl ErrorMap {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Magnitude, Self::Signed];

    /// Its name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Magnitude => "Error",
            Self::Signed => "Signed error",
        }
    }

    /// Its name in files.
    pub fn file_stem(self) -> &'static str {
        match self {
            Self::Magnitude => "error",
            Self::Signed => "signed-error",
        }
    }

    /// The scale: decades above [`FLOOR`], with the error's sign.
    pub fn decades(self) -> RangeInclusive<f64> {
        match self {
            Self::Magnitude => 0.0..=DECADES,
            Self::Signed => -DECADES..=DECADES,
        }
    }

    /// The colours of errors (a - b) / mean(b), one list of channels a pixel.
    pub fn colors<'a>(self, errors: impl IntoIterator<Item = &'a [f64; 3]>) -> Vec<[u8; 3]> {
        let palette = self.palette();
        let color = |error: &[f64; 3]| self.color(&*palette, self.decade(self.pixel(error)));
        errors.into_iter().map(color).collect()
    }

    /// `count` colours from the scale's one end to its other.
    pub fn ramp(self, count: usize) -> Vec<[u8; 3]> {
        let palette = self.palette();
        let (from, to) = (*self.decades().start(), *self.decades().end());
        let decade = |i: usize| from + (to - from) * (i as f64 + 0.5) / count as f64;
        (0..count)
            .map(|i| self.color(&*palette, decade(i)))
            .collect()
    }

    /// A pixel's error.
    fn pixel(self, channels: &[f64; 3]) -> f64 {
        let mean = |channels: [f64; 3]| channels.iter().sum::<f64>() / 3.0;
        match self {
            Self::Magnitude => mean(channels.map(f64::abs)),
            Self::Signed => mean(*channels),
        }
    }

    /// Position of an error on the scale.
    fn decade(self, error: f64) -> f64 {
        (error.abs() / FLOOR).log10().clamp(0.0, DECADES) * error.signum()
    }

    fn color(self, palette: &dyn Gradient, decade: f64) -> [u8; 3] {
        if decade.is_nan() {
            return BROKEN;
        }
        let (from, to) = (*self.decades().start(), *self.decades().end());
        let t = ((decade - from) / (to - from)) as f32;
        // ColorBrewer's RdBu reversed: red is what glows.
        let t = if self == Self::Signed { 1.0 - t } else { t };
        let [r, g, b, _] = palette.at(t).to_rgba8();
        [r, g, b]
    }

    /// Perceptually even, and told apart by all common kinds of colour vision.
    fn palette(self) -> Box<dyn Gradient> {
        match self {
            Self::Magnitude => Box::new(preset::inferno()),
            Self::Signed => Box::new(preset::rd_bu()),
        }
    }
}

/// Errors (a - b) / mean(b) of a picture, per pixel and channel; zero where there is no difference, whatever the mean.
pub fn relative_errors(picture: &Picture, reference: &Picture) -> Vec<[f64; 3]> {
    let mean = mean(reference);
    let relative = |a: f32, b: f32| {
        let difference = f64::from(a) - f64::from(b);
        if difference == 0.0 {
            0.0
        } else {
            difference / mean
        }
    };
    let pixels = picture.pixels.iter().zip(&reference.pixels);
    pixels
        .map(|(a, b)| std::array::from_fn(|c| relative(a[c], b[c])))
        .collect()
}

/// Mean over pixels and channels.
pub fn mean(picture: &Picture) -> f64 {
    let values = picture.pixels.as_flattened();
    values.iter().map(|x| f64::from(*x)).sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn color(map: ErrorMap, error: f64) -> [u8; 3] {
        map.colors([&[error; 3]])[0]
    }

    #[test]
    fn errors_have_their_places_on_the_scale() {
        use ErrorMap::{Magnitude, Signed};
        for (map, error, decade) in [
            (Magnitude, 0.0, 0.0),
            (Magnitude, 1e-5, 0.0),
            (Magnitude, 1e-3, 1.0),
            (Magnitude, 0.1, 3.0),
            (Magnitude, f64::INFINITY, 4.0),
            (Signed, 1e-5, 0.0),
            (Signed, -1e-2, -2.0),
            (Signed, 7.0, 4.0),
        ] {
            let found = map.decade(error);
            assert!((found - decade).abs() < 1e-12, "{map:?} {error}: {found}");
        }
    }

    #[test]
    fn larger_errors_are_brighter_and_signs_have_hues() {
        let brightness = |error| {
            color(ErrorMap::Magnitude, error)
                .map(u32::from)
                .iter()
                .sum::<u32>()
        };
        let errors = [1e-4, 1e-3, 1e-2, 1e-1, 1.0];
        assert!(
            errors
                .windows(2)
                .all(|e| brightness(e[0]) < brightness(e[1]))
        );
        let [r, _, b] = color(ErrorMap::Signed, 0.5);
        assert!(r > b + 80, "{r} {b}");
        let [r, _, b] = color(ErrorMap::Signed, -0.5);
        assert!(b > r + 80, "{r} {b}");
        assert_eq!(color(ErrorMap::Signed, f64::NAN), BROKEN);
        assert_eq!(color(ErrorMap::Magnitude, f64::NAN), BROKEN);
    }

    #[test]
    fn channels_that_cancel_have_a_magnitude_all_the_same() {
        let errors = [0.1, -0.1, 0.0];
        assert_eq!(ErrorMap::Signed.pixel(&errors), 0.0);
        assert!((ErrorMap::Magnitude.pixel(&errors) - 0.2 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn errors_are_relative_to_the_mean_even_of_black() {
        let picture = |values: [f32; 2]| Picture {
            size: [2, 1],
            pixels: values.map(|x| [x; 3]).to_vec(),
        };
        let errors = |a, b| relative_errors(&picture(a), &picture(b));
        assert_eq!(errors([1.5, 2.0], [1.0, 3.0]), [[0.25; 3], [-0.5; 3]]);
        assert_eq!(errors([0.0, 1.0], [0.0; 2]), [[0.0; 3], [f64::INFINITY; 3]]);
    }

    #[test]
    fn a_ramp_runs_through_the_scale() {
        let ramp = ErrorMap::Signed.ramp(9);
        let [first, middle, last] = [ramp[0], ramp[4], ramp[8]];
        assert!(first[2] > first[0] && last[0] > last[2], "{ramp:?}");
        assert!(middle.iter().all(|x| *x > 230), "{ramp:?}");
    }
}
