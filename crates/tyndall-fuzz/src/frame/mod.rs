//! Frames of any values, on the CPU and on the GPU.

mod cpu;
mod drawn;
mod gpu;

pub use cpu::run as on_cpu;
pub use gpu::run as on_gpu;

use crate::outcome::Outcome;

/// The outcome of an image's pixels: radiance, and transmittance last.
fn checked(pixels: &[[f32; 4]], what: &dyn std::fmt::Debug) -> Outcome {
    for pixel in pixels {
        // The GPU's exponentials may round a little past 1.
        let is_good =
            pixel.iter().all(|x| x.is_finite()) && (-1e-5..=1.0 + 1e-5).contains(&pixel[3]);
        assert!(
            is_good,
            "must be finite and a transmittance in [0, 1], found {pixel:?} of {what:?}"
        );
    }
    Outcome::Computed
}
