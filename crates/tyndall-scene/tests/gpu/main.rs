//! The scene on the GPU, against closed forms and against its twin on the CPU.

mod known;
mod scenes;
mod twin;
