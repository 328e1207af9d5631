//! glTF 2.0 and GLB files.
//!
//! What is read: the default scene (else the first one, else every root node) with its meshes (triangle lists, strips
//! and fans), materials, cameras, lights and the animations of its nodes. `KHR_lights_punctual`, `KHR_materials_transmission` (its factor),
//! `KHR_materials_emissive_strength`, `KHR_texture_transform` and `KHR_mesh_quantization` are understood; extensions
//! that change only how a surface reflects light are harmless, because every surface is a Lambert one.
//!
//! What is not: points and lines are skipped; vertex colours, emissive textures and the `range` of lights are
//! ignored; skins and morph targets stay in their rest pose, placed by the node that holds the mesh. A file that
//! *requires* another extension is refused, and so are animations that move something else than a node's transform
//! (`KHR_animation_pointer`) and scenes without a list of nodes, which the `gltf` crate does not parse.
//!
//! Whatever a used mesh, material or picture gets wrong is a [`LoadError`]; what the scene does not use is not read.

mod accessor;
mod animation;
mod buffers;
mod document;
mod material;
mod mesh;
mod nodes;

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::scene::Scene;
use {buffers::Buffers, mesh::Meshes};

/// Why a scene file could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not; not the error's `source`, for the message holds it.
        cause: std::io::Error,
    },
    /// The file breaks the format's rules.
    #[error("{}: {place}: {problem}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Where in the file, e.g. ``mesh 2 `pillar`, primitive 0``.
        place: String,
        /// What was expected and found.
        problem: String,
    },
    /// The file cannot be understood without extensions that are not supported.
    #[error("{}: requires glTF extensions that are not supported: {extensions}", path.display())]
    UnsupportedExtensions {
        /// The file.
        path: PathBuf,
        /// Their names, joined by commas.
        extensions: String,
    },
}

/// Loads a glTF 2.0 file, `.gltf` or `.glb` (told apart by content); other files it refers to are looked up beside it.
///
/// # Errors
/// [`LoadError`] where a file is missing or broken or requires an extension that is not supported.
pub fn load(path: &Path) -> Result<Scene, LoadError> {
    let bytes = fs::read(path).map_err(|cause| LoadError::Read {
        path: path.to_owned(),
        cause,
    })?;
    read(&bytes, path).map_err(|refusal| refusal.in_file(path))
}

fn read(bytes: &[u8], path: &Path) -> Result<Scene, Refusal> {
    let gltf = document::parse(bytes)?;
    let buffers = Buffers::new(&gltf.document, gltf.blob.as_deref(), path.parent());
    let mut meshes = Meshes::new(&gltf.document, &buffers);
    let (nodes, scene_node) = nodes::read(&gltf.document, |mesh| meshes.index_of(mesh))?;
    let animations = animation::read(&gltf.document, &buffers, &scene_node, &nodes)?;
    let (meshes, materials, textures) = meshes.into_parts();
    let mut scene = Scene {
        name: path
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        nodes,
        meshes,
        materials,
        textures,
        animations,
    };
    nodes::bound_cameras(&mut scene);
    Ok(scene)
}

/// Why a document is refused, before it is known which file it came from.
enum Refusal {
    Broken { place: String, problem: String },
    UnsupportedExtensions(String),
}

impl Refusal {
    /// Says in which part of the document the place is.
    fn within(self, part: &str) -> Self {
        match self {
            Self::Broken { place, problem } => broken(format!("{part}, {place}"), problem),
            other => other,
        }
    }

    fn in_file(self, path: &Path) -> LoadError {
        let path = path.to_owned();
        match self {
            Self::Broken { place, problem } => LoadError::Broken {
                path,
                place,
                problem,
            },
            Self::UnsupportedExtensions(extensions) => {
                LoadError::UnsupportedExtensions { path, extensions }
            }
        }
    }
}

fn broken(place: impl Into<String>, problem: impl Into<String>) -> Refusal {
    Refusal::Broken {
        place: place.into(),
        problem: problem.into(),
    }
}

/// How messages call a part of the document: ``mesh 2 `pillar` ``.
fn called(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {index} `{name}`"),
        None => format!("{kind} {index}"),
    }
}
