//! The `tyndall` command's parts: shots are read ([`shot`]), loaded ([`load`]), rendered ([`render`]),
//! and written ([`output`]) as they are or as a picture for people ([`picture`]).

pub mod args;
pub mod backend;
mod bench;
pub mod commands;
pub mod compare;
pub mod failure;
pub mod layer;
pub mod light_texture;
pub mod load;
pub mod measure;
pub mod metrics;
pub mod output;
pub mod picture;
pub mod progress;
pub mod render;
mod samples;
pub mod shot;
pub mod stats;
