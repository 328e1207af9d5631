//! Errors in shots: their place, and what was expected and found there.

use std::{fmt, path::PathBuf};

/// A mistake in a shot file or in a `--set`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{location}: {problem}")]
pub struct ShotError {
    /// Its place.
    pub location: Location,
    /// The mistake itself.
    pub problem: Box<Problem>,
}

impl ShotError {
    /// A mistake at a place.
    pub fn new(location: Location, problem: Problem) -> Self {
        Self {
            location,
            problem: Box::new(problem),
        }
    }
}

/// The place where a value was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The shot or scene file.
    pub file: PathBuf,
    /// Line or command line.
    pub origin: Origin,
    /// The dotted path of the key, e.g. `light.0.direction`; empty for all of the file.
    pub path: String,
}

/// The writer of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// This line of the file, counted from 1.
    Line(usize),
    /// The command line's `--set`.
    Override,
    /// The file as a whole.
    File,
}

/// A kind of mistake.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// Not TOML.
    #[error("expected TOML: {0}")]
    Syntax(String),
    /// The file can't be read.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// A value of the wrong type or out of range.
    #[error("expected {expected}, found {found}")]
    Value {
        /// Values that it may have.
        expected: String,
        /// The value it has.
        found: String,
    },
    /// A key that has to be there isn't.
    #[error("is missing: expected {expected}")]
    Missing {
        /// Values that it may have.
        expected: String,
    },
    /// A key that nobody knows.
    #[error("no such key: expected {expected}{}", suggestion(.similar))]
    UnknownKey {
        /// The keys there are.
        expected: String,
        /// The one that was perhaps meant.
        similar: Option<String>,
    },
    /// A name of something that isn't there.
    #[error("no {kind} is called {found:?}: expected {expected}{}", suggestion(.similar))]
    UnknownName {
        /// Kind of the thing that is named.
        kind: &'static str,
        /// The name.
        found: String,
        /// The names there are.
        expected: String,
        /// The one that was perhaps meant.
        similar: Option<String>,
    },
}

impl Problem {
    /// A name that isn't among `names`.
    pub(crate) fn unknown_name(kind: &'static str, found: &str, names: &[&str]) -> Self {
        Self::UnknownName {
            kind,
            found: found.to_owned(),
            expected: one_of(names),
            similar: similar(found, names),
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.file.display();
        match self.origin {
            Origin::Line(line) => write!(f, "{file}:{line}")?,
            Origin::Override => return write!(f, "--set {}", self.path),
            Origin::File => write!(f, "{file}")?,
        }
        if !self.path.is_empty() {
            write!(f, ": {}", self.path)?;
        }
        Ok(())
    }
}

fn suggestion(similar: &Option<String>) -> String {
    similar
        .as_ref()
        .map(|name| format!("; did you mean `{name}`?"))
        .unwrap_or_default()
}

/// "a, b or c".
pub(crate) fn one_of(names: &[&str]) -> String {
    match names {
        [] => "none".to_owned(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// The name that was perhaps meant: the nearest within a third of its letters.
pub(crate) fn similar(found: &str, names: &[&str]) -> Option<String> {
    names
        .iter()
        .map(|name| (strsim::damerau_levenshtein(found, name), name))
        .filter(|(distance, name)| 3 * distance <= name.chars().count().max(3))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| (*name).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_near_names_are_suggested() {
        let names = ["sigma_s", "sigma_a", "phase"];
        assert_eq!(similar("sgima_s", &names).as_deref(), Some("sigma_s"));
        assert_eq!(similar("fase", &names), None);
        assert_eq!(similar("phasee", &names).as_deref(), Some("phase"));
        assert_eq!(similar("density", &names), None);
    }
}
