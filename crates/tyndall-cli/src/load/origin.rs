//! The point that everything of a shot is relative to.

use glam::{DVec3, Vec3};
use tyndall::frame::{Camera, Projection};
use tyndall_scene::{
    framing,
    geometry::{Bounds, Geometry},
    scene::Scene,
};

use crate::shot::{CameraBase, Shot};

/// Least width of the cells that the origin moves by, in near planes. The eye is at most as far from the origin: single
/// precision is a thousandth of the near plane there, or finer.
const CELL_OF_NEAR: f64 = 16384.0;
/// The near plane of a shot without one, as a share of the scene's extent.
const NEAR_OF_EXTENT: f64 = 1e-4;

/// Moves the scene's origin near to the eye, so that single precision holds what is seen wherever the scene is. It is the corner of
/// a coarse grid: the zero point itself, unless the eye is far off.
pub(super) fn place_origin(shot: &Shot, scene: &mut Scene) {
    let camera = scene_camera(shot, scene);
    let eye = shot.camera.eye;
    let eye = eye.or(camera.map(|camera| Vec3::from(camera.eye).as_dvec3()));
    let near = shot.camera.near.or(camera.map(near_plane)).map(f64::from);
    let (eye, near) = match (eye, near) {
        (Some(eye), Some(near)) => (eye, near),
        (eye, near) => {
            let (center, extent) = center_and_extent(scene);
            (
                eye.unwrap_or(center),
                near.unwrap_or(NEAR_OF_EXTENT * extent),
            )
        }
    };
    scene.origin = snapped(eye, near);
}

/// The camera of the scene that the shot starts from, if there is one.
fn scene_camera(shot: &Shot, scene: &Scene) -> Option<Camera> {
    let cameras = framing::cameras(scene, 1.0);
    let mut cameras = cameras.into_iter();
    let found = match &shot.camera.base {
        CameraBase::Shot => None,
        CameraBase::Named(name) => cameras.find(|(found, _)| found == name),
        CameraBase::Scene => cameras.next(),
    };
    found.map(|(_, camera)| camera)
}

fn near_plane(camera: Camera) -> f32 {
    match camera.projection {
        Projection::Perspective { near, .. } => near,
        // Depth has no scale of its own there.
        Projection::Orthographic { half_extent, .. } => NEAR_OF_EXTENT as f32 * half_extent[1],
    }
}

/// The middle of the scene's triangles, and the longest side of the box round them \[m].
fn center_and_extent(scene: &mut Scene) -> (DVec3, f64) {
    let bounds = |scene: &Scene| Geometry::new(scene).bounds();
    let center = |bounds: Option<Bounds>| bounds.map_or(Vec3::ZERO, |b| b.center()).as_dvec3();
    scene.origin = center(bounds(scene));
    // Measured anew from nearby: the first box is as coarse as single precision is where the scene is.
    let near_by = bounds(scene);
    let extent = near_by.map_or(1.0, |bounds| bounds.extent().max_element());
    (scene.origin + center(near_by), extent.into())
}

/// The nearest corner of a grid whose cells are a power of two of metres wide.
fn snapped(eye: DVec3, near: f64) -> DVec3 {
    let cell = (near * CELL_OF_NEAR).log2().ceil().exp2();
    let corner = (eye / cell).round() * cell;
    if corner.is_finite() { corner } else { eye }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_origin_is_near_an_eye_far_off_and_zero_else() {
        for near in [5e-6, 0.05, 5e4] {
            let here = DVec3::new(0.3, -0.2, 0.1) * near * CELL_OF_NEAR;
            assert_eq!(snapped(here, near), DVec3::ZERO);
            let far = DVec3::new(1e7, -3.1e6, 5e5) * near * 20.0;
            let origin = snapped(far, near);
            let rounding = (far - origin).abs().max_element() * f64::from(f32::EPSILON);
            assert!(
                rounding < 2e-3 * near,
                "{near}: {origin} is {rounding} coarse"
            );
            // It stays where it is while the eye moves a little.
            assert_eq!(snapped(far + 10.0 * near, near), origin);
        }
        assert_eq!(snapped(DVec3::ONE, 0.0), DVec3::ONE);
    }
}
