//! What the `tyndall` command is made of.

pub mod shot;
