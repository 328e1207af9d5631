//! Backends: the CPU, or a device and the errors that it reports.

mod adapter;
mod choice;
mod errors;
mod quiet;

pub use adapter::AdapterDescription;
pub use choice::{Backend, BackendChoice, Gpu};
