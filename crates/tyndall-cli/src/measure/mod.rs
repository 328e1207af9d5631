//! Measuring: a frame drawn once ([`DrawnFrame`]), then rendered and [timed](Timings) by any technique, and the
//! [errors](error_of) of its pictures; how many steps brute force needs for the [same error or gets in the
//! same time](Marches).
//!
//! All techniques see the same depth buffer and the same shadow maps: those that run on the CPU are handed the GPU's, read
//! back. Their differences are then theirs alone.

mod drawn;
mod equal;
mod error;
mod film;
mod limit;
mod place;
mod sparse;
mod timing;
mod turns;

#[cfg(test)]
pub(crate) mod tests;

pub use crate::metrics::PictureError;
pub use drawn::{DrawnFrame, converged};
pub use equal::{
    EqualQuality, MAX_STEPS, Marches, ray_march, steps_in_time, time_of_steps, timed_marches,
};
pub use error::error_of;
pub use film::{Film, TakeFrame};
pub use place::Place;
pub use sparse::Sparse;
pub use timing::{Budget, Spread, Timing, Timings};
pub use tyndall::techniques::reference::Visibility;
