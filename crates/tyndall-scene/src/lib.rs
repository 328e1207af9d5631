//! Scenes for `tyndall`.

pub mod builtin;
pub mod geometry;
pub mod load;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod scene;
pub mod texture;
pub mod trace;
pub mod view;
