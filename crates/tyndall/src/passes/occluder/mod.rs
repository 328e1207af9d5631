//! Occluders, as triangles: for techniques that bound the shadows on a view ray by geometry.
//!
//! The volume that a triangle shadows is the infinite prism (sun) or pyramid (local light) behind it. A mesh shadows the
//! union of its triangles' volumes, whose boundary is made of
//!
//! - **caps**: the triangles themselves, and behind a local light's triangles their images at infinity;
//! - **walls**: what an edge sweeps out away from the light. The wall of an edge that two triangles share lies inside the
//!   union where they lie on opposite sides of it, and on the boundary, the silhouette, where they don't.
//!
//! Sides are those of the plane through edge and light, so that neither the triangles' orientation nor a closed mesh is
//! needed: an edge of one triangle, or of more than two, always has its wall. No shadow is missing from the boundary of
//! any set of triangles (Wyman & Ramsey 2008 need closed meshes).
//!
//! Given a shadow map, pieces whose texels are all covered from nearer to the light are left out: their shadow is
//! inside that of what covers them. Of a dragon lit from the side that leaves a fraction of its silhouettes.
//!
//! A conservative rasteriser in compute (`bounds.wesl`) finds where they begin and end along the rays of each tile of
//! 4 x 4 pixels: silhouettes' walls are long and thin, and a fragment a pixel of each costs many times as much.
//!
//! A mesh is welded and its edges are found once, when it is uploaded; silhouettes are found on the GPU, light by light.

mod bounds;
mod clear;
mod eye;
mod list;
mod passes;
mod tile;
mod volume;

pub(crate) use passes::{VolumePrograms, passes};
pub(crate) use volume::{Names, check_list};
