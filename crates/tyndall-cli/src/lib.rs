//! What the `tyndall` command is made of.

pub mod layer;
pub mod output;
pub mod picture;
pub mod shot;
