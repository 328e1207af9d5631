//! Lin 2012, table 6.1: `hybrid` with and without temporal reuse while things move, and what each mask leaves stale.

mod films;
mod run;
mod stale;
mod time;
mod walk;

pub(super) use films::{Films, SCENES};
pub(super) use run::run;
