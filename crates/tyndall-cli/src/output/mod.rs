//! Output files: what they hold by their ending, written whole or not at all.

mod exr;
mod pattern;
mod png;

use std::{
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

use crate::layer::{Layer, Layers};

pub use pattern::{Pattern, PatternError};

/// What a file holds, by its ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB: one layer; light is exposed and tone-mapped, transmittance is encoded as it is.
    Png,
    /// Linear 32-bit floats: one layer as R, G, B, several as named layers (`inscatter.R` ...).
    Exr,
}

/// What an output file cannot be.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// The ending is none we write.
    #[error("cannot write {}: expected a name that ends in .png or .exr", .0.display())]
    Ending(PathBuf),
    /// A PNG can hold only one layer.
    #[error("a .png holds one layer, found {found}: write an .exr")]
    SeveralLayers {
        /// How many were asked for.
        found: usize,
    },
    /// Distances have no place in a PNG.
    #[error("a .png cannot hold depth in metres: write an .exr")]
    Depth,
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// Its folder is missing.
    #[error("cannot write {}: the folder {} does not exist", file.display(), folder.display())]
    NoFolder {
        /// The file.
        file: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// The system refused.
    #[error("cannot write {}: {cause}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
}

impl Format {
    /// The format of a file that holds these layers.
    ///
    /// # Errors
    /// Where the ending is neither `.png` nor `.exr`, or a PNG cannot hold the layers.
    pub fn of(file: &Path, layers: &[Layer]) -> Result<Self, FormatError> {
        let ending = file.extension().and_then(|ending| ending.to_str());
        match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("exr") => Ok(Self::Exr),
            Some("png") if layers.len() > 1 => Err(FormatError::SeveralLayers {
                found: layers.len(),
            }),
            Some("png") if layers == [Layer::Depth] => Err(FormatError::Depth),
            Some("png") => Ok(Self::Png),
            _ => Err(FormatError::Ending(file.to_owned())),
        }
    }

    /// Writes the layers (at least one) to `file`. `ev` is the exposure of a PNG's light [EV].
    ///
    /// # Errors
    /// Where the system refuses; then there is no file, or the one that was there before.
    pub fn write(self, file: &Path, layers: &Layers, ev: f32) -> Result<(), WriteError> {
        let bytes = match (self, layers.as_slice()) {
            (Self::Png, [(layer, picture), ..]) => png::encode(*layer, picture, ev),
            (_, layers) => exr::encode(layers),
        };
        write_atomically(file, &bytes.map_err(|cause| io_error(file, cause))?)
    }
}

/// Checks before any work is done that the file can be made.
///
/// # Errors
/// Where its folder is missing.
pub fn check_folder(file: &Path) -> Result<(), WriteError> {
    let folder = folder(file);
    if folder.is_dir() {
        Ok(())
    } else {
        Err(WriteError::NoFolder {
            file: file.to_owned(),
            folder: folder.to_owned(),
        })
    }
}

/// Writes to a temporary file beside `file` and renames it: nobody ever sees half a file.
///
/// # Errors
/// Where the folder is missing or the system refuses; the temporary file is gone then.
pub fn write_atomically(file: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    check_folder(file)?;
    let write = || {
        let mut temporary = new_temporary(folder(file))?;
        let mut writer = BufWriter::new(temporary.as_file_mut());
        writer.write_all(bytes)?;
        writer.flush()?;
        drop(writer);
        temporary.persist(file).map_err(|error| error.error)?;
        Ok(())
    };
    write().map_err(|cause| io_error(file, cause))
}

fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Temporary files are private by default; a picture gets the permissions any new file would.
fn new_temporary(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".tyndall-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn io_error(file: &Path, cause: std::io::Error) -> WriteError {
    WriteError::Io {
        file: file.to_owned(),
        cause,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_choose_formats() {
        use Layer::{Depth, Final, Inscatter, Transmittance};
        for (file, layers, expected) in [
            ("a.png", &[Final][..], Ok(Format::Png)),
            ("a.PNG", &[Transmittance], Ok(Format::Png)),
            ("a.b/c.exr", &[Final, Depth], Ok(Format::Exr)),
            ("a.png", &[Final, Inscatter], Err("one layer, found 2")),
            ("a.png", &[Depth], Err("depth in metres")),
            ("a.tga", &[Final], Err("a.tga: expected")),
            ("png", &[Final], Err("png: expected")),
        ] {
            match (Format::of(Path::new(file), layers), expected) {
                (Ok(found), Ok(expected)) => assert_eq!(found, expected, "{file}"),
                (Err(error), Err(part)) => {
                    assert!(error.to_string().contains(part), "{file}: {error}");
                }
                (found, _) => panic!("{file}: {found:?}"),
            }
        }
    }

    #[test]
    fn files_are_replaced_whole_and_nothing_is_left_over() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.txt");
        write_atomically(&file, b"one").unwrap();
        write_atomically(&file, b"two").unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn failures_leave_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("a.png");
        std::fs::create_dir(&taken).unwrap();
        assert!(matches!(
            write_atomically(&taken, b"x"),
            Err(WriteError::Io { .. })
        ));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let missing = folder.path().join("no/such/a.png");
        let message = write_atomically(&missing, b"x").unwrap_err().to_string();
        assert!(message.ends_with("no/such does not exist"), "{message}");
    }
}
