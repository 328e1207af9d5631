//! `--set KEY=VALUE`: values of the command line that take the place of the file's.

use std::{path::Path, str::FromStr};

use super::{
    error::{Location, Origin, Problem, ShotError},
    tree::{self, Entry, Place, Table, Value},
};

/// One `--set KEY=VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    keys: Vec<String>,
    value: Value,
}

/// Why the text of a `--set` is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OverrideError {
    /// It lacks the equals sign or the key.
    #[error("expected KEY=VALUE, e.g. medium.sigma_s=[0.1,0.1,0.1]")]
    Form,
    /// The value is not TOML.
    #[error("expected a TOML value or a word after `=`: {0}")]
    Value(String),
}

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, OverrideError> {
        let (path, value) = text.split_once('=').ok_or(OverrideError::Form)?;
        let keys: Vec<String> = path.split('.').map(|key| key.trim().to_owned()).collect();
        if keys.iter().any(String::is_empty) {
            return Err(OverrideError::Form);
        }
        let value = tree::parse_override(value.trim())
            .map_err(|error| OverrideError::Value(error.message().trim().to_owned()))?;
        Ok(Self { keys, value })
    }
}

impl Override {
    /// True where this changes a part of the top-level key `section` that only the scene can fill in.
    pub(super) fn is_within(&self, section: &str) -> bool {
        self.keys.len() > 1 && self.keys[0] == section
    }

    /// The name of a technique, where this gives one to a light.
    pub(super) fn light_technique(&self) -> Option<&str> {
        let keys: Vec<&str> = self.keys.iter().map(String::as_str).collect();
        let name = match (&keys[..], &self.value) {
            (["light", _, "technique", "name"], name) => name,
            (["light", _, "technique"], Value::Table(table)) => &table.get("name")?.value,
            _ => return None,
        };
        match name {
            Value::Text(name) => Some(name),
            _ => None,
        }
    }

    /// Puts the value in its place. Tables of its path that aren't there are made, items of lists are not.
    pub(super) fn apply(&self, file: &Path, root: &mut Table) -> Result<(), ShotError> {
        let mut keys = self.keys.iter();
        let Some(first) = keys.next() else {
            return Ok(());
        };
        let mut entry = root.entry(first.clone()).or_insert_with(new_table);
        for (depth, key) in keys.enumerate() {
            entry = match &mut entry.value {
                Value::Table(table) => table.entry(key.clone()).or_insert_with(new_table),
                Value::List(items) => {
                    let count = items.len();
                    key.parse()
                        .ok()
                        .and_then(|index: usize| items.get_mut(index))
                        .ok_or_else(|| self.error(file, indices(count), key))?
                }
                other => {
                    let parent = self.keys[..=depth].join(".");
                    let found = other.to_string();
                    return Err(self.error(file, format!("a table in `{parent}`"), &found));
                }
            };
        }
        *entry = Entry {
            value: self.value.clone(),
            place: Place::Override,
        };
        Ok(())
    }

    fn error(&self, file: &Path, expected: String, found: &str) -> ShotError {
        let location = Location {
            file: file.to_owned(),
            origin: Origin::Override,
            path: self.keys.join("."),
        };
        let found = found.to_owned();
        ShotError::new(location, Problem::Value { expected, found })
    }
}

fn new_table() -> Entry {
    Entry {
        value: Value::Table(Table::new()),
        place: Place::Override,
    }
}

fn indices(count: usize) -> String {
    match count {
        0 => "an empty list to be left alone".to_owned(),
        1 => "index 0 of a list of one".to_owned(),
        _ => format!("an index from 0 to {}", count - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(source: &str, overrides: &[&str]) -> Result<Table, ShotError> {
        let mut root = tree::parse(source).unwrap();
        for text in overrides {
            let parsed: Override = text.parse().unwrap();
            parsed.apply(Path::new("x.toml"), &mut root)?;
        }
        Ok(root)
    }

    #[test]
    fn values_are_replaced_where_they_are() {
        let source = "a = 1\n[[l]]\nk = 1\n[[l]]\nk = 2\n[t]\np = { g = 1 }\n";
        let root = apply(source, &["l.1.k=7", "t.p.g=0.5", "new.key=word"]).unwrap();
        let shown = |entry: &Entry| match &entry.value {
            Value::Table(table) => format!("{table:?}"),
            other => other.to_string(),
        };
        let Value::List(items) = &root["l"].value else {
            panic!("l is {}", root["l"].value)
        };
        assert!(shown(&items[0]).contains("Integer(1)"));
        assert!(shown(&items[1]).contains("Integer(7)"));
        assert!(shown(&root["t"]).contains("Real(0.5)"));
        assert!(shown(&root["new"]).contains("Text(\"word\")"));
    }

    #[test]
    fn what_is_not_there_is_not_replaced() {
        for (text, message) in [
            (
                "l.3.k=1",
                "--set l.3.k: expected index 0 of a list of one, found 3",
            ),
            (
                "l.x.k=1",
                "--set l.x.k: expected index 0 of a list of one, found x",
            ),
            ("a.b=1", "--set a.b: expected a table in `a`, found 1"),
        ] {
            let error = apply("a = 1\n[[l]]\nk = 1\n", &[text]).unwrap_err();
            assert_eq!(error.to_string(), message);
        }
    }

    #[test]
    fn malformed_overrides_are_refused() {
        for text in ["a", "=1", "a..b=1", ".a=1", "a=[1,"] {
            assert!(text.parse::<Override>().is_err(), "{text}");
        }
    }
}
