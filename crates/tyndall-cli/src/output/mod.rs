//! Output files: a format by the ending of their names, written whole or not at all.

mod exr;
mod file;
mod format;
mod pattern;
mod png;

pub use file::{WriteError, check_folder, write_atomically};
pub use format::{Format, FormatError};
pub use pattern::{Pattern, PatternError};
