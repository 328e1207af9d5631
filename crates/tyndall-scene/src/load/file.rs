//! From a file to a scene.

use std::{fs, path::Path};

use super::{
    animation,
    buffers::Buffers,
    document,
    error::{LoadError, Refusal},
    mesh::Meshes,
    nodes, places,
};
use crate::scene::Scene;

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
    let (nodes, scene_node) = nodes::read(&gltf.document, &places::read(bytes), |mesh| {
        meshes.index_of(mesh)
    })?;
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
        ..Scene::default()
    };
    nodes::bound_cameras(&mut scene);
    Ok(scene)
}
