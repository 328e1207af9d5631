//! From bytes to a document whose indices are valid.

use gltf::{
    Document, Gltf,
    json::{
        self,
        validation::{Error, Validate},
    },
};

use super::error::{Refusal, broken, called};

/// Extensions a file may require: those that are read, and those that a Lambert surface can do without.
const SUPPORTED_EXTENSIONS: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Bytes of the GLB header: magic, version, length.
const GLB_HEADER: usize = 12;

/// Most problems of a document that a message lists.
const LISTED_PROBLEMS: usize = 5;

/// Parses JSON or GLB. Every index in the result refers to something that exists, but for the `source` of textures
/// that only an extension gives one.
pub(super) fn parse(bytes: &[u8]) -> Result<Gltf, Refusal> {
    check_glb_length(bytes)?;
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(refusal)?;
    let mut root = document.into_json();
    check_version(&root)?;
    check_extensions(&mut root)?;
    check_attributes(&root)?;
    check_indices(&root)?;
    let document = Document::from_json_without_validation(root);
    Ok(Gltf { document, blob })
}

fn check_glb_length(bytes: &[u8]) -> Result<(), Refusal> {
    if !bytes.starts_with(b"glTF") {
        return Ok(());
    }
    let length = bytes
        .get(8..GLB_HEADER)
        .and_then(|length| length.try_into().ok())
        .map(u32::from_le_bytes)
        .ok_or_else(|| {
            let found = bytes.len();
            broken(
                "GLB header",
                format!("must have {GLB_HEADER} bytes, found {found}"),
            )
        })? as usize;
    if length < GLB_HEADER || length > bytes.len() {
        let found = bytes.len();
        return Err(broken(
            "GLB header",
            format!("says the file has {length} bytes, found {found}"),
        ));
    }
    Ok(())
}

fn check_version(root: &json::Root) -> Result<(), Refusal> {
    let asset = &root.asset;
    let needed = asset.min_version.as_ref().unwrap_or(&asset.version);
    let expected = if asset.min_version.is_some() {
        needed == "2.0"
    } else {
        needed.starts_with("2.")
    };
    if expected {
        Ok(())
    } else {
        Err(broken(
            "asset.version",
            format!("must be 2.0, found {needed}"),
        ))
    }
}

/// Takes over the check of required extensions: the `gltf` crate knows fewer than are understood here.
fn check_extensions(root: &mut json::Root) -> Result<(), Refusal> {
    let unsupported: Vec<String> = std::mem::take(&mut root.extensions_required)
        .into_iter()
        .filter(|name| !SUPPORTED_EXTENSIONS.contains(&name.as_str()))
        .collect();
    if unsupported.is_empty() {
        Ok(())
    } else {
        Err(Refusal::UnsupportedExtensions(unsupported.join(", ")))
    }
}

/// The `gltf` crate's validation takes these indices on trust.
fn check_attributes(root: &json::Root) -> Result<(), Refusal> {
    let count = root.accessors.len();
    for (index, mesh) in root.meshes.iter().enumerate() {
        let mut accessors = mesh.primitives.iter().flat_map(|p| p.attributes.values());
        if let Some(accessor) = accessors.find(|accessor| accessor.value() >= count) {
            let accessor = accessor.value();
            return Err(broken(
                called("mesh", index, mesh.name.as_deref()),
                format!("accessor {accessor} is out of range for {count} accessors"),
            ));
        }
    }
    Ok(())
}

/// The `gltf` crate's validation, but for refusals of things that glTF allows and nothing here relies on.
fn check_indices(root: &json::Root) -> Result<(), Refusal> {
    let mut problems = Vec::new();
    root.validate(root, json::Path::new, &mut |path, error| {
        let path = path();
        if error != Error::Missing || !may_be_missing(path.as_str()) {
            problems.push((path, error));
        }
    });
    if problems.is_empty() {
        Ok(())
    } else {
        Err(broken("JSON", problem_list(&problems)))
    }
}

/// Accessors without data are zeros, textures may come from an extension only, and a primitive may have no vertices.
fn may_be_missing(path: &str) -> bool {
    path.starts_with("accessors[") && path.ends_with("].bufferView")
        || path.starts_with("textures[") && path.ends_with("].source")
        || path.contains(r#".attributes["POSITION"]"#)
}

fn refusal(error: gltf::Error) -> Refusal {
    match error {
        gltf::Error::Deserialize(error) => broken("JSON", error.to_string()),
        gltf::Error::Binary(error) => broken("GLB", glb_problem(&error)),
        other => broken("file", other.to_string()),
    }
}

fn glb_problem(error: &gltf::binary::Error) -> String {
    use gltf::binary::Error as Glb;
    match error {
        Glb::Version(version) => format!("version must be 2, found {version}"),
        Glb::ChunkLength {
            ty,
            length,
            length_read,
        } => format!("{ty:?} chunk says it has {length} bytes, found {length_read}"),
        Glb::UnknownChunkType(name) => {
            format!("unknown chunk `{}`", String::from_utf8_lossy(name))
        }
        Glb::Io(_) => "ends within a chunk's header".to_owned(),
        other => other.to_string(),
    }
}

fn problem_list(problems: &[(json::Path, Error)]) -> String {
    let mut text = problems
        .iter()
        .take(LISTED_PROBLEMS)
        .map(|(path, error)| format!("`{path}`: {}", error.to_string().to_lowercase()))
        .collect::<Vec<_>>()
        .join("; ");
    if problems.len() > LISTED_PROBLEMS {
        let rest = problems.len() - LISTED_PROBLEMS;
        text.push_str(&format!("; and {rest} more"));
    }
    text
}
