//! Projections of shadow maps that fit a scene, or what a camera sees of it.
//!
//! **Bias.** A texel holds the least distance from the light of the plane that its centre meets, within the texel: the depth of
//! the centre, and half a texel's slope towards the light. What a surface hides from the light is dark then right up to it; the
//! centre's own depth would let light through between the steps of a slanted wall, into closed rooms. In exchange up to as
//! much before a lit surface is dark. Surfaces are looked up at a point moved along their normal, which clears the depth
//! differences within the filter's footprint at any slope; see [`shading`](crate::shading).
//!
//! **Depth** is reversed (1 at the near plane): floating-point depths are then about equally precise at all distances,
//! and a near plane close to the light costs nothing.
//!
//! | file | what |
//! |---|---|
//! | `choice` | which light has which map |
//! | `sun` | the map of a directional light |
//! | `plane` | the plane across its light |
//! | `rectangle` | the smallest rectangle round points |
//! | `seen` | the shadows that view rays pass |
//! | `region` | the rectangle that such shadows need |
//! | `clip` | the part of triangles in a rectangle |
//! | `local` | maps of lights that have a position |
//! | `parts` | what all of them share |

mod choice;
mod clip;
mod local;
mod parts;
mod plane;
mod rectangle;
mod region;
mod seen;
mod sun;

#[cfg(test)]
mod tests;

pub use choice::{fit, fit_seen};
pub use local::WIDEST_SINGLE_MAP;
pub use seen::Seen;
