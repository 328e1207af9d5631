//! Scenes for `tyndall`.

pub mod load;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod scene;
