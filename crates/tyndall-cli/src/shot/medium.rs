//! `[medium]`: what fills space.

use tyndall::frame::{Medium, MediumComponent, Phase};

use super::{
    error::{Problem, ShotError, one_of},
    reader::{Field, Section},
    tree::{Entry, Value},
};

const COMPONENT_KEYS: [&str; 3] = ["sigma_s", "sigma_a", "phase"];
const PHASES: [&str; 3] = ["isotropic", "rayleigh", "hg"];

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
        phase: phase(&section.require("phase", "a table with kind = isotropic, rayleigh or hg")?)?,
    })
}

fn phase(field: &Field<'_>) -> Result<Phase, ShotError> {
    let section = field.section()?;
    let expected = one_of(&PHASES);
    let kind = section.require("kind", &expected)?;
    match kind.text(&expected)? {
        "hg" => {
            section.only(&["kind", "g"])?;
            let expected = "a number above -1 and below 1";
            let g = section
                .require("g", expected)?
                .real(expected, |g| g.abs() < 1.0)?;
            Ok(Phase::HenyeyGreenstein { g })
        }
        "isotropic" => section.only(&["kind"]).map(|()| Phase::Isotropic),
        "rayleigh" => section.only(&["kind"]).map(|()| Phase::Rayleigh),
        other => Err(kind.error(Problem::unknown_name("phase function", other, &PHASES))),
    }
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
    match phase {
        Phase::Isotropic => Value::scene_table([("kind", "isotropic".into())]),
        Phase::Rayleigh => Value::scene_table([("kind", "rayleigh".into())]),
        Phase::HenyeyGreenstein { g } => {
            Value::scene_table([("kind", "hg".into()), ("g", g.into())])
        }
    }
}
