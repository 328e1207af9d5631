//! Scenes for `tyndall`.

pub mod scene;
