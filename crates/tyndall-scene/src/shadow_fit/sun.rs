//! The map of a directional light.

use glam::{
    DVec2, DVec3,
    dcamera::rh::{proj::directx, view},
};
use tyndall::frame::ShadowProjection;

use super::{
    clip,
    parts::{MARGIN, corners, extent, single},
    plane::LightPlane,
    rectangle::{Rectangle, round_points},
    region,
    seen::{self, Seen},
};
use crate::geometry::Geometry;

/// The map's share of the whole scene's area above which the whole scene's map is as good: it never moves.
const WORTHWHILE: f64 = 0.5;

/// The map of the whole scene.
pub(super) fn whole(geometry: &Geometry, direction: DVec3) -> Option<ShadowProjection> {
    let plane = LightPlane::new(direction)?;
    plane.round(geometry, &plane.rectangle(geometry)?)
}

/// The map of what is seen, or of the whole scene where that is about as small.
pub(super) fn seen(
    geometry: &Geometry,
    direction: DVec3,
    seen: &Seen<'_>,
) -> Option<ShadowProjection> {
    let plane = LightPlane::new(direction)?;
    let whole = plane.rectangle(geometry)?;
    plane
        .of_seen(geometry, &whole, seen)
        .or_else(|| plane.round(geometry, &whole))
}

impl LightPlane {
    fn rectangle(&self, geometry: &Geometry) -> Option<Rectangle> {
        round_points(corners(geometry).map(|p| self.place(p)).collect())
    }

    /// The map round all of a scene, whose rectangle this is.
    fn round(&self, geometry: &Geometry, rectangle: &Rectangle) -> Option<ShadowProjection> {
        let [near, far] = extent(corners(geometry).map(|p| p.dot(self.forward)))?;
        // A flat scene still needs a box with a volume.
        let size = rectangle.half.max_element().max(far - near);
        let least = MARGIN * size.max(f64::MIN_POSITIVE.sqrt());
        let half = (rectangle.half * (1.0 + MARGIN)).max(DVec2::splat(least));
        let depth_margin = (MARGIN * (far - near)).max(least);
        let planes = [near - depth_margin, far + depth_margin];
        Some(self.projection(&Rectangle { half, ..*rectangle }, planes))
    }

    /// The map of the shadows that are seen; `None` where it is not much smaller than the `whole` scene's.
    fn of_seen(
        &self,
        geometry: &Geometry,
        whole: &Rectangle,
        seen: &Seen<'_>,
    ) -> Option<ShadowProjection> {
        let shadows = seen::shadows(seen, self, whole.axis);
        let part = region::rectangle(&shadows, whole)?;
        let area = |rectangle: &Rectangle| rectangle.half.element_product();
        if area(&part) > WORTHWHILE * area(whole) {
            return None;
        }
        // Before and behind the part there may be as much as there is elsewhere in the scene.
        let [near, far] = clip::depths(geometry, self, &part)?;
        let margin = MARGIN * (far - near).max(part.half.max_element());
        Some(self.projection(&part, [near - margin, far + margin]))
    }

    fn projection(&self, rectangle: &Rectangle, [near, far]: [f64; 2]) -> ShadowProjection {
        let world = |v: DVec2| v.x * self.x + v.y * self.y;
        let up = world(rectangle.axis.perp());
        let view_from_world = view::look_to_mat4(world(rectangle.center), self.forward, up);
        let half = rectangle.half;
        // Near and far swapped: reversed depth.
        let clip_from_view = directx::orthographic(-half.x, half.x, -half.y, half.y, far, near);
        single(clip_from_view * view_from_world)
    }
}
