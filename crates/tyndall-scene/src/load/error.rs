//! Reasons to refuse a file.

use std::path::{Path, PathBuf};

/// Reason why a scene file could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The cause; not the error's `source`, for the message holds it.
        cause: std::io::Error,
    },
    /// The file breaks the format's rules.
    #[error("{}: {place}: {problem}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Part of the file, e.g. ``mesh 2 `pillar`, primitive 0``.
        place: String,
        /// The expected and the found value.
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

/// Reason to refuse a document, before its file is known.
pub(super) enum Refusal {
    Broken { place: String, problem: String },
    UnsupportedExtensions(String),
}

impl Refusal {
    /// Puts the part of the document before the place.
    pub(super) fn within(self, part: &str) -> Self {
        match self {
            Self::Broken { place, problem } => broken(format!("{part}, {place}"), problem),
            other => other,
        }
    }

    /// Names the file.
    pub(super) fn in_file(self, path: &Path) -> LoadError {
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

/// Refuses a document with a problem in a place.
pub(super) fn broken(place: impl Into<String>, problem: impl Into<String>) -> Refusal {
    Refusal::Broken {
        place: place.into(),
        problem: problem.into(),
    }
}

/// The name of a part of the document in messages: ``mesh 2 `pillar` ``.
pub(super) fn called(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {index} `{name}`"),
        None => format!("{kind} {index}"),
    }
}
