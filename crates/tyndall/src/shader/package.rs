//! The modules of the package.

use std::sync::LazyLock;

use super::phases::phase_table;

/// A module's path and its text.
type Module = (&'static str, &'static str);

const FILES: &[Module] = include!(concat!(env!("OUT_DIR"), "/shader_modules.rs"));

static PHASE_TABLE: LazyLock<String> = LazyLock::new(phase_table);

static MODULES: LazyLock<Vec<Module>> = LazyLock::new(|| {
    let generated = [("tyndall::phase::table", PHASE_TABLE.as_str())];
    FILES.iter().copied().chain(generated).collect()
});

/// Every module of the package, its path and its text, for other linkers of WESL.
pub fn modules() -> &'static [(&'static str, &'static str)] {
    &MODULES
}
