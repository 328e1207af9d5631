//! Projections of shadow maps that fit a scene.
//!
//! **Bias.** The map holds the surfaces' true depths. The medium looks them up as they are: a surface has no volume, so
//! there is no acne to fight. Surfaces are looked up at a point moved along their normal by
//! [`NORMAL_OFFSET_TEXELS`](crate::shading::NORMAL_OFFSET_TEXELS) texels, which clears the depth differences within the
//! filter's footprint at any slope; see [`shading`](crate::shading). No depth bias is added anywhere.
//!
//! **Depth** is reversed (1 at the near plane): floating-point depths are then about equally precise at all distances,
//! and a near plane close to the light costs nothing.

use glam::{
    DMat4, DVec2, DVec3,
    dcamera::rh::{proj::directx, view},
};
use tyndall::frame::{Emitter, ShadowProjection};

use crate::geometry::Geometry;

/// Space round the scene, relative to its size in the map: a texel of a map of 1024.
const MARGIN: f64 = 1.0 / 1024.0;

/// Smallest distance of the near plane, relative to the far plane's. Surfaces closer to the light cast no shadow.
const NEAR_OVER_FAR: f64 = 1e-4;

/// The projection of a light's shadow map for a scene.
///
/// - Directional: orthographic, the smallest rectangle round the scene as seen from the light, turned to fit;
///   near and far enclose the scene.
/// - Spot: perspective, just wider than the cone. Point: a cube. The far plane is behind the farthest corner of a
///   triangle; the near plane is in front of the scene's bounds, but no closer than a ten thousandth of the far plane's
///   distance.
/// - Rectangle: `None`, as for all lights that no surface can block.
pub fn fit(geometry: &Geometry, emitter: &Emitter) -> Option<ShadowProjection> {
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    match *emitter {
        Emitter::Directional { direction, .. } => directional(geometry, vector(direction)),
        Emitter::Spot {
            position,
            direction,
            outer,
            ..
        } => spot(
            geometry,
            vector(position),
            vector(direction),
            f64::from(outer),
        ),
        Emitter::Point { position, .. } => cube(geometry, vector(position)),
        Emitter::Rect { .. } => None,
    }
}

fn corners(geometry: &Geometry) -> impl Iterator<Item = DVec3> {
    geometry.positions.iter().flatten().map(|p| p.as_dvec3())
}

fn directional(geometry: &Geometry, direction: DVec3) -> Option<ShadowProjection> {
    let forward = direction.try_normalize()?;
    let (x, y) = forward.any_orthonormal_pair();
    let hull = convex_hull(
        corners(geometry)
            .map(|p| DVec2::new(p.dot(x), p.dot(y)))
            .collect(),
    );
    let rectangle = smallest_rectangle(&hull)?;
    let [near, far] = extent(corners(geometry).map(|p| p.dot(forward)))?;
    // A flat scene still needs a box with a volume.
    let size = rectangle.half.max_element().max(far - near);
    let least = MARGIN * size.max(f64::MIN_POSITIVE.sqrt());
    let half = (rectangle.half * (1.0 + MARGIN)).max(DVec2::splat(least));
    let depth_margin = (MARGIN * (far - near)).max(least);
    let [near, far] = [near - depth_margin, far + depth_margin];
    let world = |v: DVec2| v.x * x + v.y * y;
    let up = world(rectangle.axis.perp());
    let view_from_world = view::look_to_mat4(world(rectangle.center), forward, up);
    // Near and far swapped: reversed depth.
    let clip_from_view = directx::orthographic(-half.x, half.x, -half.y, half.y, far, near);
    Some(single(clip_from_view * view_from_world))
}

fn spot(
    geometry: &Geometry,
    position: DVec3,
    direction: DVec3,
    outer: f64,
) -> Option<ShadowProjection> {
    let forward = direction.try_normalize()?;
    let [nearest, farthest] = extent(corners(geometry).map(|p| (p - position).dot(forward)))?;
    let [near, far] = planes(nearest, farthest)?;
    let half_angle = (outer.tan() * (1.0 + MARGIN)).atan();
    let view_from_world = view::look_to_mat4(position, forward, forward.any_orthonormal_vector());
    // Near and far swapped: reversed depth.
    let clip_from_view = directx::perspective(2.0 * half_angle, 1.0, far, near);
    Some(single(clip_from_view * view_from_world))
}

