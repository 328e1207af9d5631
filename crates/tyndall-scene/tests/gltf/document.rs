//! Hand-made glTF files.

use std::path::PathBuf;

use gltf::binary::{Glb, Header};
use serde_json::{Value, json};
use tempfile::TempDir;
use tyndall_scene::{
    load::{LoadError, load},
    scene::Scene,
};

pub(crate) const U8: u32 = 5121;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

/// A document under construction, all of its data in one buffer.
pub(crate) struct Document {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl Document {
    /// One node per entry, all in one scene, and whatever `rest` says.
    pub(crate) fn new(nodes: Value, rest: Value) -> Self {
        let count = nodes.as_array().map_or(0, Vec::len);
        let mut json = json!({
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": (0..count).collect::<Vec<_>>()}],
            "nodes": nodes,
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        });
        merge(&mut json, rest);
        Self {
            json,
            bin: Vec::new(),
        }
    }

    /// One node with one mesh of one primitive: a triangle's or more vertices on the parabola y = x^2.
    pub(crate) fn with_primitive(vertices: usize, rest: Value) -> Self {
        let mut document = Self::new(json!([{"mesh": 0}]), rest);
        let positions: Vec<f32> = (0..vertices)
            .flat_map(|i| [i as f32, (i * i) as f32, 0.0])
            .collect();
        let accessor = document.accessor(F32, "VEC3", &floats(&positions), 12);
        document.json["meshes"] =
            json!([{"name": "pillar", "primitives": [{"attributes": {"POSITION": accessor}}]}]);
        document
    }

    pub(crate) fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// Appends a buffer view and gives its index.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend(bytes);
        push(&mut self.json["bufferViews"], view)
    }

    /// Appends an accessor of tightly packed elements of `size` bytes and gives its index.
    pub(crate) fn accessor(
        &mut self,
        component: u32,
        kind: &str,
        bytes: &[u8],
        size: usize,
    ) -> usize {
        let view = self.view(bytes);
        let accessor = json!({
            "bufferView": view, "componentType": component, "type": kind, "count": bytes.len() / size,
        });
        push(&mut self.json["accessors"], accessor)
    }

    /// The file, with the buffer in the BIN chunk.
    pub(crate) fn to_glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"] == json!([]) && !self.bin.is_empty() {
            json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        for key in ["accessors", "bufferViews", "buffers"] {
            if json[key].as_array().is_some_and(Vec::is_empty) {
                json.as_object_mut().unwrap().remove(key);
            }
        }
        Glb {
            header: Header {
                magic: *b"glTF",
                version: 2,
                length: 0,
            },
            json: serde_json::to_vec(&json).unwrap().into(),
            bin: (!self.bin.is_empty()).then(|| self.bin.as_slice().into()),
        }
        .to_vec()
        .unwrap()
    }

    pub(crate) fn load(&self) -> Result<Scene, LoadError> {
        Folder::new().load("scene.glb", &self.to_glb())
    }

    /// The message that refuses the file, without the file's name.
    pub(crate) fn refusal(&self) -> String {
        let error = self.load().unwrap_err().to_string();
        let (_, message) = error.split_once("scene.glb: ").unwrap();
        message.to_owned()
    }
}

/// A folder that vanishes.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    pub(crate) fn load(&self, name: &str, bytes: &[u8]) -> Result<Scene, LoadError> {
        load(&self.write(name, bytes))
    }
}

pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn push(array: &mut Value, value: Value) -> usize {
    let array = array.as_array_mut().unwrap();
    array.push(value);
    array.len() - 1
}

fn merge(into: &mut Value, from: Value) {
    if let Value::Object(from) = from {
        for (key, value) in from {
            into[key] = value;
        }
    }
}
