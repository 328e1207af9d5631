//! Temporal reuse: a light's pixels that cannot have changed since the frame before are kept, by a wrapper about any
//! technique (after Lin 2012).
//!
//! Each light's in-scatter is kept in a picture of its own. Before a technique's last pass a mask of stale pixels is made
//! and left in a stencil; the last pass draws through it. Several lights are added up afterwards, so that a light that
//! stands still costs no more than its mask. A change of medium, light, technique or of any input's size or place makes all
//! pixels stale; so does one of the camera, unless [`reproject`](Reuse::reproject) says how much may be wrong.
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
//! # A camera that moves
//!
//! With a tolerance, pixels are looked up in the picture of the frame before, where its camera saw the points at which their
//! rays end, bilinearly. A pixel keeps what is found there while the errors it may have gathered since its light was computed,
//! over its value (of the brightest channel), stay within the tolerance. With each frame's step these come up:
//!
//! - **the eye's way**. The two cameras' rays to the same point P collect integral of f over [0, 1], f the in-scattered light by
//!   the share of the way to P. The integral of |f - f'| is no less than the difference of the two. It is estimated for tiles
//!   of 8 x 8 pixels at 128 places in strata, shadows and all, twice its mean over the tile is taken, and the eye's step is
//!   followed for 16 frames and the sum divided by 16: a step is too short to meet with shadow edges. By the triangle
//!   inequality 16 such frames in a row bound what they change. Nothing for a camera that only turns.
//! - **looking up between pixels**. A picture that is straight but for one bend between two pixels is missed by at most
//!   2 a (1 - a) times the larger of the second differences at either, at a the share of the way between them; it is the
//!   sum over both axes. A smooth picture is missed by a quarter of that.
//! - **another depth**. Where the point lies before or behind what was seen there, that length times what a metre there
//!   scatters at most. Beyond 5 % it is another surface, and the pixel is stale.
//! - **rounding** of the kept picture (half floats: 2^-11).
//!
//! Errors of neighbours are mixed with the weights of their values, which bounds the mixture's. So it is guaranteed that what
//! was out of the picture or hidden, and whatever sees a shadow change on its new ray (the mask above), is computed: nothing
//! that moves leaves a ghost. The size of the other errors rests on estimates: of the eye's way on samples, of the lookup on
//! there being no edge thinner than a pixel. A camera that rests has all pixels exact again eight frames later.
//!
//! This is for techniques that compute pixel by pixel, and for lights other than rectangles; others compute all pixels.
//!
//! # Switching itself off
//!
//! Where the mask covered more than 70 % of the picture, the next 30 frames compute all pixels without asking; then one frame
//! remembers depth and map, and the next one asks again. This is decided on the GPU: nothing is read back.
//!
//! # Cost
//!
//! 4 bytes a shadow-map texel (what the frame before saw), 12 bytes a pixel and the light's kept picture; one read of map
//! and depth. Lights through coloured glass are kept only while their maps' `shadow_revision` stays. A camera that moves
//! takes another 16 bytes a pixel, four looks at the shadow map and twenty at the kept picture.

mod gate;
pub(crate) mod gpu;
mod history;

pub(crate) use history::{History, Signature, Viewpoint};

/// What a view keeps of earlier frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reuse {
    /// Frames in a row that keep what is not stale; then all pixels are computed. `None`: no limit.
    pub frames: Option<u32>,
    /// How stale pixels are found.
    pub mask: ReuseMask,
    /// What may be wrong with a pixel that is kept while the camera moves, over its value (> 0); `None`: a camera that moves
    /// makes all pixels stale.
    pub reproject: Option<f32>,
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
            reproject: None,
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
