//! A scene's own cameras and lights, in world space.

use glam::{Affine3A, Vec3};
use tyndall::frame::{Camera, DepthRange, Emitter, Projection};

use crate::{geometry::world_from_nodes, scene::Scene};

/// The scene's cameras with the names of their nodes. Their height of view is kept, their width follows from the
/// image's aspect ratio (width / height), as glTF 2.0, section 3.10, advises.
pub fn cameras(scene: &Scene, aspect: f32) -> Vec<(String, Camera)> {
    world_from_nodes(scene)
        .iter()
        .zip(&scene.nodes)
        .filter_map(|(world_from_node, node)| {
            let camera = placed_camera(node.camera?, world_from_node, aspect)?;
            Some((node.name.clone(), camera))
        })
        .collect()
}

/// The scene's lights with the names of their nodes.
pub fn lights(scene: &Scene) -> Vec<(String, Emitter)> {
    world_from_nodes(scene)
        .iter()
        .zip(&scene.nodes)
        .filter_map(|(world_from_node, node)| {
            Some((
                node.name.clone(),
                placed_light(node.light?, world_from_node)?,
            ))
        })
        .collect()
}

/// `None` where the node is scaled to nothing.
fn placed_camera(
    mut projection: Projection,
    world_from_node: &Affine3A,
    aspect: f32,
) -> Option<Camera> {
    let (Projection::Perspective { half_extent, .. }
    | Projection::Orthographic { half_extent, .. }) = &mut projection;
    half_extent[0] = half_extent[1] * aspect;
    Some(Camera {
        eye: world_from_node.translation.into(),
        forward: turned([0.0, 0.0, -1.0], world_from_node)?,
        up: turned([0.0, 1.0, 0.0], world_from_node)?,
        projection,
        depth_range: DepthRange::Reversed,
    })
}

/// Scale changes a light's position and a rectangle's size, neither its strength nor a lamp's radius.
fn placed_light(light: Emitter, world_from_node: &Affine3A) -> Option<Emitter> {
    let moved = |p: [f32; 3]| world_from_node.transform_point3(p.into()).to_array();
    let stretched = |v: [f32; 3]| world_from_node.transform_vector3(v.into()).to_array();
    Some(match light {
        Emitter::Directional {
            direction,
            illuminance,
        } => Emitter::Directional {
            direction: turned(direction, world_from_node)?,
            illuminance,
        },
        Emitter::Point {
            position,
            intensity,
            radius,
        } => Emitter::Point {
            position: moved(position),
            intensity,
            radius,
        },
        Emitter::Spot {
            position,
            direction,
            intensity,
            inner,
            outer,
            radius,
        } => Emitter::Spot {
            position: moved(position),
            direction: turned(direction, world_from_node)?,
            intensity,
            inner,
            outer,
            radius,
        },
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            samples,
        } => Emitter::Rect {
            center: moved(center),
            edge_x: stretched(edge_x),
            edge_y: stretched(edge_y),
            radiance,
            samples,
        },
    })
}

fn turned(direction: [f32; 3], world_from_node: &Affine3A) -> Option<[f32; 3]> {
    world_from_node
        .transform_vector3(Vec3::from(direction))
        .try_normalize()
        .map(Into::into)
}
