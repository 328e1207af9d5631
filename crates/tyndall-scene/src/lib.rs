//! Scenes for `tyndall`.

#[cfg(feature = "gpu")]
pub mod gpu;
pub mod scene;
