//! Scenes for `tyndall`.

pub mod animation;
pub mod builtin;
pub mod framing;
pub mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod load;
pub mod scene;
pub mod shading;
pub mod shadow_fit;
#[cfg(test)]
mod test_scenes;
pub mod texture;
pub mod trace;
pub mod view;
