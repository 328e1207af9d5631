//! The grid that a light's shadow map is rectified to: slices by light rays, over what a camera sees of them.
//!
//! ```text
//! camera        light   alpha (which slice)     gamma (which light ray)        b (which view ray)
//! perspective   sun     turn about the axis     distance from the axis [m]     angle to the axis
//! perspective   local   turn about the axis     angle at the light [rad]       angle to the axis
//! orthographic  sun     offset [m]              offset across the light [m]    offset along the light, sheared [m]
//! orthographic  local   turn about the axis     angle at the light [rad]       distance from the axis [m]
//! ```
//!
//! The axis runs through the eye, towards the sun or the local light; of an orthographic camera, whose eye is at
//! infinity, through a local light along the view. In every case `b` is the same all along a view ray, and a light ray
//! that ends has an S such that a point on it is lit iff b < S (Chen 2011, section 3.2). Angles b are measured on a
//! scale that grows with the angle and takes one division, [`angle_scale`].

mod coordinates;
mod cover;
mod ranges;
#[cfg(test)]
mod tests;

pub(crate) use coordinates::{EpipolarGrid, GridRay};
pub(crate) use ranges::{GridScene, SVD_LEAST_SINE};
