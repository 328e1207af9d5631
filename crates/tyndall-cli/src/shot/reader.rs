//! Typed access to the tree: every getter says what it expected and what it found.

use std::{fmt, path::Path};

use glam::DVec3;

use super::{
    error::{Location, Origin, Problem, ShotError, one_of, similar},
    tree::{Entry, Place, Table, Value},
};

/// A table of the shot and its path.
#[derive(Clone)]
pub(super) struct Section<'a> {
    file: &'a Path,
    path: String,
    place: Place,
    table: &'a Table,
}

/// A value of the shot and its path.
#[derive(Clone)]
pub(super) struct Field<'a> {
    file: &'a Path,
    path: String,
    entry: &'a Entry,
}

fn location(file: &Path, path: &str, place: Place) -> Location {
    Location {
        file: file.to_owned(),
        origin: match place {
            Place::Line(line) => Origin::Line(line),
            Place::Override => Origin::Override,
            Place::Scene => Origin::File,
        },
        path: path.to_owned(),
    }
}

fn join(path: &str, key: impl fmt::Display) -> String {
    if path.is_empty() {
        key.to_string()
    } else {
        format!("{path}.{key}")
    }
}

impl<'a> Section<'a> {
    /// The top level of the file.
    pub(super) fn root(file: &'a Path, table: &'a Table) -> Self {
        Self {
            file,
            path: String::new(),
            place: Place::Line(1),
            table,
        }
    }

    /// Refuses keys that are not in `known`.
    pub(super) fn only(&self, known: &[&str]) -> Result<(), ShotError> {
        match self.fields().find(|(key, _)| !known.contains(key)) {
            None => Ok(()),
            Some((key, field)) => Err(field.error(Problem::UnknownKey {
                expected: one_of(known),
                similar: similar(key, known),
            })),
        }
    }

    /// Every key and its value.
    pub(super) fn fields(&self) -> impl Iterator<Item = (&'a str, Field<'a>)> + use<'a> {
        let (file, path) = (self.file, self.path.clone());
        self.table.iter().map(move |(key, entry)| {
            let path = join(&path, key);
            (key.as_str(), Field { file, path, entry })
        })
    }

    pub(super) fn get(&self, key: &str) -> Option<Field<'a>> {
        self.table.get(key).map(|entry| Field {
            file: self.file,
            path: join(&self.path, key),
            entry,
        })
    }

    pub(super) fn require(&self, key: &str, expected: &str) -> Result<Field<'a>, ShotError> {
        self.get(key).ok_or_else(|| {
            let location = location(self.file, &join(&self.path, key), self.place);
            let expected = expected.to_owned();
            ShotError::new(location, Problem::Missing { expected })
        })
    }

    /// Three numbers that all pass `accept`.
    pub(super) fn vec3(
        &self,
        key: &str,
        expected: &str,
        accept: impl Fn(f32) -> bool,
    ) -> Result<[f32; 3], ShotError> {
        self.require(key, expected)?.vec3(expected, accept)
    }

    /// Three finite numbers, a position in double precision.
    pub(super) fn point(&self, key: &str) -> Result<DVec3, ShotError> {
        let field = self.require(key, POINT)?;
        field.vec3(POINT, |_| true)?;
        Ok(DVec3::from(
            field.array::<3>(POINT)?.map(|item| item.precise()),
        ))
    }

    /// Three finite numbers that are not all zero.
    pub(super) fn direction(&self, key: &str) -> Result<[f32; 3], ShotError> {
        self.require(key, DIRECTION)?.direction()
    }

    /// A linear RGB triple.
    pub(super) fn color(&self, key: &str) -> Result<[f32; 3], ShotError> {
        self.vec3(key, "three numbers >= 0", |x| x >= 0.0)
    }

    /// A whole number of `range`, `default` where the key is left out.
    pub(super) fn whole_or(
        &self,
        key: &str,
        default: u32,
        range: std::ops::RangeInclusive<u32>,
    ) -> Result<u32, ShotError> {
        self.get(key)
            .map_or(Ok(default), |field| field.whole(range))
    }
}

