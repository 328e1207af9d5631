//! A shot file as a tree of values that remember where they were written.

use std::{collections::BTreeMap, fmt};

use glam::DVec3;
use toml_edit::{Document, Item, TableLike, TomlError};

/// A table's entries by key.
pub(super) type Table = BTreeMap<String, Entry>;

/// A value and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) value: Value,
    pub(super) place: Place,
}

/// A value's origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// A line of the shot file, counted from 1.
    Line(usize),
    /// `--set` on the command line.
    Override,
    /// The scene: its own lights and media, or what frames it.
    Scene,
}

/// TOML's kinds of value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Table(Table),
    List(Vec<Entry>),
    Integer(i64),
    Real(f64),
    Bool(bool),
    Text(String),
    Date(String),
}

/// Parses a TOML file. The error carries its line.
pub(super) fn parse(source: &str) -> Result<Table, (usize, TomlError)> {
    let document = Document::parse(source).map_err(|error| {
        let line = error.span().map_or(1, |span| line_of(source, span.start));
        (line, error)
    })?;
    Ok(table(source, document.as_table(), 1))
}

/// Parses what follows the `=` of `--set`: a TOML value, or a bare word, which is taken as text.
pub(super) fn parse_override(text: &str) -> Result<Value, TomlError> {
    match text.parse::<toml_edit::Value>() {
        Ok(parsed) => Ok(value("", &parsed, Place::Override)),
        Err(_) if is_word(text) => Ok(Value::Text(text.to_owned())),
        Err(error) => Err(error),
    }
}

/// Text that needs no quotes on the command line: names and paths, but nothing that opens another kind of value.
fn is_word(text: &str) -> bool {
    !text.is_empty() && !text.starts_with(['[', '{', '"', '\'', '#'])
}

fn line_of(source: &str, byte: usize) -> usize {
    1 + source[..byte.min(source.len())].matches('\n').count()
}

fn table(source: &str, table: &dyn TableLike, line: usize) -> Table {
    table
        .iter()
        .map(|(key, item)| {
            let span = table.key(key).and_then(|key| key.span());
            let line = span
                .or_else(|| item.span())
                .map_or(line, |span| line_of(source, span.start));
            (key.to_owned(), entry(source, item, line))
        })
        .collect()
}

fn entry(source: &str, item: &Item, line: usize) -> Entry {
    let place = Place::Line(line);
    let value = match item {
        Item::Table(inner) => Value::Table(table(source, inner, line)),
        Item::ArrayOfTables(tables) => Value::List(
            tables
                .iter()
                .map(|inner| {
                    let line = inner
                        .span()
                        .map_or(line, |span| line_of(source, span.start));
                    Entry {
                        value: Value::Table(table(source, inner, line)),
                        place: Place::Line(line),
                    }
                })
                .collect(),
        ),
        Item::Value(inner) => value(source, inner, place),
        Item::None => Value::Table(Table::new()),
    };
    Entry { value, place }
}

fn value(source: &str, value: &toml_edit::Value, place: Place) -> Value {
    match value {
        toml_edit::Value::String(text) => Value::Text(text.value().clone()),
        toml_edit::Value::Integer(number) => Value::Integer(*number.value()),
        toml_edit::Value::Float(number) => Value::Real(*number.value()),
        toml_edit::Value::Boolean(yes) => Value::Bool(*yes.value()),
        toml_edit::Value::Datetime(date) => Value::Date(date.value().to_string()),
        toml_edit::Value::Array(items) => Value::List(
            items
                .iter()
                .map(|item| element(source, item, place))
                .collect(),
        ),
        toml_edit::Value::InlineTable(inner) => Value::Table(inline_table(source, inner, place)),
    }
}

fn element(source: &str, item: &toml_edit::Value, place: Place) -> Entry {
    let place = match (place, item.span()) {
        (Place::Line(_), Some(span)) => Place::Line(line_of(source, span.start)),
        _ => place,
    };
    Entry {
        value: value(source, item, place),
        place,
    }
}

fn inline_table(source: &str, inner: &toml_edit::InlineTable, place: Place) -> Table {
    inner
        .iter()
        .map(|(key, item)| (key.to_owned(), element(source, item, place)))
        .collect()
}

impl Entry {
    /// A value that the scene gives.
    pub(super) fn of_scene(value: Value) -> Self {
        Self {
            value,
            place: Place::Scene,
        }
    }
}

impl Value {
    /// A table of values that the scene gives.
    pub(super) fn scene_table<'a>(fields: impl IntoIterator<Item = (&'a str, Self)>) -> Self {
        Self::Table(
            fields
                .into_iter()
                .map(|(key, value)| (key.to_owned(), Entry::of_scene(value)))
                .collect(),
        )
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<f32> for Value {
    fn from(number: f32) -> Self {
        Self::Real(number.into())
    }
}

impl From<[f32; 3]> for Value {
    fn from(numbers: [f32; 3]) -> Self {
        Self::List(numbers.map(|x| Entry::of_scene(x.into())).to_vec())
    }
}

impl From<DVec3> for Value {
    fn from(position: DVec3) -> Self {
        let numbers = position.to_array().map(Self::Real);
        Self::List(numbers.map(Entry::of_scene).to_vec())
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table(_) => f.write_str("a table"),
            Self::List(items) if items.iter().any(|i| matches!(i.value, Self::Table(_))) => {
                f.write_str("a list of tables")
            }
            Self::List(items) if items.len() > 8 => write!(f, "{} values", items.len()),
            Self::List(items) => {
                let items: Vec<_> = items.iter().map(|item| item.value.to_string()).collect();
                write!(f, "[{}]", items.join(", "))
            }
            Self::Integer(number) => write!(f, "{number}"),
            Self::Real(number) if number.is_nan() => f.write_str("nan"),
            Self::Real(number) => write!(f, "{number:?}"),
            Self::Bool(yes) => write!(f, "{yes}"),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Date(date) => f.write_str(date),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_remember_their_lines() {
        let root = parse("a = 1\n[t]\nb = [1,\n  2]\n[[l]]\nc = { d = true }\n[[l]]\n").unwrap();
        assert_eq!(root["a"].place, Place::Line(1));
        let Value::Table(t) = &root["t"].value else {
            panic!("t is {}", root["t"].value)
        };
        assert_eq!(t["b"].place, Place::Line(3));
        let Value::List(b) = &t["b"].value else {
            panic!("b is {}", t["b"].value)
        };
        assert_eq!(b[1].place, Place::Line(4));
        let Value::List(l) = &root["l"].value else {
            panic!("l is {}", root["l"].value)
        };
        assert_eq!([l[0].place, l[1].place], [Place::Line(5), Place::Line(7)]);
    }

    #[test]
    fn syntax_errors_say_their_line() {
        assert_eq!(parse("a = 1\nb = = 2\n").unwrap_err().0, 2);
        assert_eq!(parse("a = 1\na = 2\n").unwrap_err().0, 2);
    }

    #[test]
    fn override_values_are_toml_or_words() {
        for (text, expected) in [
            ("2048", Value::Integer(2048)),
            ("1e-3", Value::Real(1e-3)),
            ("true", Value::Bool(true)),
            ("ray-march", Value::Text("ray-march".into())),
            ("\"a b\"", Value::Text("a b".into())),
            ("builtin:church", Value::Text("builtin:church".into())),
            ("../a.png", Value::Text("../a.png".into())),
        ] {
            assert_eq!(parse_override(text).unwrap(), expected, "{text}");
        }
        for text in ["[1, 2", "{ a = ", "\"open", ""] {
            assert!(parse_override(text).is_err(), "{text}");
        }
    }
}
