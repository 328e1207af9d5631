//! Files that are written whole or not at all.

use std::{
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

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
        /// The system's reason.
        cause: std::io::Error,
    },
}

/// Checks before any work is done that the file can be made.
///
/// # Errors
/// [`WriteError::NoFolder`] where its folder is missing.
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
/// [`WriteError`] where the folder is missing or the system refuses; the temporary file is gone then.
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

pub(super) fn io_error(file: &Path, cause: std::io::Error) -> WriteError {
    WriteError::Io {
        file: file.to_owned(),
        cause,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