const POINT: &str = "three finite numbers";
const DIRECTION: &str = "three numbers that are not all zero";

impl<'a> Field<'a> {
    pub(super) fn location(&self) -> Location {
        location(self.file, &self.path, self.entry.place)
    }

    pub(super) fn error(&self, problem: Problem) -> ShotError {
        ShotError::new(self.location(), problem)
    }

    /// The error that something else was expected than what is here.
    pub(super) fn unexpected(&self, expected: impl Into<String>) -> ShotError {
        self.expected_found(expected, &self.entry.value)
    }

    pub(super) fn expected_found(
        &self,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> ShotError {
        self.error(Problem::Value {
            expected: expected.into(),
            found: found.to_string(),
        })
    }

    pub(super) fn value(&self) -> &'a Value {
        &self.entry.value
    }

    pub(super) fn text(&self, expected: &str) -> Result<&'a str, ShotError> {
        match &self.entry.value {
            Value::Text(text) if !text.is_empty() => Ok(text),
            _ => Err(self.unexpected(expected)),
        }
    }

    /// A number that passes `accept` and is finite in single precision.
    pub(super) fn real(
        &self,
        expected: &str,
        accept: impl Fn(f32) -> bool,
    ) -> Result<f32, ShotError> {
        let number = match self.entry.value {
            Value::Integer(number) => number as f32,
            Value::Real(number) => number as f32,
            _ => return Err(self.unexpected(expected)),
        };
        if number.is_finite() && accept(number) {
            Ok(number)
        } else {
            Err(self.unexpected(expected))
        }
    }

    /// The number in double precision; 0 where there is none.
    fn precise(&self) -> f64 {
        match self.entry.value {
            Value::Integer(number) => number as f64,
            Value::Real(number) => number,
            _ => 0.0,
        }
    }

    pub(super) fn whole(&self, range: std::ops::RangeInclusive<u32>) -> Result<u32, ShotError> {
        match self.entry.value {
            Value::Integer(number) => u32::try_from(number).ok(),
            _ => None,
        }
        .filter(|number| range.contains(number))
        .ok_or_else(|| {
            let (start, end) = (range.start(), range.end());
            self.unexpected(format!("a whole number from {start} to {end}"))
        })
    }

    /// Exactly `N` values.
    pub(super) fn array<const N: usize>(
        &self,
        expected: &str,
    ) -> Result<[Field<'a>; N], ShotError> {
        let items = self.list(expected)?;
        items.try_into().map_err(|_| self.unexpected(expected))
    }

    pub(super) fn list(&self, expected: &str) -> Result<Vec<Field<'a>>, ShotError> {
        match &self.entry.value {
            Value::List(entries) => Ok(entries
                .iter()
                .enumerate()
                .map(|(index, entry)| Field {
                    file: self.file,
                    path: join(&self.path, index),
                    entry,
                })
                .collect()),
            _ => Err(self.unexpected(expected)),
        }
    }

    pub(super) fn vec3(
        &self,
        expected: &str,
        accept: impl Fn(f32) -> bool,
    ) -> Result<[f32; 3], ShotError> {
        let mut numbers = [0.0; 3];
        for (number, item) in numbers.iter_mut().zip(self.array::<3>(expected)?) {
            let found = item.entry;
            *number = item
                .real(expected, &accept)
                .map_err(|_| self.expected_found(expected, &found.value))?;
        }
        Ok(numbers)
    }

    pub(super) fn direction(&self) -> Result<[f32; 3], ShotError> {
        let direction = self.vec3(DIRECTION, |_| true)?;
        if glam::Vec3::from(direction).try_normalize().is_some() {
            Ok(direction)
        } else {
            Err(self.unexpected(DIRECTION))
        }
    }

    pub(super) fn section(&self) -> Result<Section<'a>, ShotError> {
        match &self.entry.value {
            Value::Table(table) => Ok(Section {
                file: self.file,
                path: self.path.clone(),
                place: self.entry.place,
                table,
            }),
            _ => Err(self.unexpected("a table")),
        }
    }
}
