//! Temporal reuse: a light's pixels that cannot have changed since the frame before are kept, by a wrapper about any
//! technique (after Lin 2012).
//!
//! Each light's in-scatter is kept in a texture of its own. Before a technique's last pass a mask of stale pixels is made
//! and left in a stencil; the last pass draws through it. Several lights are added up afterwards, so that a light that
//! stands still costs no more than its mask. A change of medium, light, technique or of any input's size or place makes all
//! pixels stale; so does one of the camera, unless [`reproject`](Reuse::reproject) says how much may be wrong.
//!
//! # Masks
//!
//! - **change** (default): needs no geometry. The shadow map and the depth buffer are compared with those of the frame
//!   before. A pixel is stale where its depth changed, or where its ray passes a shadow-map texel whose visibility changed,
//!   at a depth between the old and the new one. The texels' depth ranges are kept in a pyramid of blocks of 8 x 8; the beam
//!   of a tile of 8 x 8 pixels is held against it in 16 slabs, and those that meet a change in 8 parts each. All is rounded
//!   outwards: **a kept pixel is bit by bit what computing it again would give**, for any number of frames.
//! - **geometry**: the thesis's own. Moving occluders ([`LightInputs::occluders`](crate::LightInputs)) and their shadow
//!   volumes are rasterised where they were in the frame before and where they are now, by tiles of 4 x 4 pixels. Pixels may
//!   be lost: those whose shadows differ from frame to frame for another reason than a listed occluder's movement. Hence a
//!   full frame every [`frames`](Reuse::frames) + 1 frames.
//!
//! The thesis has the beam of one shadow volume cover whatever the moving object shadows; a mask of change leaves out the
//! inside of a shadow that merely got another boundary.
//!
//! # What a pixel looks at
//!
//! `ray-march` and `hybrid` read the shadow map on the pixel's own ray, `hybrid` besides its bounds, which are compared as
//! well; `min-max` reads within half a pixel of it, or farther where `slices` is set by hand. `epipolar` interpolates
//! along lines across the whole image, and `light-volume` merges cells of any size: there any stale pixel makes all of
//! them stale.
//!
//! Their passes before the last one (slices, trees, samples) run only where any pixel is stale or the shadow map is
//! another one, by dispatches and draws whose sizes the GPU sets to zero; all but `hybrid`'s volumes, which the mask is
//! made from.
//!
//! # A camera that moves
//!
//! With a tolerance, pixels are looked up in the image of the frame before, where its camera saw the points at which their
//! rays end, bilinearly. A pixel keeps what is found there while the errors that it may have gathered since its light was
//! computed stay below the tolerance times the brightest value in its tile of 8 x 8 pixels. With each frame come up:
//!
//! - **the eye's movement**. Two cameras' rays to the same point collect integrals of f and f', the in-scattered light by
//!   the share of the distance to that point. The integral of |f - f'| is no less than their difference. A tile estimates it
//!   at 128 places in strata, shadows and all; three times the tile's mean is taken for each of its pixels. One frame's step
//!   is too short for few samples to meet with shadow edges: it is followed for 16 frames, and the sum divided by 16. By the
//!   triangle inequality 16 such frames add up to no less than what they change. Nothing for an eye that only turns.
//! - **looking up between pixels**. An image that is straight but for one bend, or one step, between two pixels is missed by
//!   at most the larger second difference at either; near a pixel by less, 8 a (1 - a) times at the share a of the distance
//!   between two. Both axes add up. A smooth image is missed by a sixteenth of that.
//! - **another depth**. Where the point lies before or behind what was seen there, that length times what a metre there
//!   scatters, unshaded. Beyond 5 % it is another surface, and the pixel is stale.
//! - **rounding** of the kept image (half floats: 2^-11).
//!
//! The errors of the pixels that are looked up between are mixed with the same weights as their values, which bounds the
//! mixture's. **Guaranteed** is that what was hidden, out of the image or of another surface is computed, and whatever sees
//! a shadow change on its new ray, by the mask above: nothing that moves leaves a ghost, were it there or gone. The sizes of
//! the other errors are **estimates**: the eye's movement by samples, the lookup by there being no shadow thinner than a
//! pixel. Errors are summed up by their sizes, of which most cancel: an image as a whole is wrong by a tenth of the tolerance or
//! less. In tests with exact techniques, no pixel of the sun's or a spot's halls exceeded it, the worst beside a lamp in the
//! image by a fifth. A technique whose own steps show as bands adds their jumps.
//!
//! Once the camera rests, all pixels are exact again eight frames later: in turns, tiles compute what was looked up.
//!
//! It pays where light is broad and shadows are soft to the eye's movement: of a crowd in the sun a third is computed, of
//! hills a thirtieth. In a church with thin shafts of light nine tenths stay stale, and looking costs more than it saves.
//!
//! This is for techniques whose pixels look at their own rays, and for lights other than rectangles; elsewhere a moving camera
//! makes all pixels stale. Of `hybrid`'s bounds no change is asked for: they move with the camera.
//!
//! # Switching itself off
//!
//! Once the mask covered more than 70 % of the image, the next 30 frames compute all pixels without asking; then one frame
//! remembers depth and map, and the next one asks again. While the camera moves it is 90 % and 4 frames. This is decided on
//! the GPU: nothing is read back.
//!
//! # Cost
//!
//! 4 bytes a shadow-map texel (what the frame before saw), 9 bytes a pixel and the light's kept texture; one read of map
//! and depth. Lights through coloured glass are kept only while their maps' `shadow_revision` stays. A camera that moves
//! takes another 16 bytes a pixel, four looks at the shadow map and twenty at the kept image.
//!
//! With a dragon that turns, 23 % of the pixels differ from frame to frame, and the mask of change covers 26 %. About
//! `hybrid` a frame is 1.3 times as fast (`results/lin.txt`): where the image changes is where the steps are, two thirds of its
//! last pass, and its volumes are found anew each frame. About `ray-march` it is 2.6 times. Tried: asking the quarters of a
//! tile that meets a change covered a thirtieth less and took half as long again to find.

mod blocks;
mod buffers;
mod change;
mod check;
mod decide;
mod frame;
mod gate;
mod history;
mod options;
mod passes;
mod programs;
mod reproject;
mod restore;
mod reuse;
mod show;
mod stencil;
mod sum;
mod tiles;
mod wrap;

pub(crate) use check::check;
pub(crate) use history::{History, Viewpoint};
pub use options::{Reuse, ReuseMask, ReuseShow};
pub(crate) use passes::passes;
