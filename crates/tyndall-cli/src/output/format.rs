//! File formats, by the ending of a file's name.

use std::path::{Path, PathBuf};

use super::{
    exr,
    file::{WriteError, io_error, write_atomically},
    png,
};
use crate::layer::{Layer, Layers};

/// A file's format, by the ending of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB: one layer; light is exposed and tone-mapped, transmittance is encoded as it is.
    Png,
    /// Linear 32-bit floats: one layer as R, G, B, several as named layers (`inscatter.R` ...).
    Exr,
}

/// A file that cannot be written as asked.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// The ending is none we write.
    #[error("cannot write {}: expected a name that ends in .png or .exr", .0.display())]
    Ending(PathBuf),
    /// A PNG can hold only one layer.
    #[error("a .png holds one layer, found {found}: write an .exr")]
    SeveralLayers {
        /// Number of layers that were asked for.
        found: usize,
    },
    /// Distances have no place in a PNG.
    #[error("a .png cannot hold depth in metres: write an .exr")]
    Depth,
}

impl Format {
    /// The format of a file that holds these layers.
    ///
    /// # Errors
    /// [`FormatError`] where the ending is neither `.png` nor `.exr`, or a PNG cannot hold the layers.
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

    /// Writes the layers (at least one) to `file`. `ev` is the exposure of a PNG's light \[EV].
    ///
    /// # Errors
    /// [`WriteError`] where the system refuses; then there is no file, or the one that was there before.
    pub fn write(self, file: &Path, layers: &Layers, ev: f32) -> Result<(), WriteError> {
        let bytes = match (self, layers.as_slice()) {
            (Self::Png, [(layer, picture), ..]) => png::encode(*layer, picture, ev),
            (_, layers) => exr::encode(layers),
        };
        write_atomically(file, &bytes.map_err(|cause| io_error(file, cause))?)
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
}
