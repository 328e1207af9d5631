//! Voxelized shadow volumes (Wyman 2011): an epipolar grid of one light whose voxels are bits, set where the light is
//! blocked.
//!
//! The paper's angles are those of `epipolar/`, by other names: its theta is a slice (alpha there), its alpha the angle
//! of the view ray (b there), its phi the angle or offset of the light ray (gamma there). A grid of N^3 voxels has N
//! slices of N rows (view rays) of N columns (light rays); a row is N / 32 words, so that all visibility of a view ray
//! lies in one place. Three steps fill and read it:
//!
//! 1. voxelize: for every light ray (slice, column), set the voxel in whose row its end is seen;
//! 2. scan: along the rows of a slice each voxel becomes the OR of itself and all before it, for a point is dark iff b >= S;
//! 3. query: a view ray reads its row.

pub(crate) mod grid;
pub(crate) mod scan;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod twin;
