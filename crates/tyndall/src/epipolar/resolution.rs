//! Sampling of epipolar coordinates.

/// Slices that are taken where the half-pixel rule asks for more: leaves are exact, so that more only cost time.
pub(super) const DEFAULT_SLICES: usize = 1024;

/// Numbers of slices and samples; zeros choose by the image and the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Slices (0 to 16384); 0: every view ray within half a pixel of one, within the technique's own limits.
    pub slices: u32,
    /// Light rays or cells of them a slice (0 to 16384); 0: as the technique suits the map's texels a side.
    pub samples: u32,
    /// Radius about the axis within which rays are walked through the shadow map itself \[pixels] (0 to 100).
    pub epipole_radius: f64,
}

impl Resolution {
    /// The most slices there may be.
    #[cfg(feature = "gpu")]
    pub(crate) fn most_slices(&self) -> usize {
        match self.slices {
            0 => DEFAULT_SLICES,
            n => n as usize,
        }
    }

    /// Light rays a slice for a map of so many texels a side: a power of two.
    pub(crate) fn samples_of(&self, side: usize) -> usize {
        let samples = match self.samples {
            0 => side / 2,
            n => n as usize,
        };
        samples.next_power_of_two().clamp(64, 1 << 14)
    }
}

impl Default for Resolution {
    fn default() -> Self {
        Self {
            slices: 0,
            samples: 0,
            epipole_radius: 2.0,
        }
    }
}
