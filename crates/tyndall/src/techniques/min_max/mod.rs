//! `min-max`: 1-D min-max mipmaps (Chen, Baran, Durand, Jarosz 2011).
//!
//! Light and view rays of one slice through the eye and the light meet in one plane. The shadow map, resampled to
//! slices, becomes one row S\[gamma] a slice, and a point of the view ray b at the light ray gamma is lit iff
//! b < S\[gamma]: a search in one dimension, sped up by a complete binary tree of (min, max) over the row. The tree is
//! traversed without recursion, up at most one level a step, and adjoining nodes in the same state make one stretch (the
//! paper's figure 5 and section 3.5).
//!
//! The paper samples S; a leaf here is a cell of light rays, as wide as its slice, and holds the least and the
//! greatest S of all of them: from the nearest and farthest depth of the shadow map's texels beneath it, read from a
//! pyramid of the map, and rounded outwards to 16 bits. So what the tree calls lit or dark is so for every view ray of the
//! slice, and where it can tell neither, the ray is walked through the map's texels. Shadows are those of the map,
//! exactly, whatever the resolution; it only shares the work out between trees and walks. Cameras may be perspective
//! or orthographic, maps single or cubes.
//!
//! # Integrators
//!
//! - `analytic` integrates each lit stretch in closed form (as section 4.3 suggests for untextured lights):
//!   exponentials of the sun, airlight tables of a lamp (Sun et al. 2005). Cones that fade and textured lights go by
//!   quadrature.
//! - `svd` takes the integrand without visibility for a sum of few products of a function of the view ray and one of
//!   the light ray (section 3.2, eq. 5 and 6), which a singular value decomposition finds, per colour channel:
//!
//! ```text
//! stretch from a to b = F(beta) sum_i B_i(beta) (C_i(gamma_b) - C_i(gamma_a)),   C_i = integral of Gamma_i d gamma
//! ```
//!
//! F, `1 / sin(beta)` of the sun and `1 / h` of a lamp at distance h from the ray, grows without bound towards the axis
//! and is left out of the decomposition; rays within a tenth of a radian of the axis are integrated analytically. Beyond
//! the far plane the products need not be right, only smooth: where the integrand dropped to zero for light rays that
//! never meet the view ray, the error of four terms in thin air was 0.04 instead of 0.003. Cones and textures go into C_i
//! as factors of Gamma_i. Largest relative error against `analytic`, over random blocks before suns, lamps and spots in
//! media of every phase function, grey and coloured: 0.22 with one term, 0.069 with 2, 0.018 with 4, 0.004 with 8. An
//! orthographic camera has no eye to measure angles at: with `svd` it is refused.
//!
//! # Tints
//!
//! - A light's texture dims a light ray on its entire length. On the GPU each slice holds its sums up to every column of
//!   gamma, as many as leaves and at least 512: with the 64 of a coarse map a texture was 0.12 wrong, with 512 0.02.
//!   A stretch is cut into blocks of 0.1 optical depth or 0.01 rad at the light; each block's light goes with the mean of
//!   the texture over it. Sums of the `svd` integrator are weighted by Gamma_i, and need no blocks. The CPU samples
//!   the texture as finely as it takes, with either integrator.
//! - Coloured glass tints from where it is on. A second tree of (min, max) holds the glass, and the tint behind all of it:
//!   a node before all of its glass is as clear as any, one behind all of it has that tint, if its light rays agree on one;
//!   neighbours of one tint make one stretch. Where a leaf can tell neither, at a pane's rim, as the ray passes it, and
//!   behind glass that differs from texel to texel, the ray is walked through the texels, analytically. Relative error of
//!   a rose window: 0.0001, at twice the time of a church without tints; sums over each slice instead, as of a texture:
//!   0.02 to 0.05. Random panes are within 0.0003 of the map's exact light. The CPU finds the same in blocks of the map
//!   instead of trees.
//!
//! # Parameters
//!
//! - `integrator`, `rank`: see above.
//! - `slices`: how many; 0 takes as many as put every view ray within half a pixel of one (the paper's rule), but at most
//!   1024: more only cost time. At least so many are taken that none is wider than a quarter of a radian.
//! - `samples`: leaves a slice, over what the image's rays and the light's map have in common; 0 takes half as many as
//!   the shadow map has texels a side. A power of two: other numbers are rounded up.
//! - `epipole_radius`: view rays within so many pixels of the axis cross few leaves and are walked. So is every ray
//!   where the eye is at the light, or an orthographic view runs along the sun. The choice is one of cost, not of quality:
//!   with a radius of 0, 2 or 8 pixels, the errors of the pixels on either side of its border are alike (CPU: none, GPU:
//!   below 0.0005).
//!
//! # Cost
//!
//! Slices x samples cells, some texels of the pyramid each; then some nodes a border between light and shadow, and
//! some texels an undecided leaf. The GPU draws the pyramid of the map, rectifies and builds the trees in one dispatch,
//! sums up textures where there are any, and traverses: one full-screen pass. On the CPU, of a church through whose
//! windows the sun shines, 640 x 480 pixels and a 4096^2 map: 256 slices take three times as long as 1024, and 4096 take
//! 1.7 times as long.
//!
//! # What was tried
//!
//! Measured on a software driver, of a church 320 x 240 pixels with a 4096^2 map unless said otherwise.
//!
//! - S at points, of the nearest slice, as in the paper: relative error 0.0088 at 4096 slices of 4096 samples, 0.0020 at
//!   16384 of 16384. Leaves that bound all light rays of their cell: 0.00007 at 1024 of 2048.
//! - Branches for rare work inside the traversal's loop: where a processor runs rays in step, a branch's body costs all
//!   of them, taken or not. Loops that end for rare work, which is then done once, and stretches that are collected
//!   first and integrated after took the traversal of 1280 x 960 pixels from 3200 to 700 ms.
//! - The pyramid by compute through workgroup memory: 300 ms, by drawing 100 ms.
//!
//! # Where it fails
//!
//! Cells that span two faces of a cube are not decided; shadows as fine as the map's texels leave few
//! leaves decided, and the technique is then a walk with a detour: in a forest at 1280 x 960 pixels and a 4096^2 map a
//! ray visits 191 nodes and 577 texels (242 and 285 with 4096 x 4096 cells), and a frame takes as long as some 2000
//! steps of marching, against 100 in a church. It is exact for that: marching is not as good with 32768 steps, 15 times
//! the time (`tyndall bench chen`), but with 2000 steps its error there is 0.003, which may do.

#[cfg(feature = "gpu")]
mod buffers;
mod cpu;
#[cfg(feature = "gpu")]
mod gpu;
mod params;
#[cfg(feature = "gpu")]
mod rectify;
#[cfg(feature = "gpu")]
mod show;
mod svd;
mod svd_stretch;
#[cfg(feature = "gpu")]
mod tint_rows;
#[cfg(feature = "gpu")]
mod traverse;

pub use params::*;

#[cfg(feature = "gpu")]
use crate::techniques::method::GpuMethod;
use crate::{
    error::PrepareError,
    frame::Camera,
    techniques::method::{CpuMethod, Method},
};

impl Method for Params {
    fn check(&self, camera: &Camera) -> Result<(), PrepareError> {
        svd::check(self, camera)
    }

    fn cpu(&self) -> Option<&dyn CpuMethod> {
        Some(self)
    }

    #[cfg(feature = "gpu")]
    fn gpu(&self) -> Option<&dyn GpuMethod> {
        Some(self)
    }
}
