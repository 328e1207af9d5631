//! Temporal reuse: a light's pixels that cannot have changed since the frame before are kept, by a wrapper about any
//! technique (after Lin 2012).
//!
//! Each light's in-scatter is kept in a picture of its own. Before a technique's last pass a mask of stale pixels is made
//! and left in a stencil; the last pass draws through it. Several lights are added up afterwards, so that a light that
//! stands still costs no more than its mask. A change of camera, medium, light, technique or of any input's size or place
//! makes all pixels stale.
//!
//! # Masks
//!
//! - **change** (default): needs no geometry. The shadow map and the depth buffer are compared with those of the frame
//!   before. A pixel is stale where its depth changed, or where its ray passes a shadow-map texel whose visibility changed,
//!   at a depth between the old and the new one. The texels' depth ranges are kept in a pyramid of blocks of 8 x 8; the beam
//!   of a tile of 8 x 8 pixels is held against it in 16 slabs, and those that meet a change in 8 parts each. All is rounded outwards: **a kept pixel is bit by bit what
//!   computing it again would give**, for any number of frames.
//! - **geometry**: the thesis's own. Moving occluders ([`LightInputs::occluders`](crate::LightInputs)) and their shadow
//!   volumes are drawn where they were in the frame before and where they are now. Pixels may be lost: those whose shadows
//!   differ from frame to frame for another reason than a listed occluder's movement. Hence a full frame every
//!   [`frames`](Reuse::frames) + 1 frames.
//!
//! The thesis has the beam of one shadow volume cover whatever the moving object shadows; a mask of change leaves out the
//! inside of a shadow that merely got another boundary.
//!
//! # What a pixel looks at
//!
//! `ray-march` and `hybrid` read the shadow map on the pixel's own ray, `hybrid` besides its bounds, which are compared as
//! well; `min-max` reads within half a pixel of it, or farther where `slices` is set by hand. `epipolar` interpolates
//! along lines across the whole picture, and `light-volume` merges cells of any size: there any stale pixel makes all of
//! them stale.
//!
//! What these do before their last pass (slices, trees, samples) is done only where any pixel is stale or the shadow map is
//! another one, by dispatches and draws whose sizes the GPU sets to zero; all but `hybrid`'s volumes, which the mask is
//! made from.
//!
//! # Switching itself off
//!
//! Where the mask covered more than 70 % of the picture, the next 30 frames compute all pixels without asking; then one frame
//! remembers depth and map, and the next one asks again. This is decided on the GPU: nothing is read back.
//!
//! # Cost
//!
//! 4 bytes a shadow-map texel (what the frame before saw), 12 bytes a pixel and the light's kept picture; one read of map
//! and depth. Lights through coloured glass are kept only while their maps' `shadow_revision` stays.

mod gate;
pub(crate) mod gpu;
mod history;

pub(crate) use history::{History, Signature};

/// What a view keeps of earlier frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reuse {
    /// Frames in a row that keep what is not stale; then all pixels are computed. `None`: no limit.
    pub frames: Option<u32>,
    /// How stale pixels are found.
    pub mask: ReuseMask,
    /// What the picture shows.
    pub show: ReuseShow,
}

/// How stale pixels are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReuseMask {
    /// By comparing depth and shadow map with those of the frame before: exact.
    Change,
    /// By drawing moving occluders and their shadow volumes, as Lin 2012 does; every light needs its occluders.
    Geometry,
}

/// What the picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReuseShow {
    /// The in-scattered light.
    Light,
    /// The pixels that were computed, 1 a light, in red.
    Mask,
    /// How long ago each was: blue now, then from green to red in 32 frames; a sum over the lights.
    Age,
}

impl Default for Reuse {
    /// The exact mask, without a limit.
    fn default() -> Self {
        Self {
            frames: None,
            mask: ReuseMask::Change,
            show: ReuseShow::Light,
        }
    }
}

/// How far from its own ray a pixel's last pass looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// So many pixels.
    Pixels(f32),
    /// Anywhere in the picture.
    Picture,
}
