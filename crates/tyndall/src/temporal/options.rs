//! Options of temporal reuse, as plain data.

/// Options of keeping pixels from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reuse {
    /// Frames in a row that keep pixels that are not stale; then all pixels are computed. `None`: no limit.
    pub frames: Option<u32>,
    /// The method that finds stale pixels.
    pub mask: ReuseMask,
    /// Tolerated error of a pixel that is kept while the camera moves, over the brightest value about it (> 0); `None`: a
    /// camera that moves makes all pixels stale.
    pub reproject: Option<f32>,
    /// The contents of the image.
    pub show: ReuseShow,
}

/// A method that finds stale pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReuseMask {
    /// By comparing depth and shadow map with those of the frame before: exact.
    Change,
    /// By drawing moving occluders and their shadow volumes, as Lin 2012 does; every light needs its occluders.
    Geometry,
}

/// The contents of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReuseShow {
    /// The in-scattered light.
    Light,
    /// The pixels that were computed, 1 a light, in red.
    Mask,
    /// The age of each: blue now, then from green to red in 32 frames; a sum over the lights.
    Age,
}

impl Default for Reuse {
    /// The exact mask, without a limit.
    fn default() -> Self {
        Self {
            frames: None,
            mask: ReuseMask::Change,
            reproject: None,
            show: ReuseShow::Light,
        }
    }
}
