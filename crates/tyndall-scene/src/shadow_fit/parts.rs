//! What all maps share.

use glam::{DMat4, DVec3};
use tyndall::frame::ShadowProjection;

use crate::geometry::Geometry;

/// Space round the scene, relative to its size in the map: a texel of a map of 1024.
pub(super) const MARGIN: f64 = 1.0 / 1024.0;

/// The corners of all triangles.
pub(super) fn corners(geometry: &Geometry) -> impl Iterator<Item = DVec3> {
    geometry.positions.iter().flatten().map(|p| p.as_dvec3())
}

/// A single map of reversed depth.
pub(super) fn single(clip_from_world: DMat4) -> ShadowProjection {
    ShadowProjection::Single {
        clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
        reversed_depth: true,
    }
}

/// The smallest and the largest of some numbers.
pub(super) fn extent(numbers: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    numbers
        .map(|x| [x, x])
        .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}
