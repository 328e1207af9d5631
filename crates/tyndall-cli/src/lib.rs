//! What the `tyndall` command is made of: shots are read ([`shot`]), loaded ([`setup`]), rendered ([`render`]),
//! and written ([`output`]) as they are or as a picture for people ([`picture`]).

pub mod args;
mod bench;
pub mod commands;
pub mod compare;
pub mod failure;
pub mod layer;
pub mod light_texture;
pub mod measure;
pub mod metrics;
pub mod output;
pub mod picture;
pub mod progress;
pub mod render;
mod samples;
pub mod sequence;
pub mod setup;
pub mod shot;
pub mod stats;
