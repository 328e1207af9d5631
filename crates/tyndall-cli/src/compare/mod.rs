//! What `tyndall compare` tells: numbers ([`Report`]), pictures ([`Picture`]s and their error, [`ErrorMap`]),
//! and one page that holds all of it ([`html`]).

pub mod error_map;
pub mod files;
#[cfg(test)]
pub(crate) mod fixture;
mod gather;
pub mod html;
pub mod plot;
pub mod report;
pub mod settings;

pub use error_map::ErrorMap;
pub use report::{Report, Row, Setting, Subject};

use crate::picture::Picture;

/// A report and the pictures that it is about.
pub struct Comparison {
    /// The numbers.
    pub report: Report,
    /// In-scattered radiance that is taken for true [W/(m^2 sr)].
    pub reference: Picture,
    /// In-scattered radiance of each of the report's rows [W/(m^2 sr)].
    pub pictures: Vec<Picture>,
}
