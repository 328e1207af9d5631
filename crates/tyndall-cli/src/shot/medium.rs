//! `[medium]`: what fills space.

use tyndall::{
    frame::{Medium, MediumComponent, Phase},
    phase::{MAX_PARAMS, TABLE},
};

use super::{
    error::{Problem, ShotError, one_of},
    reader::{Field, Section},
    tree::{Entry, Value},
};

const COMPONENT_KEYS: [&str; 3] = ["sigma_s", "sigma_a", "phase"];

/// Reads `[medium]`: one component, or a list of them.
pub(super) fn read(field: &Field<'_>) -> Result<Medium, ShotError> {
    let section = field.section()?;
    let Some(list) = section.get("component") else {
        section.only(&["sigma_s", "sigma_a", "phase", "component"])?;
        return Ok(Medium {
            components: vec![component(&section)?],
        });
    };
    section.only(&["component"])?;
    let expected = format!("1 to {} components", Medium::MAX_COMPONENTS);
    let items = list.list(&expected)?;
    if items.is_empty() || items.len() > Medium::MAX_COMPONENTS {
        return Err(list.expected_found(expected, items.len()));
    }
    let components = items
        .iter()
        .map(|item| {
            let section = item.section()?;
            section.only(&COMPONENT_KEYS)?;
            component(&section)
        })
        .collect::<Result<_, _>>()?;
    Ok(Medium { components })
}

fn component(section: &Section<'_>) -> Result<MediumComponent, ShotError> {
    Ok(MediumComponent {
        sigma_s: section.color("sigma_s")?,
        sigma_a: section.color("sigma_a")?,
        phase: phase(&section.require("phase", "a table with the kind of a phase function")?)?,
    })
}

fn phase(field: &Field<'_>) -> Result<Phase, ShotError> {
    let section = field.section()?;
    let names: Vec<&str> = TABLE.iter().map(|info| info.name).collect();
    let expected = one_of(&names);
    let kind = section.require("kind", &expected)?;
    let name = kind.text(&expected)?;
    let unknown = || kind.error(Problem::unknown_name("phase function", name, &names));
    let info = TABLE.iter().find(|info| info.name == name);
    let params = info.ok_or_else(unknown)?.params;
    let keys: Vec<&str> = ["kind"]
        .into_iter()
        .chain(params.iter().map(|param| param.key))
        .collect();
    section.only(&keys)?;
    let mut values = [0.0; MAX_PARAMS];
    for (value, param) in values.iter_mut().zip(params) {
        *value = section
            .require(param.key, param.range)?
            .real(param.range, param.allows)?;
    }
    Phase::from_name(name, values).ok_or_else(unknown)
}

/// A medium as a shot would write it, for `--set` to change.
pub(super) fn to_tree(medium: &Medium) -> Entry {
    Entry::of_scene(match medium.components.as_slice() {
        [only] => component_value(only),
        components => {
            let list = components
                .iter()
                .map(|component| Entry::of_scene(component_value(component)))
                .collect();
            Value::scene_table([("component", Value::List(list))])
        }
    })
}

fn component_value(component: &MediumComponent) -> Value {
    Value::scene_table([
        ("sigma_s", component.sigma_s.into()),
        ("sigma_a", component.sigma_a.into()),
        ("phase", phase_value(component.phase)),
    ])
}

fn phase_value(phase: Phase) -> Value {
    let kind = ("kind", phase.info().name.into());
    let params = phase
        .params()
        .map(|(param, value)| (param.key, value.into()));
    Value::scene_table([kind].into_iter().chain(params))
}
