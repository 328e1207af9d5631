//! `[technique]`, and a light's own: the technique that computes the integral.

use tyndall::{
    frame::LightKind,
    techniques::{self, ParamError, TABLE, Technique},
};

use super::{
    error::{Problem, ShotError, one_of, similar},
    reader::Field,
    tree::{Entry, Place, Table, Value},
};

/// Every technique's name.
pub(crate) fn names() -> Vec<&'static str> {
    TABLE.iter().map(|info| info.name).collect()
}

/// Puts the technique of `--technique` in the shot's place; the shot's parameters stay where it names the same one.
pub(super) fn replace(root: &mut Table, name: &str) {
    let same = match root.get("technique").map(|entry| &entry.value) {
        Some(Value::Table(table)) => match table.get("name").map(|entry| &entry.value) {
            Some(Value::Text(old)) => old == name,
            _ => name == Technique::default().info().name,
        },
        _ => false,
    };
    if same {
        return;
    }
    let name = Entry {
        value: Value::Text(name.to_owned()),
        place: Place::Override,
    };
    let table = Entry {
        value: Value::Table(Table::from([("name".to_owned(), name)])),
        place: Place::Override,
    };
    root.insert("technique".to_owned(), table);
}

/// Reads `[technique]`; where it names none, its parameters are those of the first that can do lights of these kinds.
pub(super) fn read(field: &Field<'_>, kinds: &[LightKind]) -> Result<Technique, ShotError> {
    let section = field.section()?;
    let mut technique = match &section.get("name") {
        Some(field) => named(field)?,
        None => Technique::default_for(kinds),
    };
    for (key, field) in section.fields().filter(|(key, _)| *key != "name") {
        set(&mut technique, key, &field)?;
    }
    Ok(technique)
}

/// Reads a light's own technique, which has to be able to do lights of this kind.
pub(super) fn read_own(field: &Field<'_>, kind: LightKind) -> Result<Technique, ShotError> {
    let technique = read(field, &[kind])?;
    if technique.info().lights.contains(&kind) {
        return Ok(technique);
    }
    let able = TABLE.iter().filter(|info| info.lights.contains(&kind));
    let able: Vec<&str> = able.map(|info| info.name).collect();
    let section = field.section()?;
    let name = section.require("name", &one_of(&able))?;
    let (kind, able) = (kind.name(), one_of(&able));
    Err(name.unexpected(format!("a technique that does {kind} lights: {able}")))
}

fn named(field: &Field<'_>) -> Result<Technique, ShotError> {
    let name = field.text(&one_of(&names()))?;
    Technique::from_name(name)
        .ok_or_else(|| field.error(Problem::unknown_name("technique", name, &names())))
}

fn set(technique: &mut Technique, key: &str, field: &Field<'_>) -> Result<(), ShotError> {
    let value = match field.value() {
        Value::Integer(number) => techniques::Value::Integer(*number),
        Value::Real(number) if number.is_finite() => techniques::Value::Real(*number),
        Value::Text(word) => techniques::Value::Word(word.clone()),
        Value::Bool(yes) => techniques::Value::Bool(*yes),
        _ => return Err(field.unexpected("a finite number, a word, true or false")),
    };
    let keys: Vec<&str> = technique.params().iter().map(|info| info.key).collect();
    technique.set(key, &value).map_err(|error| match error {
        ParamError::Unknown { .. } => field.error(Problem::UnknownKey {
            expected: one_of(&keys),
            similar: similar(key, &keys),
        }),
        ParamError::OutOfRange { expected, .. } => field.unexpected(expected),
    })
}
