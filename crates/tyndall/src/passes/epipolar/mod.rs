//! Epipolar coordinates on the GPU: the grid of a light, lines on the image, and slices in a shadow map.

mod grid;

pub(crate) use grid::{EpipolarUniform, with_scene};
