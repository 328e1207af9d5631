//! Parameters of `min-max`, and its entry in the table.

use crate::epipolar::Resolution;
use crate::frame::LightKind;
use crate::techniques::{
    info::{Backends, Reads, TechniqueInfo},
    params::{Param, Parameters, Sliced, Slicing, param},
};

/// The entry in the table.
pub(crate) const INFO: TechniqueInfo = TechniqueInfo {
    name: "min-max",
    about: "1-D min-max mipmaps over epipolar slices, lit stretches in closed form",
    citation: "Chen, Baran, Durand & Jarosz, Real-Time Volumetric Shadows using 1D Min-Max Mipmaps, I3D 2011",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    lights_on_gpu_only: &[],
    backends: Backends::Both,
    reads: Reads {
        glass: true,
        textures: true,
        occluders: false,
        points: false,
    },
    shadows_surfaces: false,
    is_reference: false,
};

/// Integrals of lit stretches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// In closed form, or by quadrature where the light has a cone or a texture.
    #[default]
    Analytic,
    /// By the singular value decomposition of the integrand without visibility.
    Svd,
}

const INTEGRATORS: &[(&str, Integrator)] =
    &[("analytic", Integrator::Analytic), ("svd", Integrator::Svd)];

/// Content of the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// The in-scattered light.
    #[default]
    Light,
    /// Each slice in a colour of its own; black where rays have none.
    Slices,
    /// Lit stretches a ray: 0 black, then blue, red, yellow, 16 white.
    Segments,
    /// Nodes visited (red) and texels walked (green), in 128ths.
    Nodes,
    /// The rectified map: slices from top to bottom, light rays from left to right, S from black to white; red where
    /// the light never ends.
    Map,
}

const SHOWS: &[(&str, Show)] = &[
    ("light", Show::Light),
    ("slices", Show::Slices),
    ("segments", Show::Segments),
    ("nodes", Show::Nodes),
    ("map", Show::Map),
];

/// Parameters of `min-max`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Slices and samples.
    pub resolution: Resolution,
    /// Integral of lit stretches.
    pub integrator: Integrator,
    /// Terms of the `svd` integrator (1 to 16).
    pub rank: u32,
    /// Content of the image; the debug views on the GPU only.
    pub show: Show,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            resolution: Resolution::default(),
            integrator: Integrator::default(),
            rank: 4,
            show: Show::default(),
        }
    }
}

impl Sliced for Params {
    const SLICES: &'static str =
        "epipolar slices; 0: every ray within half a pixel of one, but at most 1024";
    const SAMPLES: &'static str =
        "cells a slice, rounded up to a power of two; 0: half the shadow map's texels a side";

    fn resolution(&self) -> &Resolution {
        &self.resolution
    }

    fn resolution_mut(&mut self) -> &mut Resolution {
        &mut self.resolution
    }
}

impl Parameters for Params {
    const INFO: TechniqueInfo = INFO;
    const PARAMS: &'static [&'static [Param<Self>]] = &[
        &[
            param!(choice integrator, INTEGRATORS,
                "how lit stretches are integrated",
                "\"analytic\" or \"svd\""),
            param!(whole rank, 1..=16, "terms of the svd integrator"),
            param!(choice show, SHOWS,
                "what is drawn: the light, or how it was found (GPU)",
                "\"light\", \"slices\", \"segments\", \"nodes\" or \"map\""),
        ],
        Slicing::<Self>::PARAMS,
    ];
}
