//! The scene on the GPU, against closed forms and against its twin on the CPU.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod known;
mod lit;
mod scenes;
mod shifted;
mod support;
mod twin;
mod whole;
