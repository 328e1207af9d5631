//! `hybrid`: closed forms where shadow volumes say that there is no shadow, steps where there may be one (Wyman &
//! Ramsey 2008, as Lin 2012 uses it).
//!
//! The boundaries of the occluders' shadow volumes are drawn once, without depth test, for the nearest and the farthest
//! piece on each pixel's ray. Before the nearest, d1, and behind the farthest, d2, all is lit:
//!
//! ```text
//! L = A(0..d1) + (march d1..d2 through the shadow map) + A(d2..D)
//! ```
//!
//! with A the unshadowed light of a stretch in closed form (Chen 2011, eq. 1; Sun et al. 2005 for local lights; see
//! `light/stretch.wesl`). Rays that no volume touches take no step at all. The paper divides its steps over d1..d2; here
//! they keep the length they have in [`ray-march`](super::ray_march), D / `steps`, so that a short shadow costs little and
//! is as exact.
//!
//! # The volumes
//!
//! - The caller hands over the occluders as triangles ([`Occluder`](crate::Occluder), in
//!   [`LightInputs::occluders`](crate::LightInputs)): all that may block the light, or a shadow is missed. Without them
//!   nothing bounds the shadows, and the whole ray is marched. Nothing need be closed, manifold or oriented.
//! - Silhouettes are found on the GPU, from edges that were listed when the mesh was uploaded; walls reach to infinity by
//!   homogeneous coordinates, so that no far plane cuts them off. Those that the shadow map shows to lie in the shadow of
//!   others, a thousandth of their distance apart, are left out.
//! - A conservative rasteriser in compute keeps for each tile of 4 x 4 pixels the depths between which its rays meet any
//!   piece. Where a ray enters a shadow a piece bounds d1, where it leaves d2. A ray that enters and never leaves ends in
//!   the shadow: d2 = D. A compute pass asks whether a triangle lies between eye and light; then d1 = 0.
//! - Bounds are never too small: a piece whose orientation rounding decides counts for both. They are view depths, rounded
//!   outwards to 8 bits, so that what hardly moves keeps them: temporal reuse compares them.
//!
//! # Parameters
//!
//! - `steps`: over the whole ray's reach (512); a middle takes its share.
//! - `show`: the light, or the bounds: nearest (red), farthest (green) and the marched stretch (blue) \[m].
//!
//! # Cost
//!
//! A look at every edge and triangle, the tiles that the silhouettes' walls cross, and the steps of the middles. Two floats a
//! tile; 12 bytes a corner and a triangle and 16 an edge, shared by all places of a mesh, and 8 an element of each place. On a
//! software driver the volumes of a dragon of 200 000 triangles, 640 x 480 pixels, take two sevenths of what they take as draws
//! with a fragment a pixel, of a sponge of many holes a sixth; the middles get longer by a tenth to a sixth, for a tile's
//! bounds hold those of all its rays. Groups of 16 invocations are twice as fast there as of 64. No help: leaving caps out that
//! the map shows to be shaded, asking for the corners of a row of tiles only beside the image's sides.
//!
//! # Where it fails
//!
//! Shadows in the map of what is not among the occluders are lit outside d1..d2. A forest of leaves has a silhouette an
//! edge, and its middles are whole rays. Lights through textures or coloured glass tint what is outside the volumes: their
//! rays are marched whole. Orthographic rays start anywhere: their d1 is 0 where they meet a volume at all, and those of local
//! lights, which may run in a shadow from end to end, are marched whole.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;
mod params;

pub use params::*;

#[cfg(feature = "gpu")]
use crate::techniques::method::GpuMethod;
use crate::techniques::method::Method;

impl Method for Params {
    #[cfg(feature = "gpu")]
    fn gpu(&self) -> Option<&dyn GpuMethod> {
        Some(self)
    }
}
