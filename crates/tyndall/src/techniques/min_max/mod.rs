//! `min-max`: 1-D min-max mipmaps (Chen, Baran, Durand, Jarosz 2011).
//!
//! Light and view rays of one slice through the eye and the light meet in one plane. The shadow map, resampled to
//! slices, becomes one row S[gamma] a slice, and a point of the view ray beta at the light ray gamma is lit iff
//! beta < S[gamma]: a search in one dimension, sped up by a complete binary tree of (min, max) over the row. The tree is
//! traversed without recursion, up at most one level a step, and adjoining shadowed nodes make one stretch (the paper's
//! section 3.3). Each lit stretch is integrated in closed form (its section 4.3), or by quadrature where the light has a
//! cone or a picture.
//!
//! - `slices`: how many; 0 takes as many as put every view ray within half a pixel of one (the paper's rule), and at
//!   least as many as the shadow map has texels a side: small pictures of fine shadows show the half pixel. Relative
//!   error of a 160 x 120 picture of a hall behind a window grid, 2048^2 map: 0.053 by the half-pixel rule alone,
//!   0.012 with 1500 slices, 0.0083 with 3000; of the map itself 0.0065.
//! - `samples`: of gamma, a slice; 0 takes as many as the shadow map has texels a side. They are spread over what the
//!   slice's view rays see of the map, slice by slice.
//! - `epipole_radius`: view rays within so many pixels of the axis cross few samples; they are walked through the shadow
//!   map itself. So is every ray where the eye is at the light.
//!
//! Cost: slices x samples texels to rectify, twice as many nodes; then some nodes a border between light and shadow.
//!
//! Where it fails: a ray takes its slice's shadow, up to half a pixel beside it, and shadow borders fall on samples of
//! gamma. Orthographic cameras have no such slices and are walked.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
mod svd;

use super::{
    Backends, LightKind, Technique, TechniqueInfo,
    params::{Param, Parameters, Sliced, Slicing, Value, word},
};
use crate::epipolar::Resolution;

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "min-max",
    about: "1-D min-max mipmaps over epipolar slices, lit stretches in closed form",
    citation: "Chen, Baran, Durand & Jarosz, Real-Time Volumetric Shadows using 1D Min-Max Mipmaps, I3D 2011",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    backends: Backends::Both,
    default: || Technique::MinMax(Params::default()),
};

/// How lit stretches are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// In closed form, or by quadrature where the light has a cone or a picture.
    #[default]
    Analytic,
    /// By the singular value decomposition of the integrand without visibility.
    Svd,
}

const INTEGRATORS: &[(&str, Integrator)] =
    &[("analytic", Integrator::Analytic), ("svd", Integrator::Svd)];

/// Parameters of `min-max`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Slices and samples.
    pub resolution: Resolution,
    /// How lit stretches are integrated.
    pub integrator: Integrator,
    /// Terms of the `svd` integrator (1 to 16).
    pub rank: u32,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            resolution: Resolution::default(),
            integrator: Integrator::default(),
            rank: 4,
        }
    }
}

impl Sliced for Params {
    fn resolution(&self) -> &Resolution {
        &self.resolution
    }

    fn resolution_mut(&mut self) -> &mut Resolution {
        &mut self.resolution
    }
}

impl Parameters for Params {
    const TECHNIQUE: &'static str = INFO.name;
    const PARAMS: &'static [&'static [Param<Self>]] = &[
        &[
            Param {
                key: "integrator",
                about: "how lit stretches are integrated",
                range: "\"analytic\" or \"svd\"",
                get: |p| word(&p.integrator, INTEGRATORS),
                set: |p, v| {
                    p.integrator = v.choice(INTEGRATORS)?;
                    Some(())
                },
            },
            Param {
                key: "rank",
                about: "terms of the svd integrator",
                range: "a whole number from 1 to 16",
                get: |p| Value::Integer(p.rank.into()),
                set: |p, v| {
                    p.rank = v.integer(1..=16)?;
                    Some(())
                },
            },
        ],
        Slicing::<Self>::PARAMS,
    ];
}
