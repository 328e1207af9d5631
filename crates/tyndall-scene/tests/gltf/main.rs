//! Loading glTF: features that are read, files that are refused and how, and all sample files there are.

// A test says that something is wrong by panicking.
#![allow(clippy::unwrap_used, clippy::panic)]

mod broken;
mod document;
mod features;
mod files;
