//! A frame's textures: that each light has those it needs and no others, and their sizes on the CPU.

use super::require::{Checked, require};
use crate::{error::PrepareError, frame::Frame, inputs::GlassMap, integrate::CpuInputs};

/// The longest side of an image or texture \[pixels] that is accepted at all, so that sizes never overflow.
const MAX_SIDE: u32 = 1 << 16;

/// Checks that one input set a light was given, and what each light needs.
pub(crate) fn light_inputs(
    frame: &Frame,
    given: impl ExactSizeIterator<Item = GivenInputs>,
) -> Checked {
    if given.len() != frame.lights.len() {
        return Err(PrepareError::WrongSize {
            field: "inputs.lights".into(),
            expected: frame.lights.len(),
            found: given.len(),
        });
    }
    for (i, (light, given)) in frame.lights.iter().zip(given).enumerate() {
        let missing = |key: &str, reason| PrepareError::Missing {
            field: format!("inputs.lights[{i}].{key}"),
            reason,
        };
        if light.shadow.is_some() && !given.shadow_map {
            return Err(missing("shadow_map", "the light has a shadow projection"));
        }
        if light.texture.is_some() && !given.texture {
            return Err(missing("texture", "the light has a texture placement"));
        }
        let surplus = [
            ("shadow_map", given.shadow_map, light.shadow.is_some()),
            ("glass", given.glass, light.shadow.is_some()),
            ("texture", given.texture, light.texture.is_some()),
        ];
        for (key, is_given, is_used) in surplus {
            require(
                is_used || !is_given,
                format!("inputs.lights[{i}].{key}"),
                "none, for the light has no projection or placement for it",
                "one",
            )?;
        }
    }
    Ok(())
}

/// The textures of a light that were given.
pub(crate) struct GivenInputs {
    pub(crate) shadow_map: bool,
    pub(crate) glass: bool,
    pub(crate) texture: bool,
}

/// Checks the textures of the CPU backend.
pub(crate) fn cpu_inputs(frame: &Frame, inputs: &CpuInputs<'_>) -> Checked {
    let pixels = area("inputs.size", inputs.size)?;
    size("inputs.depth", pixels, inputs.depth.len())?;
    values("inputs.depth", inputs.depth, IS_FINITE)?;
    let given = inputs.lights.iter().map(|l| GivenInputs {
        shadow_map: l.shadow_map.is_some(),
        glass: l.glass.is_some(),
        texture: l.texture.is_some(),
    });
    light_inputs(frame, given)?;
    for (i, (light, inputs)) in frame.lights.iter().zip(inputs.lights).enumerate() {
        let field = |key: &str| format!("inputs.lights[{i}].{key}");
        let faces = light.faces() as usize;
        if let Some(map) = inputs.shadow_map {
            let texels = area(&field("shadow_map.size"), map.size)?;
            size(&field("shadow_map.depth"), faces * texels, map.depth.len())?;
            values(&field("shadow_map.depth"), &map.depth, IS_FINITE)?;
        }
        if let Some(GlassMap {
            size: side,
            layers,
            texels,
        }) = inputs.glass
        {
            let area = area(&field("glass.size"), *side)?;
            size(
                &field("glass.texels"),
                faces * area * *layers as usize,
                texels.len(),
            )?;
            let tints = texels.iter().flat_map(|[r, g, b, _]| [r, g, b]);
            values(&field("glass.texels"), tints, IS_SHARE)?;
        }
        if let Some(texture) = inputs.texture {
            let texels = area(&field("texture.size"), texture.size)?;
            size(&field("texture.texels"), texels, texture.texels.len())?;
            let texels = texture.texels.as_flattened();
            values(&field("texture.texels"), texels, IS_LIGHT)?;
        }
    }
    Ok(())
}

/// A condition that values have to meet, and its words.
type Rule = (fn(f32) -> bool, &'static str);

const IS_FINITE: Rule = (f32::is_finite, "finite numbers");
const IS_SHARE: Rule = (|x| (0.0..=1.0).contains(&x), "numbers from 0 to 1");
const IS_LIGHT: Rule = (|x| (0.0..=1e6).contains(&x), "numbers from 0 to 1e6");

fn values<'a>(
    field: &str,
    values: impl IntoIterator<Item = &'a f32>,
    (holds, expected): Rule,
) -> Checked {
    let mut numbered = values.into_iter().enumerate();
    match numbered.find(|(_, x)| !holds(**x)) {
        None => Ok(()),
        Some((i, found)) => require(false, format!("{field}[{i}]"), expected, found),
    }
}

fn area(field: &str, size: [u32; 2]) -> Result<usize, PrepareError> {
    require(
        size.iter().all(|n| (1..=MAX_SIDE).contains(n)),
        field,
        "1 to 65536 a side",
        size,
    )?;
    Ok(size[0] as usize * size[1] as usize)
}

fn size(field: &str, expected: usize, found: usize) -> Checked {
    if expected == found {
        return Ok(());
    }
    Err(PrepareError::WrongSize {
        field: field.to_owned(),
        expected,
        found,
    })
}
