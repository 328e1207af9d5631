//! `light-volume`: polygonal light volumes (Billeter, Sintorn, Assarsson 2010).
//!
//! A shadow map is the surface where light ends. Taken as a mesh with one vertex a texel, and closed by the sides of the
//! light's frustum, it bounds the volume of shadow. A view ray's visibility V jumps only where the ray crosses it. With
//! A(s..D) for the light that the unshadowed medium scatters into the stretch from s to the ray's end D,
//!
//! ```text
//! integral over V = V(0) A(0..D) + sum over crossings s < D of (jump of V at s) A(s..D),
//! V(0) = V(infinity) - sum over all crossings of (jump of V at s).
//! ```
//!
//! So the mesh is drawn once, without depth test, with additive blending: each fragment adds its jump (-1 where the ray
//! enters the shadow, its front side, +1 where it leaves) to alpha and jump times A(s..D) to rgb. The paper sums A(0..s),
//! with s clamped at the scene; taken from the far end, crossings behind the scene add nothing at all instead of large
//! terms that must cancel, and V(0) is a whole number, exact in any float: the eye may be in the light or not. Beyond a
//! single map everything is lit, V(infinity) = 1; a cube's surface is closed by itself, and beyond it is shadow.
//!
//! A is a closed form for directional and point lights (Chen 2011, eq. 1; Sun et al. 2005), tables by phase
//! function for the latter; a spot's fading rim takes quadrature (`stretch.wesl`).
//!
//! # The mesh
//!
//! - Vertices lie on the middles of texels, and on the map's border. Where depths break off between two texels, both
//!   vertices move to the border between them (the depth along, so that planes stay planes). The paper's wall slants
//!   from one texel's middle to the next, wider towards its far end: relative error of a hall behind a window grid,
//!   2048^2 map: 0.0115 with slanted walls, 0.0058 with moved vertices; a church's windows: 0.024 and 0.014.
//! - A texel that holds nothing ends beyond all that is seen. Faces of a cube share the vertices of their edges, at the
//!   mean depth of the texels on either side: no walls between them.
//! - Vertices are made in the vertex shader, from the map itself. With `tolerance` 0 every cell is drawn. Else cells of
//!   planar surfaces are merged, by compute passes that leave a list of triangles and its length on the GPU
//!   (`tessellation.rs`); nothing is read back. Where the list would be longer than half the full mesh, that is drawn.
//!   Triangles, of the full mesh and the list, are among the view's counts.
//! - The list names vertices, not places: where the caller says that the map stays
//!   (`LightInputs::shadow_revision`), the eye may move and the list is kept.
//!
//! # Parameters
//!
//! - `tolerance`: how far merging may move the surface along the light, in widths of a texel there. Triangles of the
//!   church (4096^2 map) and of mountains at 0.5: 51 and 9 times fewer than 33.6 million, at an added relative error below
//!   0.0001 (the church: 0.0008 less, for fewer slivers).
//!
//! # Cost
//!
//! Triangles of the map, and fragments: a ray pays for every surface it crosses, seen or not. The list takes half the
//! full mesh's triangles x 4 bytes at most (64 MiB for 4096^2), the sums a texture of four floats. Of
//! coloured glass, blocks of 16 x 16 texels hold the range of depths, and the tint behind all of it: a ray behind it, in the
//! light, passes over blocks of one tint as one stretch, and is walked texel by texel where a block cannot tell.
//!
//! # Where it fails
//!
//! Light textures tint a light along its whole length, not behind a surface: they are refused. So are maps of more than
//! 4096 texels a side. Features one texel wide have a break on either side and stay slanted. Sums are 32-bit floats where
//! the device has `FLOAT32_BLENDABLE`, else 16-bit ones (the counts say which): relative error of random blocks from
//! 0.0039 to 0.0052 at most, of suns alone from 0.0011 to 0.0015.

#[cfg(feature = "gpu")]
mod check;
#[cfg(feature = "gpu")]
mod extent;
#[cfg(feature = "gpu")]
mod gpu;
#[cfg(feature = "gpu")]
mod grow;
#[cfg(feature = "gpu")]
mod list;
#[cfg(feature = "gpu")]
mod mesh;
#[cfg(feature = "gpu")]
mod panes;
mod params;
#[cfg(feature = "gpu")]
mod resolve;
#[cfg(feature = "gpu")]
mod split;
#[cfg(feature = "gpu")]
mod surface;
#[cfg(feature = "gpu")]
mod tessellation;
#[cfg(all(test, feature = "gpu"))]
mod tests;
#[cfg(feature = "gpu")]
mod tree;
#[cfg(all(test, feature = "gpu"))]
mod twin;

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