fn cube(geometry: &Geometry, position: DVec3) -> Option<ShadowProjection> {
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

/// A rectangle in the plane.
struct Rectangle {
    center: DVec2,
    /// Unit vector along its first side.
    axis: DVec2,
    /// Half the sides' lengths.
    half: DVec2,
}

/// The rectangle of least area round a convex polygon: one of its sides lies on a side of the polygon
/// (Freeman & Shapira 1975).
fn smallest_rectangle(hull: &[DVec2]) -> Option<Rectangle> {
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

#[cfg(test)]
mod tests {
    use glam::{DVec4, Vec3, vec3};

    use super::*;
    use crate::test_scenes::{block, opaque, soup};

    fn sun(direction: [f32; 3]) -> Emitter {
        Emitter::Directional {
            direction,
            illuminance: [1.0; 3],
        }
    }

    fn clip(projection: &ShadowProjection, point: Vec3) -> DVec4 {
        let ShadowProjection::Single {
            clip_from_world, ..
        } = projection
        else {
            panic!("one map, found {projection:?}");
        };
        let matrix = DMat4::from_cols_array_2d(&clip_from_world.map(|c| c.map(f64::from)));
        let clip = matrix * point.as_dvec3().extend(1.0);
        (clip / clip.w).truncate().extend(clip.w)
    }

    #[test]
    fn a_sun_s_map_encloses_the_scene_and_touches_it_on_all_sides() {
        let geometry = Geometry::new(&opaque(&soup(300, 1)));
        for direction in [
            [0.0, -1.0, 0.0],
            [0.3, -0.9, 0.2],
            [-5.0, 0.0, 0.1],
            [0.0, 0.0, 1.0],
        ] {
            let projection = fit(&geometry, &sun(direction)).unwrap();
            let points = || {
                geometry
                    .positions
                    .iter()
                    .flatten()
                    .map(|&p| clip(&projection, p))
            };
            for axis in 0..2 {
                let [low, high] = extent(points().map(|c| c[axis])).unwrap();
                assert!((-1.0..-0.998).contains(&low) && (0.998..1.0).contains(&high));
            }
            let [low, high] = extent(points().map(|c| c.z)).unwrap();
            assert!((0.0..0.002).contains(&low) && (0.998..1.0).contains(&high));
            // The first surface that light meets is nearest: reversed depth falls along the light.
            let along =
                clip(&projection, 0.1 * Vec3::from(direction)).z - clip(&projection, Vec3::ZERO).z;
            assert!(along < 0.0);
        }
    }

    #[test]
    fn the_rectangle_turns_with_the_scene() {
        // A bar 10 long and 1 wide, diagonal to the axes: its box is 7.8 wide, its own rectangle 10 by 1.
        let bar: Vec<_> = block(vec3(-5.0, 0.0, -0.5), vec3(5.0, 0.1, 0.5))
            .iter()
            .map(|t| t.map(|p| glam::Quat::from_rotation_y(0.8) * p))
            .collect();
        let projection = fit(&Geometry::new(&opaque(&bar)), &sun([0.0, -1.0, 0.0])).unwrap();
        let ShadowProjection::Single {
            clip_from_world, ..
        } = projection
        else {
            panic!("one map, found {projection:?}");
        };
        // Area of the map: the clip square's over the determinant of the lateral rows.
        let rows = [0, 1].map(|r| DVec3::from([0, 1, 2].map(|c| f64::from(clip_from_world[c][r]))));
        let area = 4.0 / rows[0].cross(rows[1]).length();
        assert!((area / 10.0 - 1.0).abs() < 0.003, "area {area}");
    }

    #[test]
    fn a_spot_s_map_holds_its_cone_and_all_depths() {
        let geometry = Geometry::new(&opaque(&soup(300, 2)));
        for (position, outer) in [([0.0, 3.0, 0.0], 0.4), ([0.2, 0.1, 0.0], 1.2)] {
            let direction = vec3(0.3, -1.0, 0.2).normalize();
            let emitter = Emitter::Spot {
                position,
                direction: direction.into(),
                intensity: [1.0; 3],
                inner: 0.0,
                outer,
                radius: 0.0,
            };
            let projection = fit(&geometry, &emitter).unwrap();
            let side = direction.any_orthonormal_vector();
            for turn in 0..8 {
                let side = glam::Quat::from_axis_angle(direction, turn as f32) * side;
                let edge = Vec3::from(position) + direction + outer.tan() * side;
                let radius = clip(&projection, edge).truncate().truncate().length();
                assert!((0.998..1.0).contains(&radius), "radius {radius}");
            }
            for &point in geometry.positions.iter().flatten() {
                let clip = clip(&projection, point);
                // In front of the light by more than the near plane's share.
                if clip.w > 1e-3 {
                    assert!((0.0..=1.0).contains(&clip.z), "{point}: {clip}");
                }
            }
        }
    }

    #[test]
    fn a_point_s_cube_reaches_all_corners() {
        let geometry = Geometry::new(&opaque(&block(Vec3::ZERO, Vec3::ONE)));
        for (position, near_range, far) in [
            ([0.5, 0.5, 0.5], 4e-5..6e-5, 0.5),
            ([0.5, 3.0, 0.5], 1.15..1.1547, 3.0),
        ] {
            let emitter = Emitter::Point {
                position,
                intensity: [1.0; 3],
                radius: 0.0,
            };
            let Some(ShadowProjection::Cube {
                near,
                far: found,
                reversed_depth: true,
            }) = fit(&geometry, &emitter)
            else {
                panic!("a cube");
            };
            assert!(near_range.contains(&near), "near {near}");
            assert!((1.0..1.002).contains(&(found / far)), "far {found}");
        }
    }

    #[test]
    fn no_map_where_nothing_blocks() {
        let nothing = Geometry::default();
        let below = Geometry::new(&opaque(&block(Vec3::ZERO, Vec3::ONE)));
        let spot_upwards = Emitter::Spot {
            position: [0.0, 2.0, 0.0],
            direction: [0.0, 1.0, 0.0],
            intensity: [1.0; 3],
            inner: 0.1,
            outer: 0.2,
            radius: 0.0,
        };
        let lamp = Emitter::Point {
            position: [0.0; 3],
            intensity: [1.0; 3],
            radius: 0.0,
        };
        for (geometry, emitter) in [
            (&nothing, sun([0.0, -1.0, 0.0])),
            (&nothing, lamp),
            (&nothing, spot_upwards),
            (&below, spot_upwards),
        ] {
            assert_eq!(fit(geometry, &emitter), None, "{emitter:?}");
        }
    }

    #[test]
    fn flat_scenes_get_a_map_with_a_volume() {
        let flat = Geometry::new(&opaque(&[[Vec3::ZERO, Vec3::X, Vec3::Z]]));
        for direction in [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]] {
            let projection = fit(&flat, &sun(direction)).unwrap();
            let clip = clip(&projection, vec3(0.2, 0.0, 0.2));
            assert!(clip.is_finite() && clip.truncate().abs().max_element() < 1.0);
        }
    }
}
