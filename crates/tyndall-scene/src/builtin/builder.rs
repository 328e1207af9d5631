//! Puts scenes together.

use glam::{Affine3A, Mat3, Vec3};
use tyndall::frame::{Emitter, Projection};

use super::triangles::Triangles;
use crate::scene::{Blocking, Material, Mesh, Node, Scene, Texture};

/// Width / height of the cameras.
const ASPECT: f32 = 4.0 / 3.0;

/// A scene under construction.
#[derive(Default)]
pub(super) struct SceneBuilder {
    scene: Scene,
}

impl SceneBuilder {
    pub(super) fn texture(&mut self, texture: Texture) -> usize {
        self.scene.textures.push(texture);
        self.scene.textures.len() - 1
    }

    /// A surface of one colour.
    pub(super) fn plain(&mut self, [r, g, b]: [f32; 3]) -> usize {
        self.material(Material {
            base_color: [r, g, b, 1.0],
            base_color_texture: None,
            blocking: Blocking::Opaque,
            emissive: [0.0; 3],
        })
    }

    /// A surface with a texture.
    pub(super) fn textured(&mut self, texture: usize, blocking: Blocking) -> usize {
        self.material(Material {
            base_color: [1.0; 4],
            base_color_texture: Some(texture),
            blocking,
            emissive: [0.0; 3],
        })
    }

    fn material(&mut self, material: Material) -> usize {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    /// A mesh of parts, each with its material; shown where a node shows it.
    pub(super) fn mesh(&mut self, parts: impl IntoIterator<Item = (usize, Triangles)>) -> usize {
        let primitives = parts
            .into_iter()
            .map(|(material, triangles)| triangles.into_primitive(material))
            .collect();
        self.scene.meshes.push(Mesh { primitives });
        self.scene.meshes.len() - 1
    }

    pub(super) fn instance(&mut self, name: &str, mesh: usize, world_from_mesh: Affine3A) {
        self.scene.nodes.push(Node {
            mesh: Some(mesh),
            ..place(name, world_from_mesh)
        });
    }

    /// A perspective camera with a vertical field of view in degrees and a near and a far plane.
    pub(super) fn camera(&mut self, eye: Vec3, target: Vec3, yfov: f32, [near, far]: [f32; 2]) {
        let tangent = (0.5 * yfov.to_radians()).tan();
        self.scene.nodes.push(Node {
            camera: Some(Projection::Perspective {
                half_extent: [tangent * ASPECT, tangent],
                center: [0.0; 2],
                near,
                far,
            }),
            ..place("camera", world_from_view(eye, target - eye))
        });
    }

    pub(super) fn sun(&mut self, direction: Vec3, illuminance: [f32; 3]) {
        self.scene.nodes.push(Node {
            light: Some(Emitter::Directional {
                direction: [0.0, 0.0, -1.0],
                illuminance,
            }),
            ..place("sun", world_from_view(Vec3::ZERO, direction))
        });
    }

    pub(super) fn finish(self) -> Scene {
        self.scene
    }
}

/// A node with nothing there yet.
fn place(name: &str, parent_from_local: Affine3A) -> Node {
    Node {
        name: name.to_owned(),
        parent: None,
        parent_from_local: parent_from_local.as_daffine3(),
        mesh: None,
        camera: None,
        light: None,
    }
}

/// A place that looks along `direction` with its -Z, upright.
fn world_from_view(eye: Vec3, direction: Vec3) -> Affine3A {
    let backward = -direction.normalize();
    let right = Vec3::Y.cross(backward).normalize();
    let axes = Mat3::from_cols(right, backward.cross(right), backward);
    Affine3A::from_mat3_translation(axes, eye)
}
