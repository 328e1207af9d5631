//! What the `tyndall` command is made of.

pub mod args;
pub mod failure;
pub mod layer;
pub mod light_texture;
pub mod output;
pub mod picture;
pub mod progress;
pub mod shot;
