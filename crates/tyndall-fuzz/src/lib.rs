//! The bodies of tyndall's fuzz targets. Each takes any bytes and panics where the code it feeds does, or where what comes out
//! is neither an error nor finite; `fuzz/` hands them to libFuzzer, and `tests/kept.rs` runs them on the inputs that are kept.

mod draw;
mod folder;
pub mod frame;
pub mod gltf;
mod outcome;
mod picked;
pub mod picture;
pub mod shot;

pub use outcome::Outcome;
