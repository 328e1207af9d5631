//! `epipolar`: epipolar sampling with 1-D min/max trees (Engelhardt & Dachsbacher 2010; Yusov 2012).
//!
//! Shafts run along the lines of the image that meet at the light's place on it, the epipole. Along a line the light
//! varies slowly but where depths break. So rays are marched at a few samples of each line, more where depths break, and
//! the rest is interpolated. All rays of a line lie in one plane with the light, and see one row of the shadow map; a tree
//! of (min, max) over the row finds their lit stretches in few steps.
//!
//! The article's stages: slice end points; linear depth and coordinate texture (the depth of every sample); refinement and
//! marking (which samples are marched); slice directions and min/max tree; ray marching; interpolation; unwarping to a
//! texture `downscale` times smaller, by a filter that is bilinear as far as depths are alike; correction of the pixels that
//! have no such samples; upscaling and a second correction where the texture is smaller; the phase function. Each is a pass,
//! but for linear depth, which is had from the depth buffer wherever it is needed, and for those named in one breath. At full
//! resolution unwarping and the phase function are one pass too, and corrected pixels are drawn once more, as points; not so
//! where pixels are kept from frame to frame, since there the last pass alone draws.
//!
//! Differences from the article:
//!
//! - Samples hold the mean visibility, and that is interpolated: the light that is seen as a share of what would be seen if
//!   nothing blocked it, `L = v(pixel) L_unshadowed(pixel)`. The article takes the phase function of the sun out of the interpolation; this
//!   takes out the dependence on depth, the peak beside a local light and a spot's cone, too. Light that nothing blocks is
//!   exact. Relative error on 1280 x 960 pixels of terrain: 5e-4.
//! - In its slice a ray is a straight line over columns of the shadow map, in the coordinates (t, z) that perspective keeps
//!   straight; one that crosses a texel's depth is lit in part. So rays near the epipole, that cross few columns, need no
//!   other treatment. Both texels of a column that the slice's trace crosses count, as far as it does: with one texel a
//!   column shadows end up to half a texel beside their place, and a church's error does not fall below 0.022 however fine
//!   the slices are (0.0024 with both). A cube map is resampled on the fly to two charts of 90 degrees a slice, half a
//!   column a texel.
//! - Nodes are compared with the same numbers as columns, and lit columns that adjoin make one stretch, integrated in closed
//!   form: with trees and without (`tree`) results are equal bit by bit.
//! - Slices are spread over the part of the border that lines end on, not all of it; lines begin a twentieth of a pixel
//!   beside an epipole on the image, and go a pixel beyond its rim.
//! - A corrected pixel is marched in its two slices' trees instead of step by step, and weighted like an interpolated one.
//!
//! `initial_step` and `threshold` trade time for error: the same terrain with 4 and 0.01 has an error of 2e-4 for a
//! few milliseconds more. Textures and coloured glass are looked up column by column of every lit stretch.
//!
//! Tried, 1280 x 960 pixels on a software driver:
//!
//! - Samples integrated by the trees of technique `min-max`, over the rectified shadow map, in place of algorithm 2, which
//!   Chen et al. suggest. The trees cost more than they save: terrain with a 4096^2 map 260 ms for trees and marching, a
//!   church 590, against 66 and 142; with a 1024^2 map 65 and 130, against 24 and 48. Errors are those of interpolation
//!   either way: church 0.0227, through a rose window 0.0535 against 0.0540.
//! - Values and depths of samples in one texture in place of two buffers: unwarping takes half as long.
//! - Unwarping and phase function in one pass, the texture between them left out: 0.6 of the time of both and of linear depth,
//!   0.7 to 0.8 of the entire frame. Half of what is left is the filter, half the light of a pixel.
//! - Correction within that pass, in a loop that only pixels without sources go through: 1.9 times as long, for drivers that
//!   run through a loop once before they ask whether any pixel does. As a list it takes a fiftieth of the frame.
//! - Refinement and marking in one pass: three quarters of the time of both.
//!
//! Cost: slices x map side texels for the trees, some nodes a marched sample, and a few texels a pixel: most of the time
//! goes into the stages over pixels.
//!
//! Limits: shadows finer than the slices are apart are blurred across them, and ends of shafts between two marched
//! samples are blurred along them: breaks are looked for in depths, not in shadows. It shows where little else is seen, as
//! from below a ground whose shadow map lets light through between its texels. Images of thin leaves have a depth break at
//! most samples: all are marched.

#[cfg(feature = "gpu")]
mod coordinates;
#[cfg(feature = "gpu")]
mod correct;
#[cfg(feature = "gpu")]
mod finish;
#[cfg(feature = "gpu")]
mod finish_points;
#[cfg(feature = "gpu")]
mod gpu;
#[cfg(feature = "gpu")]
mod interpolate;
#[cfg(feature = "gpu")]
mod march_samples;
mod params;
#[cfg(feature = "gpu")]
mod refine;
#[cfg(feature = "gpu")]
mod resources;
#[cfg(feature = "gpu")]
mod sizes;
#[cfg(feature = "gpu")]
mod slice_directions;
#[cfg(feature = "gpu")]
mod slice_ends;
#[cfg(feature = "gpu")]
mod tree;
#[cfg(feature = "gpu")]
mod unwarp;
#[cfg(feature = "gpu")]
mod unwarp_finish;
#[cfg(feature = "gpu")]
mod upscale;
#[cfg(feature = "gpu")]
mod view;

pub use params::*;

#[cfg(feature = "gpu")]
use crate::techniques::method::GpuMethod;
use crate::techniques::method::Method;

impl Method for Params {
    #[cfg(feature = "gpu")]
    fn gpu(&self) -> Option<&dyn GpuMethod> {
        Some(self)
    }
}
