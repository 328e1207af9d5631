//! Errors of writing a comparison.

use std::path::PathBuf;

use super::plot::PlotError;
use crate::output::WriteError;

/// Why a comparison could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A plot or legend could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A picture could not be encoded.
    #[error("cannot encode a picture: {0}")]
    Encode(#[from] image::ImageError),
    /// The folder could not be made.
    #[error("cannot make the folder {}: {cause}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// The system's reason.
        cause: std::io::Error,
    },
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}
