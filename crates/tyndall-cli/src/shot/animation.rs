//! `[temporal]` and `[animation]`: what only sequences use.

use super::{
    error::ShotError,
    reader::{Field, Section},
};

/// Reuse of earlier frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Temporal {
    /// Frames that a value is reused for (>= 1).
    pub reuse: u32,
}

/// What moves, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Frames a second (> 0).
    pub fps: f32,
    /// The movements.
    pub moves: Vec<Move>,
}

/// The movement of a node, of `camera`, or of a light such as `light.0`; keyframes are spread over the frame range.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// What moves.
    pub node: String,
    /// Offsets from where it stands [m].
    pub translate: Vec<[f32; 3]>,
    /// Rotations about x, y and z [degrees].
    pub rotate_deg: Vec<[f32; 3]>,
}

/// The most frames that `temporal.reuse` may span.
const MAX_REUSE: u32 = 64;
const DEFAULT_REUSE: u32 = 3;

/// Reads `[temporal]`.
pub(super) fn read_temporal(field: &Field<'_>) -> Result<Temporal, ShotError> {
    let section = field.section()?;
    section.only(&["reuse"])?;
    Ok(Temporal {
        reuse: section.whole_or("reuse", DEFAULT_REUSE, 1..=MAX_REUSE)?,
    })
}

/// Reads `[animation]`.
pub(super) fn read_animation(field: &Field<'_>) -> Result<Animation, ShotError> {
    let section = field.section()?;
    section.only(&["fps", "move"])?;
    let expected = "a number > 0";
    let fps = section
        .require("fps", expected)?
        .real(expected, |x| x > 0.0)?;
    let moves = match section.get("move") {
        None => Vec::new(),
        Some(list) => list
            .list("a list of tables: [[animation.move]]")?
            .iter()
            .map(read_move)
            .collect::<Result<_, _>>()?,
    };
    Ok(Animation { fps, moves })
}

fn read_move(field: &Field<'_>) -> Result<Move, ShotError> {
    let section = field.section()?;
    section.only(&["node", "translate", "rotate_deg"])?;
    let node = "a node's name, camera, or a light such as light.0";
    let parsed = Move {
        node: section.require("node", node)?.text(node)?.to_owned(),
        translate: keyframes(&section, "translate")?,
        rotate_deg: keyframes(&section, "rotate_deg")?,
    };
    if parsed.translate.is_empty() && parsed.rotate_deg.is_empty() {
        section.require("translate", "translate or rotate_deg, a list of keyframes")?;
    }
    Ok(parsed)
}

fn keyframes(section: &Section<'_>, key: &str) -> Result<Vec<[f32; 3]>, ShotError> {
    let Some(field) = section.get(key) else {
        return Ok(Vec::new());
    };
    let expected = "a list of keyframes, three finite numbers each";
    let items = field.list(expected)?;
    if items.is_empty() {
        return Err(field.unexpected(expected));
    }
    items
        .iter()
        .map(|item| item.vec3("three finite numbers", |_| true))
        .collect()
}
