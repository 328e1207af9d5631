//! Sources of scenes.

use std::path::{Path, PathBuf};

/// A scene's origin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneSource {
    /// A glTF 2.0 file (`.gltf` or `.glb`).
    File(PathBuf),
    /// A built-in scene, by its name without `builtin:`.
    Builtin(String),
}

impl SceneSource {
    /// A scene file, or `builtin:NAME`, as it is given on the command line.
    pub fn of(path: &Path) -> Self {
        Self::within(&path.to_string_lossy(), Path::new(""))
    }

    pub(super) fn within(text: &str, folder: &Path) -> Self {
        match text.strip_prefix("builtin:") {
            Some(name) => Self::Builtin(name.to_owned()),
            None => Self::File(folder.join(text)),
        }
    }

    /// Default name of its pictures.
    pub fn name(&self) -> String {
        match self {
            Self::Builtin(name) => name.clone(),
            Self::File(path) => stem(path),
        }
    }
}

impl std::fmt::Display for SceneSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Builtin(name) => write!(f, "builtin:{name}"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// A file's name without its ending.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}
