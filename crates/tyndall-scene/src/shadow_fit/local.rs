//! Maps of lights that have a position.

use glam::{
    DVec3,
    dcamera::rh::{proj::directx, view},
};
use tyndall::frame::ShadowProjection;

use super::parts::{MARGIN, corners, extent, single};
use crate::geometry::Geometry;

/// Smallest distance of the near plane, relative to the far plane's. Surfaces closer to the light cast no shadow.
const NEAR_OVER_FAR: f64 = 1e-4;

/// Half angle \[rad] of a cone beyond which a spot has a cube: 70 degrees. The map that a cone just fits in is tan(angle) to
/// each side of the axis, endless at 90 degrees. Relative errors of a wood under such a spot, of a map of 294^2 texels and
/// of a cube of as many, 6 x 120^2: 0.0019 and 0.0032 at 55 degrees, 0.0083 and 0.0090 at 70, 0.0120 and 0.0128 at 75; at
/// twice the side 0.0041 and 0.0051 at 70, 0.0068 and 0.0073 at 75.
pub const WIDEST_SINGLE_MAP: f64 = 70.0 * std::f64::consts::PI / 180.0;

pub(super) fn spot(
    geometry: &Geometry,
    position: DVec3,
    direction: DVec3,
    outer: f64,
) -> Option<ShadowProjection> {
    let forward = direction.try_normalize()?;
    let [nearest, farthest] = extent(corners(geometry).map(|p| (p - position).dot(forward)))?;
    let [near, far] = planes(nearest, farthest)?;
    if outer > WIDEST_SINGLE_MAP {
        return cube(geometry, position);
    }
    let half_angle = (outer.tan() * (1.0 + MARGIN)).atan();
    let view_from_world = view::look_to_mat4(position, forward, forward.any_orthonormal_vector());
    // Near and far swapped: reversed depth.
    let clip_from_view = directx::perspective(2.0 * half_angle, 1.0, far, near);
    Some(single(clip_from_view * view_from_world))
}

pub(super) fn cube(geometry: &Geometry, position: DVec3) -> Option<ShadowProjection> {
    let [_, farthest] = extent(corners(geometry).map(|p| (p - position).abs().max_element()))?;
    let bounds = geometry.bounds()?;
    let outside = position - position.clamp(bounds.min.as_dvec3(), bounds.max.as_dvec3());
    // Surfaces at this distance or farther are at least as deep as this along their face's axis.
    let nearest = outside.length() / 3_f64.sqrt();
    let [near, far] = planes(nearest, farthest)?;
    Some(ShadowProjection::Cube {
        near: near as f32,
        far: far as f32,
        reversed_depth: true,
    })
}

/// Near and far planes that enclose depths from `nearest` to `farthest`; `None` where all is behind the light.
fn planes(nearest: f64, farthest: f64) -> Option<[f64; 2]> {
    let far = farthest * (1.0 + MARGIN);
    (farthest > 0.0).then(|| [(nearest * (1.0 - MARGIN)).max(NEAR_OVER_FAR * far), far])
}
