//! Projections of shadow maps that fit a scene, or what a camera sees of it.
//!
//! **Bias.** A texel holds the least distance from the light of the plane that its centre meets, within the texel: the depth of
//! the centre, and half a texel's slope towards the light. What a surface hides from the light is dark then right up to it; the
//! centre's own depth would let light through between the steps of a slanted wall, into closed rooms. In exchange up to as
//! much before a lit surface is dark. Surfaces are looked up at a point moved along their normal, which clears the depth
//! differences within the filter's footprint at any slope; see [`shading`](crate::shading).
//!
//! **Depth** is reversed (1 at the near plane): floating-point depths are then about equally precise at all distances,
//! and a near plane close to the light costs nothing.
//!
//! | file | what |
//! |---|---|
//! | `sun` | the map of a directional light |
//! | `rectangle` | the smallest rectangle round points |
//! | `seen` | the shadows that view rays pass |
//! | `region` | the rectangle that such shadows need |
//! | `clip` | the part of triangles in a rectangle |
//! | `local` | maps of lights that have a position |

mod clip;
mod local;
mod rectangle;
mod region;
mod seen;
mod sun;

#[cfg(test)]
mod tests;

use glam::{DMat4, DVec3};
use tyndall::frame::{Camera, Emitter, Medium, ShadowProjection};

use crate::{geometry::Geometry, trace::Tracer};

/// Space round the scene, relative to its size in the map: a texel of a map of 1024.
const MARGIN: f64 = 1.0 / 1024.0;

/// A camera in its scene and medium, as far as a light's map depends on it.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The scene's surfaces, where they are now.
    pub tracer: &'a Tracer,
    /// The camera.
    pub camera: &'a Camera,
    /// The medium that its rays pass.
    pub medium: &'a Medium,
    /// Width and height of its image \[pixels].
    pub size: [u32; 2],
}

/// The projection of a light's shadow map for a scene.
///
/// - Directional: orthographic, the smallest rectangle round the scene as seen from the light, turned to fit;
///   near and far enclose the scene.
/// - Spot: perspective, just wider than the cone; a cube where the cone is wider than [`WIDEST_SINGLE_MAP`]. Point: a cube.
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

pub use local::WIDEST_SINGLE_MAP;

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

fn corners(geometry: &Geometry) -> impl Iterator<Item = DVec3> {
    geometry.positions.iter().flatten().map(|p| p.as_dvec3())
}

fn single(clip_from_world: DMat4) -> ShadowProjection {
    ShadowProjection::Single {
        clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
        reversed_depth: true,
    }
}

/// The smallest and the largest of some numbers.
fn extent(numbers: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    numbers
        .map(|x| [x, x])
        .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}
