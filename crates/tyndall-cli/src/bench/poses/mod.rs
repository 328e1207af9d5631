//! Techniques from anywhere: cameras at random within a scene and beside it, close to the light, and with the light on the
//! picture, on its border, in its corners, off each of its sides and behind.

mod camera;
mod errors;
mod run;
mod stage;
mod worst;

pub(super) use run::{Poses, run};
