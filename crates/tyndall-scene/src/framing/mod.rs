//! A view, lights and a haze for scenes that come without.
//!
//! A scene's own first camera and its own lights are taken. What it lacks is chosen so that shafts show: cameras are
//! set up inside, at clear spots with a long free view, where the scene is an interior, and all round, looking down
//! at it, where it is not; each is tried with the scene's lights, or with suns all over the sky. The pair whose
//! in-scattered light differs most from view ray to view ray wins. A scene gives the same framing each time.

mod candidates;
mod choice;
mod defaults;
mod nodes;
mod probe;

pub use choice::{Framing, frame_scene};
pub use nodes::{cameras, lights};
