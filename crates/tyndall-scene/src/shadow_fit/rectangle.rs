//! The smallest rectangle round points of a plane.

use glam::DVec2;

use super::parts::extent;

/// The corners of the convex hull, anticlockwise (Andrew 1979, monotone chain).
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let chain = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for &point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        // The last point begins the other chain.
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter());
    hull.extend(chain(&mut points.iter().rev()));
    hull
}

/// The smallest rectangle round points.
pub(super) fn round_points(points: Vec<DVec2>) -> Option<Rectangle> {
    round_polygon(&convex_hull(points))
}

/// A rectangle in the plane.
pub(super) struct Rectangle {
    pub(super) center: DVec2,
    /// Unit vector along its first side.
    pub(super) axis: DVec2,
    /// Half the sides' lengths.
    pub(super) half: DVec2,
}

/// The rectangle of least area round a convex polygon: one of its sides lies on a side of the polygon
/// (Freeman & Shapira 1975).
fn round_polygon(hull: &[DVec2]) -> Option<Rectangle> {
    let sides = hull
        .iter()
        .zip(hull.iter().cycle().skip(1))
        .map(|(a, b)| b - a);
    sides
        .map(|side| side.normalize_or(DVec2::X))
        .filter_map(|axis| {
            let [x0, x1] = extent(hull.iter().map(|p| p.dot(axis)))?;
            let [y0, y1] = extent(hull.iter().map(|p| p.dot(axis.perp())))?;
            Some(Rectangle {
                center: 0.5 * ((x0 + x1) * axis + (y0 + y1) * axis.perp()),
                axis,
                half: 0.5 * DVec2::new(x1 - x0, y1 - y0),
            })
        })
        .min_by(|a, b| {
            a.half
                .element_product()
                .total_cmp(&b.half.element_product())
        })
}
