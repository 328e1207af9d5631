//! Names of a sequence's files.

use std::{
    io,
    path::{Path, PathBuf},
};

/// A file name with a place for the frame's number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

/// A file name without one place for the frame's number.
#[derive(Debug, thiserror::Error)]
#[error("cannot write a sequence to {}: expected a name that holds one of #### or %04d, found {found}", file.display())]
pub struct PatternError {
    file: PathBuf,
    found: usize,
}

/// The most digits a number is filled up to.
const MAX_DIGITS: usize = 16;

impl Pattern {
    /// Finds the run of `#`, or the `%d` or `%04d`, in the name of `file`.
    ///
    /// # Errors
    /// [`PatternError`] where there is none, or more than one.
    pub fn of(file: &Path) -> Result<Self, PatternError> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let places = places(&name);
        match places[..] {
            [(start, end, digits)] => Ok(Self {
                folder: file.parent().unwrap_or(Path::new("")).to_owned(),
                before: name[..start].to_owned(),
                digits,
                after: name[end..].to_owned(),
            }),
            _ => Err(PatternError {
                file: file.to_owned(),
                found: places.len(),
            }),
        }
    }

    /// The file of a frame: its number with leading zeros.
    pub fn file(&self, frame: u32) -> PathBuf {
        let (before, digits, after) = (&self.before, self.digits, &self.after);
        self.folder.join(format!("{before}{frame:0digits$}{after}"))
    }

    /// The frames whose files there are, in any order.
    ///
    /// # Errors
    /// [`io::Error`] where the folder cannot be read.
    pub fn numbers(&self) -> io::Result<Vec<u32>> {
        let here = Path::new(".");
        let is_here = self.folder.as_os_str().is_empty();
        let entries = std::fs::read_dir(if is_here { here } else { &self.folder })?;
        let mut numbers = Vec::new();
        for entry in entries {
            let name = entry?.file_name();
            numbers.extend(name.to_str().and_then(|name| self.number(name)));
        }
        Ok(numbers)
    }

    /// The frame whose file is called so.
    fn number(&self, name: &str) -> Option<u32> {
        let digits = name.strip_prefix(&self.before)?.strip_suffix(&self.after)?;
        let number = digits.parse().ok()?;
        (self.file(number).file_name()? == name).then_some(number)
    }
}

/// Start, end and digits of every place for a number.
fn places(name: &str) -> Vec<(usize, usize, usize)> {
    let mut places = Vec::new();
    let mut at = 0;
    while let Some(rest) = name.get(at..).filter(|rest| !rest.is_empty()) {
        let hashes = rest.len() - rest.trim_start_matches('#').len();
        if hashes > 0 {
            places.push((at, at + hashes, hashes));
            at += hashes;
        } else if let Some((length, digits)) = printf(rest) {
            places.push((at, at + length, digits));
            at += length;
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    places
}

/// Length and digits of `%d` or `%04d` at the start of a text.
fn printf(text: &str) -> Option<(usize, usize)> {
    let width = text.strip_prefix('%')?;
    let (width, _) = width.split_once('d')?;
    let digits = match width {
        "" => 1,
        _ => width.strip_prefix('0')?.parse().ok()?,
    };
    (1..=MAX_DIGITS)
        .contains(&digits)
        .then_some((width.len() + 2, digits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_the_pattern_s_place() {
        for (file, expected) in [
            ("a/b.####.png", "a/b.0042.png"),
            ("%04d.exr", "0042.exr"),
            ("f%d.png", "f42.png"),
            ("#.png", "42.png"),
            ("50%-é-###.png", "50%-é-042.png"),
            ("a#b/f%03d.png", "a#b/f042.png"),
        ] {
            let pattern = Pattern::of(Path::new(file)).unwrap();
            assert_eq!(pattern.file(42), Path::new(expected), "{file}");
        }
    }

    #[test]
    fn a_name_has_one_place() {
        for (file, found) in [
            ("a.png", 0),
            ("#/a.png", 0),
            ("a%x.png", 0),
            ("a%4d.png", 0),
            ("##_##.png", 2),
            ("#%d.png", 2),
        ] {
            let error = Pattern::of(Path::new(file)).unwrap_err().to_string();
            assert!(error.ends_with(&format!("found {found}")), "{error}");
            assert!(error.contains(file), "{error}");
        }
    }
}
