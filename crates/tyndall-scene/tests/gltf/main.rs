//! Loading glTF: what is read, what is refused and how, and whatever files there are.

// A test says that something is wrong by panicking.
#![allow(clippy::unwrap_used, clippy::panic)]

mod broken;
mod document;
mod features;
mod files;
