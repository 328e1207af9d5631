//! Imperfect shadow maps (Ritschel et al. 2008): a hemispherical map of each sample of an area light, all made at once
//! from a point cloud of the surfaces.
//!
//! Each sample draws its own block of the cloud: a point is projected on the hemisphere before the light and its
//! distance kept where it is the least so far (an atomic minimum of the bits of a positive float). A point covers the
//! texels of the disc it stands for, a single one far away. Empty texels are filled from their neighbours, coarser and
//! coarser (pull), and back down (push).
//!
//! The projection is the upper half of an octahedron, turned by 45 degrees: unlike the paper's paraboloid it leaves no texel
//! of the square unused. Each sample's is turned about the light's normal by another angle, so that texels of different
//! samples don't line up.

pub(crate) mod area;
pub(crate) mod buffers;
mod colors;
pub(crate) mod gpu;
mod pull_push;
mod splat;
#[cfg(test)]
mod tests;
#[cfg(test)]
pub(crate) mod twin;
