//! Phase functions: the density of scattering by cos(theta), the cosine between the way light travels
//! and the way it is scattered [1/sr]. All integrate to 1 over the sphere.
//!
//! Each is a file with its parameters and its formula, beside it the WGSL twin; the table gives each a line. The
//! number in the shaders, the dispatch there (`phase_evaluate`), the checks of a frame and the command's shot files follow
//! from that line.

pub mod cornette_shanks;
pub mod draine;
pub mod droplets;
mod function;
pub mod henyey_greenstein;
pub mod isotropic;
pub mod rayleigh;
mod table;
#[cfg(test)]
mod tests;

pub use function::{MAX_PARAMS, PhaseFunction, PhaseInfo, PhaseParam};
#[cfg(feature = "gpu")]
pub(crate) use table::FILES;
pub use table::{Phase, TABLE};
