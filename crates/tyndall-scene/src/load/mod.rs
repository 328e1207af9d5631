//! glTF 2.0 and GLB files.
//!
//! The loader reads the default scene (else the first one, else every root node) with its meshes (triangle lists, strips
//! and fans), materials, cameras, lights and the animations of its nodes. `KHR_lights_punctual`,
//! `KHR_materials_transmission` (its factor), `KHR_materials_emissive_strength`, `KHR_texture_transform` and
//! `KHR_mesh_quantization` are understood; extensions that change only how a surface reflects light are harmless, because
//! every surface is a Lambert one.
//!
//! Points and lines are skipped; vertex colours, emissive textures and the `range` of lights are
//! ignored; skins and morph targets stay in their rest pose, placed by the node that holds the mesh. A file that
//! *requires* another extension is refused, and so are animations that move something else than a node's transform
//! (`KHR_animation_pointer`) and scenes without a list of nodes, which the `gltf` crate does not parse.
//!
//! Any mistake in a used mesh, material or image is a [`LoadError`]; unused ones are not read.

mod accessor;
mod animation;
mod buffers;
mod document;
mod error;
mod file;
mod material;
mod mesh;
mod nodes;
mod places;

pub use error::LoadError;
pub use file::load;
