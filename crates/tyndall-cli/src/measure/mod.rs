//! Measuring: a shot set up once ([`Stage`]), then rendered and [timed](Timings) by any technique, and the
//! [errors](error_of) of its pictures; how many steps brute force needs for the [same error or gets in the
//! same time](Marches).
//!
//! All techniques of a stage see the same depth buffer and the same shadow maps: those that run on the CPU are handed
//! the GPU's, read back. What they differ in is then theirs alone.

mod device;
mod equal;
mod error;
mod film;
mod limit;
mod stage;
mod timing;

#[cfg(test)]
pub(crate) mod tests;

pub use crate::metrics::PictureError;
pub use equal::{
    EqualQuality, MAX_STEPS, Marches, ray_march, steps_in_time, time_of_steps, timed_marches,
};
pub use error::error_of;
pub use film::{Film, TakeFrame};
pub use stage::{Place, Stage, converged};
pub use timing::{Budget, Spread, Timing, Timings};
pub use tyndall::techniques::reference::Visibility;
