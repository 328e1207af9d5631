//! Layers: contents of a picture besides the final image.

use clap::ValueEnum;

use crate::picture::Picture;

/// A layer of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Layer {
    /// surface * transmittance + inscatter [W/(m^2 sr)]
    Final,
    /// Light scattered towards the eye, without surface and background [W/(m^2 sr)]
    Inscatter,
    /// Share of the surface's light that reaches the eye, per channel
    Transmittance,
    /// The surface or the background, without the medium between it and the eye [W/(m^2 sr)]
    Surface,
    /// Distance along the view ray to the surface or the far plane in m, the same in all channels
    Depth,
}

impl Layer {
    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Final => "final",
            Self::Inscatter => "inscatter",
            Self::Transmittance => "transmittance",
            Self::Surface => "surface",
            Self::Depth => "depth",
        }
    }
}

/// Rendered layers, in the order they were asked for.
pub type Layers = Vec<(Layer, Picture)>;
