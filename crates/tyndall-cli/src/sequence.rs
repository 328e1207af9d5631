//! Sequences: a shot whose nodes, camera, lights or medium move from frame to frame.
//!
//! A frame depends on its number alone, so that any of them can be rendered anywhere. The exception is a shot that does not
//! say which frames its keyframes are spread over: then it is those that are rendered.

use std::sync::{Arc, LazyLock};

use glam::{Affine3A, EulerRot, Quat, Vec3};
use tyndall::frame::{Camera, Emitter, Medium, TexturePlacement};
use tyndall_scene::{
    geometry::{Bounds, Geometry, world_from_nodes},
    scene::{Mesh, Node, Scene},
    trace::Tracer,
};

use crate::{
    failure::Failure,
    progress::Stages,
    setup::{LazyTracer, Setup, Source},
    shot::{Animation, FrameRange, LightSpec, Move, MoveTarget, Problem, Shot, ShotError},
};

/// A shot that is loaded, and how it moves.
pub struct Sequence {
    source: Source,
    animation: Animation,
    /// The frames that keyframes are spread over.
    range: FrameRange,
    /// What any frame's shadow maps enclose: maps that stay where they are don't crawl.
    extent: Geometry,
    /// The scene as the last frame left it.
    scene: Arc<Scene>,
}

impl Sequence {
    /// Loads what the shot names. Keyframes are spread over the shot's own range of frames, or over `rendered`.
    ///
    /// # Errors
    /// As for [`Setup::new`], and where the shot moves what isn't there.
    pub fn new(shot: &Shot, rendered: FrameRange, stages: &mut Stages) -> Result<Self, Failure> {
        let source = Source::new(shot, stages)?;
        let animation = shot.animation.clone().unwrap_or_default();
        let first = animation.frames.unwrap_or(rendered).first;
        let lights = source.moment(&source.scene, first)?.lights;
        for movement in &animation.moves {
            check_target(movement, &source.scene, &lights).map_err(Failure::input)?;
        }
        let mut sequence = Self {
            range: animation.frames.unwrap_or(rendered),
            extent: Geometry::default(),
            scene: Arc::clone(&source.scene),
            source,
            animation,
        };
        sequence.extent = sequence.swept();
        Ok(sequence)
    }

    /// The frames that keyframes are spread over.
    pub fn range(&self) -> FrameRange {
        self.range
    }

    /// Everything as it is in this frame.
    ///
    /// # Errors
    /// [`Failure::Input`] where a light's picture of this frame cannot be read.
    pub fn at(&mut self, frame: u32) -> Result<Setup, Failure> {
        // Taken, so that it is copied only where somebody still holds the frame before.
        let mut scene = std::mem::replace(&mut self.scene, Arc::clone(&self.source.scene));
        self.pose(Arc::make_mut(&mut scene), frame);
        self.scene = Arc::clone(&scene);
        let mut moment = self.source.moment(&scene, frame)?;
        for movement in &self.animation.moves {
            let offset = self.offset(movement, frame);
            match movement.target {
                MoveTarget::Node(_) => {}
                MoveTarget::Camera => move_camera(&mut moment.camera, &offset),
                MoveTarget::Light(index) => {
                    if let Some(light) = moment.lights.get_mut(index) {
                        move_light(light, &offset);
                    }
                }
                MoveTarget::Medium => scale_medium(&mut moment.medium, offset.density),
            }
        }
        let tracer = if is_still(&scene, &self.source.scene) {
            Arc::clone(&self.source.tracer)
        } else {
            let scene = Arc::clone(&scene);
            let lazy: LazyTracer = LazyLock::new(Box::new(move || Tracer::new(&scene)));
            Arc::new(lazy)
        };
        Ok(self.source.setup(scene, tracer, moment, &self.extent))
    }

    /// Puts the nodes where they are in a frame: the scene's own animations, then the shot's.
    fn pose(&self, scene: &mut Scene, frame: u32) {
        scene.nodes.clone_from(&self.source.scene.nodes);
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
        let progress = self.range.progress(frame);
        let vector = |keys: &[[f32; 3]]| {
            let keys: Vec<Vec3> = keys.iter().map(|key| Vec3::from(*key)).collect();
            interpolate(&keys, progress, |a, b, t| a.lerp(b, t)).unwrap_or_default()
        };
        let [x, y, z] = vector(&movement.rotate_deg).map(f32::to_radians).to_array();
        Offset {
            translation: vector(&movement.translate),
            rotation: Quat::from_euler(EulerRot::ZYX, z, y, x),
            density: interpolate(&movement.density, progress, |a, b, t| a + (b - a) * t)
                .unwrap_or(1.0),
        }
    }

