//! A scene as data: nodes, meshes, materials, textures, cameras and lights, from any source.

use glam::{DAffine3, DVec3, Vec2, Vec3};
use tyndall::frame::{Emitter, Projection};

use crate::animation::NodeAnimation;

/// A scene. Everything refers to everything else by index; all indices are valid (the loaders check them).
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The name: the file's, or `builtin:...`.
    pub name: String,
    /// The point of the nodes' space that is the origin of world space: everything made of a scene, in single precision, is
    /// relative to it. Near the eye it keeps small what is seen, wherever in the nodes' space that is \[m].
    pub origin: DVec3,
    /// The nodes; a node's parent comes before it.
    pub nodes: Vec<Node>,
    /// The meshes, in their own space.
    pub meshes: Vec<Mesh>,
    /// The materials.
    pub materials: Vec<Material>,
    /// The textures.
    pub textures: Vec<Texture>,
    /// The movements of the nodes, at most one entry a node; all are at rest until [`Scene::pose`] moves them.
    pub animations: Vec<NodeAnimation>,
}

impl Scene {
    /// Moves the animated nodes to where they are at a time \[s] since the animations began.
    pub fn pose(&mut self, seconds: f32) {
        for animation in &self.animations {
            if let Some(node) = self.nodes.get_mut(animation.node) {
                node.parent_from_local = animation.at(seconds).into();
            }
        }
    }
}

/// A node of the hierarchy: a place with a mesh, a camera or a light.
#[derive(Clone, Debug)]
pub struct Node {
    /// The name, for animation; may be empty.
    pub name: String,
    /// Index of the parent.
    pub parent: Option<usize>,
    /// The place relative to the parent.
    pub parent_from_local: DAffine3,
    /// Index into [`Scene::meshes`].
    pub mesh: Option<usize>,
    /// A camera, looking along its own -Z with +Y up. The aspect ratio is in the half extents.
    pub camera: Option<Projection>,
    /// A light, in the node's own space (directions along -Z, positions at the origin).
    pub light: Option<Emitter>,
}

/// Triangles, grouped by material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// One part a material.
    pub primitives: Vec<Primitive>,
}

/// Triangles of one material. All attribute arrays are equally long; all values are finite.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Positions in mesh space \[m].
    pub positions: Vec<Vec3>,
    /// Unit normals in mesh space (made from the triangles where the source has none).
    pub normals: Vec<Vec3>,
    /// Texture coordinates after the material's texture transform, (0, 0) at the texture's top left (zeros where the source
    /// has none).
    pub uvs: Vec<Vec2>,
    /// Three indices a triangle, each < `positions.len()`.
    pub indices: Vec<u32>,
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// A Lambert surface that blocks light or lets it pass.
#[derive(Clone, Debug)]
pub struct Material {
    /// Linear RGBA, multiplied into the texture.
    pub base_color: [f32; 4],
    /// Index into [`Scene::textures`].
    pub base_color_texture: Option<usize>,
    /// Effect on light and camera rays that meet the surface.
    pub blocking: Blocking,
    /// Emitted radiance [W/(m^2 sr)].
    pub emissive: [f32; 3],
}

/// Effect of a surface on light that meets it, from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blocking {
    /// Blocks all light.
    Opaque,
    /// Blocks light if the alpha of base colour times texture is at least `cutoff` (alphaMode MASK).
    Masked {
        /// Smallest alpha that blocks.
        cutoff: f32,
    },
    /// Blocks nothing; light is multiplied by `transmission` * base colour (KHR_materials_transmission).
    Transmissive {
        /// glTF's `transmissionFactor`.
        transmission: f32,
    },
    /// Blocks nothing; light is multiplied by 1 - alpha + alpha * base colour (alphaMode BLEND).
    Blended,
}

/// A texture, sampled bilinearly with mip levels.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width and height \[texels], both > 0.
    pub size: [u32; 2],
    /// sRGB-encoded RGB and linear alpha, row by row from the top left.
    pub texels: Vec<[u8; 4]>,
    /// Horizontal and vertical wrapping.
    pub wrap: [Wrap; 2],
}

/// Continuation of a texture beyond its border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The texture again.
    Repeat,
    /// The texture again, mirrored.
    MirroredRepeat,
    /// The border's texels.
    ClampToEdge,
}
