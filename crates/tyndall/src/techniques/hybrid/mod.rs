//! `hybrid`: closed forms where shadow volumes say that there is no shadow, steps where there may be one (Wyman &
//! Ramsey 2008, as Lin 2012 uses it).
//!
//! The boundaries of the occluders' shadow volumes are drawn once, without depth test, for the nearest and the farthest
//! piece on each pixel's ray. Before the nearest, d1, and behind the farthest, d2, all is lit:
//!
//! ```text
//! L = A(0..d1) + (march d1..d2 through the shadow map) + A(d2..D)
//! ```
//!
//! with A the unshadowed light of a stretch in closed form (Chen 2011, eq. 1; Sun et al. 2005 for local lights; see
//! `light/stretch.wgsl`). Rays that no volume touches take no step at all. The paper divides its steps over d1..d2; here
//! they keep the length they have in [`ray-march`](super::ray_march), D / `steps`, so that a short shadow costs little and
//! is as exact.
//!
//! # The volumes
//!
//! - The caller hands over the occluders as triangles ([`Occluder`](crate::Occluder), in
//!   [`LightInputs::occluders`](crate::LightInputs)): all that may block the light, or a shadow is missed. Without them
//!   nothing bounds the shadows, and the whole ray is marched. Nothing need be closed, manifold or oriented.
//! - Silhouettes are found on the GPU, from edges that were listed when the mesh was uploaded, and only they are drawn; walls
//!   reach to infinity by homogeneous coordinates, so that no far plane cuts them off. Edges and triangles that the shadow
//!   map shows to lie in the shadow of others, a thousandth of their distance apart, are left out.
//! - Where the ray enters a shadow a piece bounds d1, where it leaves d2. A ray that enters and never leaves ends in the
//!   shadow: d2 = D. A compute pass asks whether a triangle lies between eye and light; then d1 = 0.
//! - Bounds are never too small: a piece whose orientation or distance rounding decides counts for both, at the outer end of
//!   what it may be. They are kept as shares of D in half floats, which every device blends, rounded outwards by 1/512.
//!
//! # Parameters
//!
//! - `steps`: over the whole ray's reach (512); a middle takes its share.
//! - `show`: the light, or the bounds: nearest (red), farthest (green) and the marched stretch (blue) [m].
//!
//! # Cost
//!
//! A look at every edge and triangle, the fragments of the silhouettes' walls, and the steps of the middles. Four half floats a
//! pixel; 12 bytes a corner and a triangle and 16 an edge, shared by all places of a mesh, and 8 an element of each place. The
//! walls are what costs: on a software driver those of a dragon of 200 000 triangles, 640 x 480 pixels, about as much as
//! 500 steps a ray.
//!
//! # Where it fails
//!
//! Shadows in the map of what is not among the occluders are lit outside d1..d2. A forest of leaves has a silhouette an
//! edge, and its middles are whole rays. Lights through pictures or coloured glass tint what is outside the volumes: their
//! rays are marched whole. Orthographic rays start anywhere: their d1 is 0 where they meet a volume at all.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;

use super::{
    Backends, LightKind, Technique, TechniqueInfo,
    params::{Param, Parameters, param},
};

/// The entry in the table.
pub(super) const INFO: TechniqueInfo = TechniqueInfo {
    name: "hybrid",
    about: "silhouette shadow volumes bound the shadows: closed forms outside, steps between",
    citation: "Wyman & Ramsey, Interactive Volumetric Shadows in Participating Media with Single-Scattering, IEEE Interactive Ray Tracing 2008",
    lights: &[LightKind::Directional, LightKind::Point, LightKind::Spot],
    backends: Backends::Gpu,
    default: || Technique::Hybrid(Params::DEFAULT),
};

/// Parameters of `hybrid`.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Steps over a whole ray (1 to 65536).
    pub steps: u32,
    /// What the picture shows.
    pub show: Show,
}

/// What the picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The in-scattered light.
    Light,
    /// Where the marched stretch begins (red), ends (green), and how long it is (blue) [m].
    Bounds,
}

const SHOWS: &[(&str, Show)] = &[("light", Show::Light), ("bounds", Show::Bounds)];

impl Params {
    const DEFAULT: Self = Self {
        steps: 512,
        show: Show::Light,
    };
}

impl Default for Params {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Parameters for Params {
    const TECHNIQUE: &'static str = INFO.name;
    const PARAMS: &'static [&'static [Param<Self>]] = &[&[
        param!(whole steps, 1..=65536, "steps over a whole ray"),
        param!(choice show, SHOWS,
            "the light, or front and back distances of the shadow volumes",
            "\"light\" or \"bounds\""),
    ]];
}
