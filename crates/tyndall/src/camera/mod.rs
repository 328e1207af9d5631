//! View rays and the depth buffer: the points of the world that a pixel sees.

mod rays;

pub use rays::{CameraRays, Ray};
