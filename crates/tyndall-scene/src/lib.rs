//! Scenes for `tyndall`.

pub mod geometry;
pub mod load;
pub mod scene;
pub mod texture;
pub mod trace;
pub mod view;
