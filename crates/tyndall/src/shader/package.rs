//! The modules of the package.

/// Every module of the package, its path and its text, for other linkers of WESL.
pub const MODULES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shader_modules.rs"));
