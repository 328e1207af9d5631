//! Errors of a picture against the one that is taken for true.

use crate::{
    failure::Failure,
    metrics::{self, PictureError},
    picture::Picture,
};

/// Errors of a picture, relative to the truth's mean: of linear values, over pixels and channels.
///
/// # Errors
/// [`Failure::Input`] where the pictures have different sizes or there is nothing in them.
pub fn error_of(picture: &Picture, truth: &Picture) -> Result<PictureError, Failure> {
    metrics::compare(picture, truth).map_err(Failure::input)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_is_5_percent_too_bright_is_5_percent_biased() {
        let pixels: Vec<[f32; 3]> = (0..64).map(|i| [i as f32, 0.5, 64.0 - i as f32]).collect();
        let truth = Picture {
            size: [8, 8],
            pixels,
        };
        let mut wrong = truth.clone();
        wrong
            .pixels
            .as_flattened_mut()
            .iter_mut()
            .for_each(|x| *x *= 1.05);
        let error = error_of(&wrong, &truth).unwrap();
        // Rounding to f32: 2e-8.
        assert!((error.bias - 0.05).abs() < 1e-7, "{error:?}");
        assert!((error.rel_mae - 0.05).abs() < 1e-7, "{error:?}");
    }

    #[test]
    fn pictures_of_other_sizes_cannot_be_compared() {
        let picture = |size: [u32; 2]| Picture {
            size,
            pixels: vec![[1.0; 3]; 12],
        };
        let failure = error_of(&picture([4, 3]), &picture([3, 4])).unwrap_err();
        assert_eq!(failure.exit_code(), 1);
        assert!(failure.to_string().contains("expected 3 x 4"), "{failure}");
    }
}
