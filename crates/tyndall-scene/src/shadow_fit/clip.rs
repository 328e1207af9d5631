//! The part of triangles that a rectangle of a light's plane sees.

use glam::{DVec2, DVec3};

use super::{parts::extent, plane::LightPlane, rectangle::Rectangle};
use crate::geometry::Geometry;

/// The least and the greatest distance along the light of what lies over a rectangle; `None` where nothing does.
pub(super) fn depths(
    geometry: &Geometry,
    plane: &LightPlane,
    rectangle: &Rectangle,
) -> Option<[f64; 2]> {
    let center = rectangle.center;
    let middle = DVec2::new(
        center.dot(rectangle.axis),
        center.dot(rectangle.axis.perp()),
    );
    // Relative to the rectangle: across, up, and along the light.
    let place = |point: DVec3| {
        let across = (plane.along_axis(rectangle.axis, point) - middle) / rectangle.half;
        across.extend(point.dot(plane.forward))
    };
    let within = geometry.positions.iter().filter_map(|triangle| {
        let corners = triangle.map(|corner| place(corner.as_dvec3()));
        extent(clipped(corners).iter().map(|p| p.z))
    });
    extent(within.flatten())
}

/// The corners of the part of a triangle where |x| <= 1 and |y| <= 1 (Sutherland & Hodgman 1974).
fn clipped(triangle: [DVec3; 3]) -> Vec<DVec3> {
    let sides: [fn(DVec3) -> f64; 4] = [|p| 1.0 - p.x, |p| 1.0 + p.x, |p| 1.0 - p.y, |p| 1.0 + p.y];
    if sides
        .iter()
        .any(|side| triangle.iter().all(|p| side(*p) < 0.0))
    {
        return Vec::new();
    }
    sides.iter().fold(triangle.to_vec(), |polygon, side| {
        let next = polygon.iter().cycle().skip(1);
        let cut = |(&a, &b): (&DVec3, &DVec3)| {
            let (from, to) = (side(a), side(b));
            let crossing = (from * to < 0.0).then(|| a.lerp(b, from / (from - to)));
            [(from >= 0.0).then_some(a), crossing]
        };
        polygon.iter().zip(next).flat_map(cut).flatten().collect()
    })
}
