//! Whole numbers that shaders declare and Rust must know too: they are written once, in the shader.

use std::{collections::HashMap, sync::LazyLock};

use super::{package::modules, scan::code};

static CONSTANTS: LazyLock<HashMap<&'static str, u32>> = LazyLock::new(|| {
    let lines = modules().iter().flat_map(|(_, text)| text.lines());
    lines.filter_map(constant_of).collect()
});

/// The name and value of `const NAME: u32 = 12u;`.
fn constant_of(line: &'static str) -> Option<(&'static str, u32)> {
    let (name, value) = code(line).strip_prefix("const ")?.split_once(": u32 = ")?;
    let digits = value.trim().strip_suffix(';')?.trim_end_matches('u');
    let value = match digits.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => digits.parse(),
    };
    Some((name, value.ok()?))
}

/// The value of the package's `const NAME: u32`.
///
/// # Panics
/// Where no module declares such a constant, which is a fault of this crate.
pub(crate) fn constant(name: &str) -> u32 {
    let found = CONSTANTS.get(name).copied();
    found.expect("a shader of the package declares the constant")
}
