//! Offsets of things from their places at rest.

use glam::{DMat3, Quat, Vec3};
use tyndall::frame::{Camera, Emitter, Medium, TexturePlacement};
use tyndall_scene::scene::Node;

use crate::shot::LightSpec;

/// The distance of a thing from its place at rest.
pub(super) struct Offset {
    pub(super) translation: Vec3,
    pub(super) rotation: Quat,
    /// Factor of the medium's coefficients.
    pub(super) density: f32,
}

pub(super) fn move_node(node: &mut Node, offset: &Offset) {
    let place = &mut node.parent_from_local;
    place.matrix3 = DMat3::from_quat(offset.rotation.as_dquat()) * place.matrix3;
    place.translation += offset.translation.as_dvec3();
}

pub(super) fn move_camera(camera: &mut Camera, offset: &Offset) {
    shift(&mut camera.eye, offset);
    turn(&mut camera.forward, offset);
    turn(&mut camera.up, offset);
}

pub(super) fn move_light(light: &mut LightSpec, offset: &Offset) {
    match &mut light.emitter {
        Emitter::Directional { direction, .. } => turn(direction, offset),
        Emitter::Point { position, .. } => shift(position, offset),
        Emitter::Spot {
            position,
            direction,
            ..
        } => {
            shift(position, offset);
            turn(direction, offset);
        }
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            ..
        } => {
            shift(center, offset);
            turn(edge_x, offset);
            turn(edge_y, offset);
        }
    }
    match light.texture.as_mut().map(|texture| &mut texture.placement) {
        Some(TexturePlacement::Parallelogram {
            center,
            edge_x,
            edge_y,
        }) => {
            shift(center, offset);
            turn(edge_x, offset);
            turn(edge_y, offset);
        }
        Some(TexturePlacement::Cone { up }) => turn(up, offset),
        Some(TexturePlacement::Sphere { up, forward }) => {
            turn(up, offset);
            turn(forward, offset);
        }
        Some(TexturePlacement::Rectangle) | None => {}
    }
}

fn shift(position: &mut [f32; 3], offset: &Offset) {
    *position = (Vec3::from(*position) + offset.translation).into();
}

fn turn(direction: &mut [f32; 3], offset: &Offset) {
    *direction = (offset.rotation * Vec3::from(*direction)).into();
}

pub(super) fn scale_medium(medium: &mut Medium, factor: f32) {
    for component in &mut medium.components {
        component.sigma_s = component.sigma_s.map(|sigma| sigma * factor);
        component.sigma_a = component.sigma_a.map(|sigma| sigma * factor);
    }
}
