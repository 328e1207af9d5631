//! Which light has which map.

use glam::DVec3;
use tyndall::frame::{Emitter, ShadowProjection};

use super::{local, seen::Seen, sun};
use crate::geometry::Geometry;

/// The projection of a light's shadow map for a scene.
///
/// - Directional: orthographic, the smallest rectangle round the scene as seen from the light, turned to fit;
///   near and far enclose the scene.
/// - Spot: perspective, just wider than the cone; a cube where the cone is wider than [`WIDEST_SINGLE_MAP`](super::WIDEST_SINGLE_MAP). Point: a cube.
///   The far plane is behind the farthest corner of a triangle; the near plane is in front of the scene's bounds, but no
///   closer than a ten thousandth of the far plane's distance.
/// - Rectangle: `None`, as for all lights that no surface can block.
pub fn fit(geometry: &Geometry, emitter: &Emitter) -> Option<ShadowProjection> {
    match *emitter {
        Emitter::Directional { direction, .. } => sun::whole(geometry, vector(direction)),
        Emitter::Spot {
            position,
            direction,
            outer,
            ..
        } => local::spot(
            geometry,
            vector(position),
            vector(direction),
            f64::from(outer),
        ),
        Emitter::Point { position, .. } => local::cube(geometry, vector(position)),
        Emitter::Rect { .. } => None,
    }
}

/// As [`fit`], but a directional light's map holds the shadows that the camera's rays pass and leaves out the rest of the
/// scene, where that at least halves the map's area.
///
/// `geometry` is all that may cast a shadow, `seen.tracer` has what is there now. Up to 4096 of the camera's rays are cast,
/// up to where they end, and the stretches of them that surfaces shade are found exactly; a caster whose shadow no ray
/// passes needs no place on the map. Shadows at the rim are left out as long as all of them together are below a thousandth
/// of the light that is seen, or of all shadows, whichever is less: those at the far edge of a great plain, say, through a
/// mile of fog. Outside its map a light is unblocked.
///
/// The map moves and grows in steps: it moves by whole texels, so that edges don't crawl as the camera moves, and it stays
/// where it is for a while, so that earlier frames can be reused.
pub fn fit_seen(
    geometry: &Geometry,
    emitter: &Emitter,
    seen: &Seen<'_>,
) -> Option<ShadowProjection> {
    match *emitter {
        Emitter::Directional { direction, .. } => sun::seen(geometry, vector(direction), seen),
        _ => fit(geometry, emitter),
    }
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}
