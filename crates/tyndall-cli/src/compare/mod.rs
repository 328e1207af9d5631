//! The comparison of `tyndall compare`: numbers ([`Report`]), pictures and their errors ([`ErrorMap`]), and one page that
//! holds all of it ([`html`]).

mod error;
pub mod error_map;
pub mod files;
#[cfg(test)]
pub(crate) mod fixture;
mod gather;
pub mod html;
pub mod plot;
mod png;
pub mod report;
pub mod settings;

pub use error::FileError;
pub use error_map::ErrorMap;
pub use report::{Comparison, Report, Row, Setting, Subject};
