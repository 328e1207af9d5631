//! Movement of a shot's nodes, camera, lights and medium from frame to frame.

use std::sync::Arc;

use glam::{EulerRot, Quat, Vec3};
use tyndall::frame::{Camera, Medium};
use tyndall_scene::{
    geometry::Geometry,
    scene::{Node, Scene},
};

use super::{
    extent::swept,
    offset::{Offset, move_camera, move_light, move_node, scale_medium},
};
use crate::shot::{Animation, FrameRange, LightSpec, Move, MoveTarget, Problem, ShotError};

/// The movements of a shot, and the scene as they left it.
pub(super) struct Motion {
    keys: Keys,
    /// Encloses the scene in every frame, and so do the shadow maps of all that is seen: maps that stay in place don't crawl.
    extent: Geometry,
    /// The scene as the last frame left it.
    posed: Arc<Scene>,
}

/// The movements, and the frames that their keyframes are spread over.
struct Keys {
    animation: Animation,
    range: FrameRange,
}

impl Motion {
    /// Checks that what moves is there; `lights` are the shot's.
    pub(super) fn new(
        animation: Animation,
        range: FrameRange,
        rest: &Arc<Scene>,
        lights: &[LightSpec],
    ) -> Result<Self, ShotError> {
        for movement in &animation.moves {
            check_target(movement, rest, lights)?;
        }
        let keys = Keys { animation, range };
        Ok(Self {
            extent: swept(rest, range.frames(), |scene, frame| {
                keys.pose(scene, &rest.nodes, frame);
            }),
            keys,
            posed: Arc::clone(rest),
        })
    }

    pub(super) fn range(&self) -> FrameRange {
        self.keys.range
    }

    pub(super) fn extent(&self) -> &Geometry {
        &self.extent
    }

    /// The scene with its nodes where they are in a frame.
    pub(super) fn pose(&mut self, rest: &Arc<Scene>, frame: u32) -> Arc<Scene> {
        // Taken, so that it is copied only where somebody still holds the frame before.
        let mut scene = std::mem::replace(&mut self.posed, Arc::clone(rest));
        self.keys
            .pose(Arc::make_mut(&mut scene), &rest.nodes, frame);
        self.posed = Arc::clone(&scene);
        scene
    }

    /// Moves camera, lights and medium to where they are in a frame.
    pub(super) fn place(
        &self,
        frame: u32,
        camera: &mut Camera,
        lights: &mut [LightSpec],
        medium: &mut Medium,
    ) {
        for movement in &self.keys.animation.moves {
            let offset = self.keys.offset(movement, frame);
            match movement.target {
                MoveTarget::Node(_) => {}
                MoveTarget::Camera => move_camera(camera, &offset),
                MoveTarget::Light(index) => {
                    if let Some(light) = lights.get_mut(index) {
                        move_light(light, &offset);
                    }
                }
                MoveTarget::Medium => scale_medium(medium, offset.density),
            }
        }
    }
}

impl Keys {
    /// Puts the nodes where they are in a frame: the scene's own animations first, then the shot's.
    fn pose(&self, scene: &mut Scene, rest: &Vec<Node>, frame: u32) {
        scene.nodes.clone_from(rest);
        scene.pose(frame as f32 / self.animation.fps);
        for movement in &self.animation.moves {
            let offset = self.offset(movement, frame);
            if let MoveTarget::Node(name) = &movement.target {
                for node in scene.nodes.iter_mut().filter(|node| node.name == *name) {
                    move_node(node, &offset);
                }
            }
        }
    }

    fn offset(&self, movement: &Move, frame: u32) -> Offset {
        let share = self.range.progress(frame);
        let vector = |keys: &[[f32; 3]]| {
            let keys: Vec<Vec3> = keys.iter().map(|key| Vec3::from(*key)).collect();
            interpolate(&keys, share, |a, b, t| a.lerp(b, t)).unwrap_or_default()
        };
        let [x, y, z] = vector(&movement.rotate_deg).map(f32::to_radians).to_array();
        Offset {
            translation: vector(&movement.translate),
            rotation: Quat::from_euler(EulerRot::ZYX, z, y, x),
            density: interpolate(&movement.density, share, |a, b, t| a + (b - a) * t)
                .unwrap_or(1.0),
        }
    }
}

/// The value at `share` in [0, 1] of keys that are spread evenly; `None` without keys.
fn interpolate<T: Copy>(keys: &[T], share: f32, between: impl Fn(T, T, f32) -> T) -> Option<T> {
    let last = keys.len().checked_sub(1)?;
    let place = share * last as f32;
    let before = (place as usize).min(last);
    let after = (before + 1).min(last);
    Some(between(keys[before], keys[after], place - before as f32))
}

fn check_target(movement: &Move, scene: &Scene, lights: &[LightSpec]) -> Result<(), ShotError> {
    let (kind, found, names): (_, _, Vec<String>) = match &movement.target {
        MoveTarget::Camera | MoveTarget::Medium => return Ok(()),
        MoveTarget::Light(index) => {
            let names = (0..lights.len()).map(|i| format!("light.{i}")).collect();
            ("light", format!("light.{index}"), names)
        }
        MoveTarget::Node(name) => {
            let mut names: Vec<String> = scene.nodes.iter().map(|n| n.name.clone()).collect();
            names.retain(|name| !name.is_empty());
            names.sort();
            names.dedup();
            ("node", name.clone(), names)
        }
    };
    if names.contains(&found) {
        return Ok(());
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let problem = Problem::unknown_name(kind, &found, &names);
    Err(ShotError::new(movement.location.clone(), problem))
}