    /// The triangles that stay where they are, and boxes round the others wherever they come.
    fn swept(&self) -> Geometry {
        let mut scene = Scene {
            nodes: self.source.scene.nodes.clone(),
            animations: self.source.scene.animations.clone(),
            ..Scene::default()
        };
        let mut places: Vec<Vec<Affine3A>> = vec![Vec::new(); scene.nodes.len()];
        for frame in self.range.frames() {
            self.pose(&mut scene, frame);
            for (places, place) in places.iter_mut().zip(world_from_nodes(&scene)) {
                if places.last() != Some(&place) {
                    places.push(place);
                }
            }
        }
        let mut swept = Geometry::default();
        let meshes = &self.source.scene.meshes;
        for (node, places) in scene.nodes.iter().zip(&places) {
            let Some(mesh) = node.mesh.and_then(|mesh| meshes.get(mesh)) else {
                continue;
            };
            match places[..] {
                [place] => swept.positions.extend(triangles(mesh, &place)),
                _ => swept.positions.extend(boxes(mesh, places)),
            }
        }
        swept
    }
}

/// How far something is from where it stands.
struct Offset {
    translation: Vec3,
    rotation: Quat,
    density: f32,
}

/// The value at `progress` in [0, 1] of keys that are spread evenly; `None` without keys.
fn interpolate<T: Copy>(keys: &[T], progress: f32, between: impl Fn(T, T, f32) -> T) -> Option<T> {
    let last = keys.len().checked_sub(1)?;
    let place = progress * last as f32;
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

fn is_still(scene: &Scene, rest: &Scene) -> bool {
    let places = |scene: &Scene| -> Vec<Affine3A> {
        scene
            .nodes
            .iter()
            .map(|node| node.parent_from_local)
            .collect()
    };
    places(scene) == places(rest)
}

fn move_node(node: &mut Node, offset: &Offset) {
    let place = &mut node.parent_from_local;
    place.matrix3 = glam::Mat3A::from_quat(offset.rotation) * place.matrix3;
    place.translation += glam::Vec3A::from(offset.translation);
}

fn move_camera(camera: &mut Camera, offset: &Offset) {
    shift(&mut camera.eye, offset);
    turn(&mut camera.forward, offset);
    turn(&mut camera.up, offset);
}

fn move_light(light: &mut LightSpec, offset: &Offset) {
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

fn scale_medium(medium: &mut Medium, factor: f32) {
    for component in &mut medium.components {
        component.sigma_s = component.sigma_s.map(|sigma| sigma * factor);
        component.sigma_a = component.sigma_a.map(|sigma| sigma * factor);
    }
}

fn triangles<'a>(mesh: &'a Mesh, place: &'a Affine3A) -> impl Iterator<Item = [Vec3; 3]> + 'a {
    mesh.primitives.iter().flat_map(move |primitive| {
        let corner = |i: u32| place.transform_point3(primitive.positions[i as usize]);
        let (triangles, _) = primitive.indices.as_chunks::<3>();
        triangles.iter().map(move |triangle| triangle.map(corner))
    })
}

/// The corners of a mesh's box at several places, as triangles that have them.
fn boxes(mesh: &Mesh, places: &[Affine3A]) -> Vec<[Vec3; 3]> {
    let points = mesh.primitives.iter().flat_map(|p| &p.positions).copied();
    let Some(Bounds { min, max }) = Bounds::of(points) else {
        return Vec::new();
    };
    let corner = |i: usize| {
        Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { max[k] } else { min[k] }))
    };
    let corners = |place: &Affine3A| -> Vec<[Vec3; 3]> {
        let triangle =
            |i: usize| [i, (i + 1) % 8, (i + 2) % 8].map(|i| place.transform_point3(corner(i)));
        (0..8).step_by(3).map(triangle).collect()
    };
    places.iter().flat_map(corners).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const SHOT: &str = r#"scene = "builtin:slats"
size = [8, 6]
[camera]
eye = [0, 1, 4]
target = [0, 1, 0]
[[light]]
type = "spot"
position = [0, 3, 0]
direction = [0, -1, 0]
intensity = [1, 1, 1]
inner = 0.1
outer = 0.4
[medium]
sigma_s = [0.1, 0.2, 0.3]
sigma_a = [0, 0, 0]
phase = { kind = "isotropic" }
[animation]
fps = 10
[[animation.move]]
node = "camera"
translate = [[0, 0, 0], [2, 0, 0], [2, 2, 0]]
rotate_deg = [[0, 0, 0], [0, 90, 0]]
[[animation.move]]
node = "light.0"
translate = [[0, 0, 0], [0, 0, 4]]
rotate_deg = [[0, 0, 0], [90, 0, 0]]
[[animation.move]]
node = "medium"
density = [1, 3]
"#;

    fn sequence(text: &str) -> Result<Sequence, String> {
        let shot = Shot::of_text(Path::new("shot.toml"), text, &[]).unwrap();
        let range = FrameRange { first: 0, last: 4 };
        Sequence::new(&shot, range, &mut Stages::default()).map_err(|failure| failure.to_string())
    }

    fn close(a: [f32; 3], b: [f32; 3]) -> bool {
        Vec3::from(a).abs_diff_eq(b.into(), 1e-5)
    }

    #[test]
    fn camera_light_and_medium_move_along_their_keys() {
        let mut sequence = sequence(SHOT).unwrap();
        for (frame, eye, forward, position, density) in [
            (0, [0.0, 1.0, 4.0], [0.0, 0.0, -4.0], [0.0, 3.0, 0.0], 1.0),
            (
                1,
                [1.0, 1.0, 4.0],
                [-1.530_734, 0.0, -3.695_518],
                [0.0, 3.0, 1.0],
                1.5,
            ),
            (
                2,
                [2.0, 1.0, 4.0],
                [-2.828_427, 0.0, -2.828_427],
                [0.0, 3.0, 2.0],
                2.0,
            ),
            (4, [2.0, 3.0, 4.0], [-4.0, 0.0, 0.0], [0.0, 3.0, 4.0], 3.0),
        ] {
            let Setup { frame: found, .. } = sequence.at(frame).unwrap();
            assert!(close(found.camera.eye, eye), "{frame}: {:?}", found.camera);
            assert!(
                close(found.camera.forward, forward),
                "{frame}: {:?}",
                found.camera
            );
            let Emitter::Spot { position: at, .. } = found.lights[0].emitter else {
                panic!("a spot");
            };
            assert!(close(at, position), "{frame}: {at:?}");
            let sigma_s = found.medium.components[0].sigma_s;
            assert!(
                close(sigma_s, [0.1, 0.2, 0.3].map(|x| x * density)),
                "{frame}"
            );
        }
        // Turned about x by 90 degrees, what pointed down points away from the viewer.
        let Emitter::Spot { direction, .. } = sequence.at(4).unwrap().frame.lights[0].emitter
        else {
            panic!("a spot");
        };
        assert!(close(direction, [0.0, 0.0, -1.0]), "{direction:?}");
    }

    #[test]
    fn nodes_move_and_frames_do_not_depend_on_each_other() {
        let name = tyndall_scene::builtin::builtin("slats").unwrap().nodes;
        let node = name.iter().find(|node| node.mesh.is_some()).unwrap();
        let moves = format!(
            "[animation]\nfps = 10\n[[animation.move]]\nnode = \"{}\"\ntranslate = [[0, 0, 0], [0, 8, 0]]\n",
            node.name
        );
        let (before, _) = SHOT.split_once("[animation]").unwrap();
        let text = format!("{before}{moves}");
        let mut forwards = sequence(&text).unwrap();
        let place = |setup: &Setup| {
            let moved = setup.scene.nodes.iter().find(|n| n.name == node.name);
            moved.unwrap().parent_from_local.translation
        };
        let first = forwards.at(0).unwrap();
        assert_eq!(place(&first), node.parent_from_local.translation);
        let third = forwards.at(2).unwrap();
        assert_eq!(place(&third).y, node.parent_from_local.translation.y + 4.0);
        assert_eq!(place(&first), node.parent_from_local.translation);
        // Maps stay, rays hit what moved.
        assert_eq!(first.frame.lights, third.frame.lights);
        let top = |setup: &Setup| setup.tracer.geometry().bounds().unwrap().max.y;
        assert!(top(&third) > top(&first) + 1.0);
        assert_eq!(top(&sequence(&text).unwrap().at(2).unwrap()), top(&third));
    }

    #[test]
    fn what_is_not_there_cannot_be_moved() {
        for (from, to, words) in [
            (
                "node = \"light.0\"",
                "node = \"light.7\"",
                "shot.toml:24: animation.move.1.node: no light is called \"light.7\": expected light.0",
            ),
            (
                "node = \"light.0\"",
                "node = \"dragon\"",
                "shot.toml:24: animation.move.1.node: no node is called \"dragon\": expected ",
            ),
        ] {
            let error = sequence(&SHOT.replacen(from, to, 1)).err().unwrap();
            assert!(error.starts_with(words), "{error}");
        }
    }
}
