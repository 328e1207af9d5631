//! Shadow maps: what a light sees, looked up by the point it shines on.
//!
//! A lookup takes the texel that a point falls on, without filter: the medium is lit iff it is not farther from the
//! light than the texel's depth. The medium needs no bias: a texel's error is as often too near as too far, and the
//! surface itself has no volume. Outside the map, and where nothing was drawn, everything is lit.

pub(crate) mod depths;
mod map;
mod panes;
mod shade;
pub mod walk;

pub use map::*;
pub use shade::{Occluders, Shade};
