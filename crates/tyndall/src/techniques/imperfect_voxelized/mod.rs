//! `ivsv`: imperfect voxelized shadow volumes, soft shadows of a rectangular light (Wyman and Dai 2013).
//!
//! The light is taken as point samples, each with a voxelized shadow volume of its own (see `vsv`). So many samples blur what
//! each has wrong, so that each may be coarse; and coarse ones can be made all at once. A frame has seven passes, however
//! many the samples (more only where the device binds no buffer that is large enough for all):
//!
//! 1. **sample light**: Halton's points of the rectangle, each with its share of the light, in the colour of its texture;
//! 2. **splat points** and 3. **pull-push**: a hemispherical shadow map a sample, made of its own block of the caller's
//!    [`PointCloud`](crate::PointCloud), see `passes/imperfect/`;
//! 4. **voxelize**: each map resampled to its sample's epipolar grid, one voxel a light ray;
//! 5. **scan**: the OR along the light rays of all grids;
//! 6. **gather**: each pixel adds up what it sees of every sample; 7. **resolve** writes the output.
//!
//! # What is integrated
//!
//! Per sample, over the columns of the pixel's row, with `xi` the angle at the sample between the light ray and the
//! perpendicular to the view ray, at height h:
//!
//! ```text
//! L = I / h integral V exp(-sigma_t (s + d)) sigma_s rho(-sin xi) cos(emitter) d xi,   s = t_p + h tan xi
//! ```
//!
//! Columns are steps of equal angle, so that 1 / d^2 is in the measure. The rest under the integral is smooth, and is
//! taken in the middle of eight panels a row, times the share of lit voxels in each. Visibility is interpolated between the two
//! nearest slices; along the columns a ray's ends cut voxels, which count in part.
//!
//! - `weighting = "airlight"` weighs each panel's voxels with that panel's light; `"uniform"` takes the share of lit voxels
//!   of the entire row, as the paper's pseudocode does. They cost the same. Relative error before ray-traced donuts: 0.0152
//!   and 0.0180.
//! - `gather = "interleaved"`: a pixel takes a ninth of the samples, and 3 x 3 of them are put together where their depths are
//!   alike; `"quarter"` gathers one pixel of 2 x 2. Errors there: 0.0191 and 0.0199.
//! - A ray near a sample's axis compares distances in the sample's map, as `vsv` does.
//!
//! # Shadows on surfaces
//!
//! If they are asked for ([`EffectView::set_surface_shadows`](crate::EffectView::set_surface_shadows)), two more passes
//! read the same voxels: **light surfaces** adds up what every sample would send to the end of a pixel's ray, and what of it
//! arrives, and **resolve surfaces** divides the one by the other. A voxel is interpolated between two slices and two
//! columns, not between rows, along which a shadow has one edge (section 3.3). Pixels take samples as `gather` says. Lest
//! surfaces shadow themselves, points are moved one row, and one texel of the sample's map and as far again as the surface
//! slopes in it, towards the sample; moved off their surfaces or by the paper's fixed biases, shadows on a floor were
//! displaced or came off.
//!
//! Relative error of the lit surfaces against tracing 256 samples, 160 x 120 pixels: of the donuts 0.075, with maps of 256^2
//! texels 0.060, unshadowed 0.196; of a ball of thin tubes 0.038, unshadowed 0.472. Most of the donuts' is creases smaller
//! than three texels of a map, which leak. It costs half as much time as gathering the volume's light, and nothing where
//! nobody asks.
//!
//! # Error
//!
//! Against ray-traced truth (256 samples of its own), donuts and a dragon under a ceiling panel, 80 x 60 pixels; maps of as
//! many texels a side as voxels:
//!
//! ```text
//! samples   64^3     128^3    256^3
//!      16   0.0409   0.0356   0.0333
//!      64   0.0260   0.0206   0.0181
//!     256   0.0204   0.0152   0.0129
//!    1024   0.0175   0.0125   0.0103
//! ```
//!
//! Much of what is left is the image of the light itself: rays that pass the samples see them one by one, in the truth as
//! here. Marching each sample's own map (`ray-march`, 64 steps) is 0.0150 wrong. Against the reference, both with 64
//! samples, 160 x 120 pixels: an angel 0.028 (marched 0.040), a ball of thin tubes 0.027 (0.035), a city of 800 m under a
//! panel of 18 m 0.043 (0.056).
//!
//! # Parameters
//!
//! - `resolution`: slices, view rays and light rays of each grid. The maps' texels a side are the caller's, `shadow_map` of
//!   a shot.
//! - `points`: the cloud's that each map takes; 0 takes as many as a map has texels. With many more, every texel that a border
//!   passes is taken for blocked; with fewer, each stands for a disc of several texels, and what is thin grows fat. Of 128^2
//!   texels, 8192, 16384 and 65536 points are 0.0147, 0.0152 and 0.0162 wrong of the donuts, 0.038, 0.027 and 0.033 of the
//!   tubes.
//! - `batched = false`: five passes a sample, the paper's naive form, with the same image to the last bit.
//!
//! # Cost
//!
//! `results/wyman-dai.txt` has the paper's tables on a software driver, 320 x 240 pixels. With 256 samples the naive form runs
//! 1282 passes where this runs 7. That saves the overhead of the others, which on the paper's device was 15 to 25 times
//! the work of a coarse sample in them (0.23 ms a pass against 0.014 ms of voxels), and on the software driver, which starts a
//! dispatch by calling it, 0.4 to 0.8 ms against 0.1 to 0.2 ms of work on two cores. So the paper's ratios of table 1 (18.6,
//! 16.6, 25.8, 2.0 for maps, voxels, scan and gather, 5.6 for a frame) come out as 3.1, 3.1, 9.6, 1.7 and 2.0: the table beside
//! says for each stage what a pass costs besides its work, and what it would have to. At the paper's overheads (0.25, 0.23 and
//! 0.45 ms) and 30 times as fast at the work, the same counts give 36, 39 and 140. Saving work rather than passes saves as
//! much as in the paper: interleaved gathering 7.9 times (6.3 there), a frame with it 7 to 9 times over the naive form (20
//! there, where the naive form's overhead counts).
//!
//! A thread of the gather takes two pixels, so that what it reads of a sample serves both; gathered interleaved, a
//! workgroup's pixels lie three apart, so that all of them take the same samples and read neighbouring rows of the same
//! grids. With many words of voxels, a thread scans one by itself and reads it once.
//!
//! 256 grids of 128^3 voxels are 64 MiB, four times one grid of 512^3, and their light rays sixteen times as many. A frame,
//! gathered interleaved, takes 3.4 times one of a lamp with `vsv` at 512^3.
//!
//! # Tried
//!
//! Four panels a row: a quarter of the time to gather less, error 0.018 in place of 0.015. Points as entire discs in place of
//! half their radius: occluders grew fat, 0.022 at 16384 points. Pull-push by workgroups of 16 x 16 with barriers: three
//! times as slow as a block of 4 x 4 a thread. Four panels with the density's slope in each: a tenth less time to gather,
//! error 0.018, and 0.016 with a guess of its curvature. Voxels that a ray's ends cut counted entirely: a twentieth less,
//! 0.016. Useless on the software driver: directions of panels by rotation in place of cosine and sine, a loop over words
//! around that over panels, stores only of words that a scan changes.
//!
//! # Where it fails
//!
//! Surfaces thinner than the cloud is dense leak; so do shadows on surfaces within three texels of what casts them;
//! occluders nearer to the light than some twenty times the distance between points grow fat or get holes. Coloured glass
//! tints nothing. Rays through the light itself show its samples. On the CPU it is refused by name.

#[cfg(feature = "gpu")]
mod buffers;
#[cfg(feature = "gpu")]
mod gather;
#[cfg(feature = "gpu")]
mod gpu;
mod params;
#[cfg(feature = "gpu")]
mod rectify;
#[cfg(feature = "gpu")]
mod resolve;
#[cfg(feature = "gpu")]
mod surface;
#[cfg(feature = "gpu")]
mod surface_resolve;

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
