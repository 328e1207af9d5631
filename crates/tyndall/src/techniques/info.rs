//! A technique's entry in the table, as plain data.

use crate::frame::LightKind;

/// Which backends a technique runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backends {
    /// CPU only.
    Cpu,
    /// GPU only.
    Gpu,
    /// Both.
    Both,
}

impl Backends {
    /// True where `one` of them, [`Cpu`](Self::Cpu) or [`Gpu`](Self::Gpu), is among these.
    pub fn include(self, one: Self) -> bool {
        self == Self::Both || self == one
    }
}

/// The optional inputs of a light that a technique reads; a caller need not make the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reads {
    /// Coloured glass.
    pub glass: bool,
    /// Light textures.
    pub textures: bool,
    /// Meshes that block the light (`LightInputs::occluders`).
    pub occluders: bool,
    /// Point clouds of the surfaces about rectangular lights (`LightInputs::points`).
    pub points: bool,
}

/// A technique's entry in the table.
#[derive(Clone, Copy, Debug)]
pub struct TechniqueInfo {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// One line: what it is.
    pub about: &'static str,
    /// Where it was published.
    pub citation: &'static str,
    /// The kinds of light it can do.
    pub lights: &'static [LightKind],
    /// Those of them that it can do on the GPU alone.
    pub lights_on_gpu_only: &'static [LightKind],
    /// Where it runs.
    pub backends: Backends,
    /// The inputs it reads besides depth and shadow maps.
    pub reads: Reads,
    /// True where it also shadows surfaces (`EffectView::surface_light_visibility`).
    pub shadows_surfaces: bool,
    /// True of the oracle that the others are measured against.
    pub is_reference: bool,
}

impl TechniqueInfo {
    /// True where it can do this kind of light on this backend ([`Backends::Cpu`] or [`Backends::Gpu`]).
    pub fn can(&self, kind: LightKind, backend: Backends) -> bool {
        self.backends.include(backend)
            && self.lights.contains(&kind)
            && !(backend == Backends::Cpu && self.lights_on_gpu_only.contains(&kind))
    }
}

/// How far from its own ray a pixel's last pass looks.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// At most so many pixels.
    Pixels(f32),
    /// Anywhere in the image.
    Image,
}
