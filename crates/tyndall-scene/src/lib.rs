//! Scenes for `tyndall`.

pub mod load;
pub mod scene;
