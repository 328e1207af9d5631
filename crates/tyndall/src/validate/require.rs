//! Refusals that name the field, what was expected and what was found.

use glam::DVec3;

use crate::{error::PrepareError, physics::reals};

pub(super) type Checked = Result<(), PrepareError>;

pub(super) fn require(
    holds: bool,
    field: impl Into<String>,
    expected: &'static str,
    found: impl std::fmt::Debug,
) -> Checked {
    if holds {
        return Ok(());
    }
    Err(PrepareError::OutOfRange {
        field: field.into(),
        expected,
        found: format!("{found:?}"),
    })
}

/// Shorter vectors have no direction in f32.
pub(super) fn direction(field: &str, value: [f32; 3]) -> Checked {
    let length = reals(value).length();
    require(
        length.is_finite() && length > 1e-18,
        field,
        "a finite vector that is not zero",
        value,
    )
}

pub(super) fn not_parallel(
    field: &str,
    value: [f32; 3],
    other: [f32; 3],
    expected: &'static str,
) -> Checked {
    direction(field, value)?;
    let cross = reals(value)
        .normalize()
        .cross(reals(other).normalize_or(DVec3::ZERO));
    require(cross.length() > 1e-6, field, expected, value)
}
