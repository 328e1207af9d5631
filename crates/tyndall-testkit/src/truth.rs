//! The shared truth shots, where present: shot files, each with its in-scattered radiance, ray traced outside this project.

use crate::picture::{Picture, PictureReadError};
use std::path::{Path, PathBuf};

/// A shot file and the picture it must give.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TruthShot {
    /// The shot file's stem.
    pub name: String,
    /// The shot file.
    pub shot: PathBuf,
}

/// Why there are no truth shots.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TruthError {
    /// The folder is not there, or cannot be read.
    #[error("the shared truth shots cannot be read in {}: {source}", folder.display())]
    Folder {
        /// Where they should be.
        folder: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The folder has no shot in it, and nothing must not pass for a success.
    #[error("expected shot files in {}, found none", folder.display())]
    Empty {
        /// Where they should be.
        folder: PathBuf,
    },
}

impl TruthShot {
    /// In-scattered radiance [W/(m^2 sr)].
    ///
    /// # Errors
    /// Where the picture beside the shot cannot be read.
    pub fn in_scatter(&self) -> Result<Picture, PictureReadError> {
        Picture::read_exr(&self.shot.with_extension("inscatter.exr"))
    }
}

/// Where the shared truth shots are, beside the workspace; `None` where that folder is missing.
pub fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/truth");
    folder.canonicalize().ok()
}

/// The truth shots of a folder, by name.
///
/// # Errors
/// Where the folder cannot be read or holds no shot.
pub fn shots(folder: &Path) -> Result<Vec<TruthShot>, TruthError> {
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|source| TruthError::Folder {
        folder: folder.to_owned(),
        source,
    })?;
    let mut shots: Vec<_> = entries.iter().filter_map(|e| shot(&e.path())).collect();
    if shots.is_empty() {
        return Err(TruthError::Empty {
            folder: folder.to_owned(),
        });
    }
    shots.sort_unstable();
    Ok(shots)
}

fn shot(path: &Path) -> Option<TruthShot> {
    let is_shot = path.extension()? == "toml";
    is_shot.then_some(TruthShot {
        name: path.file_stem()?.to_string_lossy().into_owned(),
        shot: path.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shots_are_found_by_name() {
        let folder = tempfile::tempdir().unwrap();
        for file in ["b.toml", "a.toml", "a.inscatter.exr", "README.md"] {
            std::fs::write(folder.path().join(file), "").unwrap();
        }
        let shots = shots(folder.path()).unwrap();
        assert_eq!(
            shots.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(),
            ["a", "b"]
        );
        assert_eq!(shots[1].shot, folder.path().join("b.toml"));
    }

    #[test]
    fn an_empty_or_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(
            shots(folder.path()),
            Err(TruthError::Empty { .. })
        ));
        let missing = folder.path().join("missing");
        assert!(matches!(shots(&missing), Err(TruthError::Folder { .. })));
    }

    #[test]
    fn a_shot_without_its_picture_is_an_error_that_names_it() {
        let shot = TruthShot {
            name: "nowhere".to_owned(),
            shot: PathBuf::from("nowhere.toml"),
        };
        let message = shot.in_scatter().unwrap_err().to_string();
        assert!(message.contains("nowhere.inscatter.exr"), "{message}");
    }
}
