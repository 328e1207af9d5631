//! The module `phase::table`, which is made from the table of phase functions.

use crate::phase::{FILES, PhaseInfo, TABLE};

/// Imports every phase function, and calls the one of a number.
pub(super) fn phase_table() -> String {
    let imports: String = TABLE
        .iter()
        .zip(FILES)
        .map(|(info, file)| format!("import package::phase::{file}::{};\n", function(info)))
        .collect();
    let cases: String = TABLE.iter().enumerate().skip(1).map(case).collect();
    let first = TABLE.first().map(call).unwrap_or_default();
    format!(
        "// The phase functions, by their numbers in the table.

{imports}
// Bit n is set where phase function n may occur. Pipelines are made for those of their medium: drivers that run both sides
// of a branch run no others.
override MEDIUM_PHASES: u32 = 0xffffffffu;

// Value at cos(theta) [1/sr] of the phase function of this number, with its parameters in their order.
fn phase_evaluate(number: u32, parameters: vec2f, cos_theta: f32) -> f32 {{
    switch number {{
{cases}        default: {{}}
    }}
    return {first};
}}
"
    )
}

fn case((number, info): (usize, &PhaseInfo)) -> String {
    let (bit, call) = (1_u32 << number, call(info));
    format!(
        "        case {number}u: {{ if (MEDIUM_PHASES & {bit}u) != 0u {{ return {call}; }} }}\n"
    )
}

/// The name of the function in WGSL.
fn function(info: &PhaseInfo) -> String {
    format!("phase_{}", info.name.replace('-', "_"))
}

fn call(info: &PhaseInfo) -> String {
    let arguments: String = ["parameters.x, ", "parameters.y, "]
        .into_iter()
        .take(info.params.len())
        .collect();
    format!("{}({arguments}cos_theta)", function(info))
}
