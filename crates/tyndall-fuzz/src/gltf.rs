//! Any bytes as a scene file, up to a rendered picture.

use serde_json::Value;
use tyndall_cli::shot::Shot;

use crate::{
    folder::{folder, is_inside, render_small, with_file},
    outcome::Outcome,
};

/// Where the JSON of a GLB file begins.
const GLB_JSON: usize = 20;

/// Loads a `.gltf` or `.glb` file and renders it from the camera that it gets.
pub fn run(bytes: &[u8]) -> Outcome {
    if !refers_inside(bytes) {
        return Outcome::Refused;
    }
    let text = "scene = \"scene.glb\"\nsize = [6, 4]\n";
    with_file("scene.glb", bytes, |_| {
        match Shot::of_text(&folder().join("shot.toml"), text, &[]) {
            Ok(shot) => render_small(shot),
            Err(_) => Outcome::Refused,
        }
    })
}

/// True where no URI leaves the folder. What is no JSON gets as far as that and refers to nothing.
fn refers_inside(bytes: &[u8]) -> bool {
    let json = if bytes.starts_with(b"glTF") {
        let length = bytes.get(12..16).and_then(|n| n.try_into().ok());
        let end = length.map_or(0, u32::from_le_bytes) as usize;
        bytes
            .get(GLB_JSON..GLB_JSON.saturating_add(end))
            .unwrap_or_default()
    } else {
        bytes
    };
    serde_json::from_slice(json).map_or(true, |root: Value| uris_are_inside(&root))
}

fn uris_are_inside(value: &Value) -> bool {
    match value {
        Value::Object(fields) => fields.iter().all(|(key, value)| match value {
            Value::String(uri) if key == "uri" => {
                uri.starts_with("data:") || (!uri.contains('%') && is_inside(&folder().join(uri)))
            }
            other => uris_are_inside(other),
        }),
        Value::Array(values) => values.iter().all(uris_are_inside),
        _ => true,
    }
}
