//! A scene as data: nodes, meshes, materials, pictures, cameras and lights, whatever they came from.

use glam::{Affine3A, Vec2, Vec3};
use tyndall::frame::{Emitter, Projection};

use crate::animation::NodeAnimation;

/// A scene. Everything refers to everything else by index; all indices are valid (the loaders check them).
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// What it is called: the file's name or `builtin:...`.
    pub name: String,
    /// Its nodes; a node's parent comes before it.
    pub nodes: Vec<Node>,
    /// Its meshes, in their own space.
    pub meshes: Vec<Mesh>,
    /// Its materials.
    pub materials: Vec<Material>,
    /// Its pictures.
    pub textures: Vec<Texture>,
    /// The movements of its nodes, at most one entry a node; all are at rest until [`Scene::pose`] moves them.
    pub animations: Vec<NodeAnimation>,
}

impl Scene {
    /// Moves the animated nodes to where they are at a time [s] since the animations began.
    pub fn pose(&mut self, seconds: f32) {
        for animation in &self.animations {
            if let Some(node) = self.nodes.get_mut(animation.node) {
                node.parent_from_local = animation.at(seconds).into();
            }
        }
    }
}

/// A node of the hierarchy: a place, and what is there.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its name, for animation; may be empty.
    pub name: String,
    /// Index of its parent.
    pub parent: Option<usize>,
    /// Its place relative to its parent.
    pub parent_from_local: Affine3A,
    /// Index of its mesh.
    pub mesh: Option<usize>,
    /// Its camera, looking along its own -Z with +Y up. The aspect ratio is in the half extents.
    pub camera: Option<Projection>,
    /// Its light, in the node's own space (directions along -Z, positions at the origin).
    pub light: Option<Emitter>,
}

/// Triangles, grouped by material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Its parts.
    pub primitives: Vec<Primitive>,
}

/// Triangles of one material. All attribute arrays are equally long; all values are finite.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Positions in mesh space [m].
    pub positions: Vec<Vec3>,
    /// Unit normals in mesh space (made from the triangles where the source has none).
    pub normals: Vec<Vec3>,
    /// Texture coordinates after the material's texture transform, (0, 0) at the picture's top left (zeros where the source has none).
    pub uvs: Vec<Vec2>,
    /// Three a triangle, each < `positions.len()`.
    pub indices: Vec<u32>,
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// A Lambert surface, and what it does to light that meets it.
#[derive(Clone, Debug)]
pub struct Material {
    /// Linear RGBA, multiplied into the texture.
    pub base_color: [f32; 4],
    /// Index into [`Scene::textures`].
    pub base_color_texture: Option<usize>,
    /// Whether light and camera rays stop here.
    pub blocking: Blocking,
    /// Radiance it gives off by itself [W/(m^2 sr)].
    pub emissive: [f32; 3],
}

/// What a surface does to light that meets it, from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blocking {
    /// Blocks.
    Opaque,
    /// Blocks where the alpha of base colour times texture is at least `cutoff` (alphaMode MASK).
    Masked {
        /// Smallest alpha that blocks.
        cutoff: f32,
    },
    /// Blocks nothing; light is multiplied by `transmission` * base colour (KHR_materials_transmission).
    Transmissive {
        /// transmissionFactor.
        transmission: f32,
    },
    /// Blocks nothing; light is multiplied by 1 - alpha + alpha * base colour (alphaMode BLEND).
    Blended,
}

/// A picture, sampled bilinearly with mip levels.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width and height [texels], both > 0.
    pub size: [u32; 2],
    /// sRGB-encoded RGB and linear alpha, row by row from the top left.
    pub texels: Vec<[u8; 4]>,
    /// Horizontal and vertical wrapping.
    pub wrap: [Wrap; 2],
}

/// What is beyond a picture's border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    Repeat,
    /// The picture again, mirrored.
    MirroredRepeat,
    /// Its border.
    ClampToEdge,
}
