//! Maps against what they have to hold.

mod seen;

use glam::{DMat4, DVec3, DVec4, Vec3, vec3};
use tyndall::frame::{Emitter, ShadowProjection};

use super::{WIDEST_SINGLE_MAP, fit, parts::extent};
use crate::{
    geometry::Geometry,
    test_scenes::{block, opaque, soup},
};

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

#[test]
fn a_spot_beyond_the_widest_single_map_has_a_cube() {
    let geometry = Geometry::new(&opaque(&soup(300, 2)));
    let spot = |outer| Emitter::Spot {
        position: [0.0, 3.0, 0.0],
        direction: [0.3, -1.0, 0.2],
        intensity: [1.0; 3],
        inner: 0.0,
        outer,
        radius: 0.0,
    };
    let narrow = WIDEST_SINGLE_MAP as f32 - 1e-3;
    for outer in [0.01, 1.0, narrow] {
        let projection = fit(&geometry, &spot(outer));
        assert!(matches!(projection, Some(ShadowProjection::Single { .. })));
    }
    let lamp = Emitter::Point {
        position: [0.0, 3.0, 0.0],
        intensity: [1.0; 3],
        radius: 0.0,
    };
    for outer in [
        WIDEST_SINGLE_MAP as f32 + 1e-3,
        1.5,
        std::f32::consts::FRAC_PI_2,
    ] {
        assert_eq!(fit(&geometry, &spot(outer)), fit(&geometry, &lamp));
    }
}
