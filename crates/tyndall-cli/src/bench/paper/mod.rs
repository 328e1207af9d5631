//! A paper's tables: its scenes by its techniques, each against brute force at equal quality and in equal time.

mod maps;
mod quality;
mod run;
mod scene;
mod suite;

pub(super) use run::run;
pub(super) use suite::{Paper, REDUCTION, contender, nothing, reduced};
