//! Places of nodes in double precision: the `gltf` crate rounds them, which moves what is far from the origin.

use gltf::{binary::Glb, json::deserialize};
use serde::Deserialize;

/// A node's place as the file says it; what it leaves out is `None`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(super) struct FilePlace {
    /// Translation relative to the parent \[m].
    pub(super) translation: Option<[f64; 3]>,
    /// Columns of parent_from_local.
    pub(super) matrix: Option<[f64; 16]>,
}

#[derive(Deserialize)]
struct FilePlaces {
    #[serde(default)]
    nodes: Vec<FilePlace>,
}

/// The places of a document's nodes, by index. The document, JSON or GLB, has been parsed: where it can't be, there are none.
pub(super) fn read(bytes: &[u8]) -> Vec<FilePlace> {
    let glb = Glb::from_slice(bytes);
    let json = glb.as_ref().map_or(bytes, |glb| &glb.json);
    let places: Result<FilePlaces, _> = deserialize::from_slice(json);
    places.map(|places| places.nodes).unwrap_or_default()
}
