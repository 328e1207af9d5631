//! Nearest and farthest depth over squares of a shadow map's texels, on the GPU.

mod pyramid_build;

pub(crate) use pyramid_build::{Programs, Source, build};
