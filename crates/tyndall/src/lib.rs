//! Real-time volumetric shadows in single-scattering media: the shafts of light and darkness that stand in fog, smoke,
//! dust and air where something blocks the light.
//!
//! An engine hands over its depth buffer and its shadow maps, and gets back the light scattered towards the eye and the
//! transmittance of the medium. The library makes no device, opens no window, submits, polls and reads back nothing.
//! For each pixel it computes (Chen et al. 2011, equation 1)
//!
//! `L = integral from 0 to d of exp(-sigma_t s) V(s) sum over components of sigma_s rho(theta) L_in(s) ds`
//!
//! with the distance `d` of what the pixel sees, the light's visibility `V`, the phase function `rho` and the light
//! `L_in` that arrives. The picture is then `surface * exp(-sigma_t d) + L`.
//!
//! # Techniques
//!
//! All compute this one integral; [`techniques::TABLE`] lists them for programs.
//!
//! | name | what it is | lights | runs on |
//! |---|---|---|---|
//! | [`ray-march`](techniques::ray_march) | brute force: N steps a ray, each looked up in the shadow map | directional, point, spot; rectangle on the GPU | GPU, CPU |
//! | [`min-max`](techniques::min_max) | 1-D min-max mipmaps over epipolar slices, lit stretches in closed form | directional, point, spot | GPU, CPU |
//! | [`light-volume`](techniques::light_volume) | the shadow map as a closed mesh, drawn additively with signed airlight | directional, point, spot, without textures | GPU |
//! | [`epipolar`](techniques::epipolar_sampling) | few rays marched along epipolar lines with 1-D min/max trees, the rest interpolated | directional, point, spot | GPU |
//! | [`hybrid`](techniques::hybrid) | silhouette shadow volumes bound the shadows: closed forms outside, steps between | directional, point, spot | GPU |
//! | [`vsv`](techniques::voxelized) | voxelized shadow volumes: bits over epipolar space | directional, point, spot | GPU |
//! | [`ivsv`](techniques::imperfect_voxelized) | imperfect voxelized shadow volumes: an area light as many coarse grids | rectangle | GPU |
//! | [`incremental`](techniques::incremental) | partial sums over epipolar slices, rays in order of their angle | directional, point, without textures | CPU |
//! | [`reference`](techniques::reference) | exact visibility and f64 quadrature to a stated tolerance | directional, point, spot, rectangle | CPU |
//!
//! On the GPU, temporal reuse (`temporal`) goes about any of them: pixels that nothing has changed for are kept.
//!
//! # Quick start on the CPU
//!
//! ```
//! use tyndall::{
//!     cpu::{self, CpuInputs, CpuLightInputs},
//!     frame::{Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase},
//!     techniques::TechniqueChoice,
//! };
//!
//! let frame = Frame {
//!     camera: Camera::perspective([0.0, 1.7, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 1.0, 2.0, 0.1, 50.0),
//!     lights: vec![Light {
//!         emitter: Emitter::Directional { direction: [0.3, -1.0, 0.2], illuminance: [10.0; 3] },
//!         shadow: None, // or how the shadow map in the inputs was made
//!         texture: None,
//!     }],
//!     medium: Medium {
//!         components: vec![MediumComponent {
//!             sigma_s: [0.02; 3],
//!             sigma_a: [0.002; 3],
//!             phase: Phase::HenyeyGreenstein { g: 0.4 },
//!         }],
//!     },
//! };
//! let inputs = CpuInputs {
//!     size: [8, 4],
//!     depth: &[0.0; 32], // the camera's depth is reversed: nothing is hit
//!     lights: &[CpuLightInputs::default()],
//!     occluders: None,
//! };
//! let picture = cpu::render(&frame, &inputs, &TechniqueChoice::default(), &|_done, _total| ())?;
//! let [r, g, b, transmittance] = picture.pixels[0];
//! assert!(r > 0.0 && r == g && g == b && transmittance < 1.0);
//! # Ok::<(), tyndall::PrepareError>(())
//! ```
#![cfg_attr(feature = "gpu", doc = include_str!("quick_start.md"))]
//!
//! # Conventions
//!
//! - World space is right-handed. Lengths are metres, angles radians, colours linear RGB.
//! - Matrices are named `to_from_from` (`clip_from_world`), are column-major and map to z in [0, 1].
//! - Pixel (0, 0) is the top left. A pixel's ray goes through its centre and ends at the first surface or at the far plane.
//! - Depth buffers are standard, reversed, or reversed with an infinite far plane ([`frame::DepthRange`]).
//! - The cosine of a phase function is between the way light travels and the way it is scattered: g > 0 scatters forward.
//! - Errors name the field, what was expected and what was found. No field is silently ignored.
//!
//! # Current limits
//!
//! - Single scattering in a homogeneous medium that fills all space.
//! - The medium takes nothing from directional light on its way; other lights are attenuated.
//! - Visibility is as good as the shadow map; only the `reference` can trace the scene instead.
//! - Light in-scattered behind coloured glass is not tinted by the glass on its way to the eye.
//! - Rectangular lights are for `ivsv`, `ray-march` on the GPU and the `reference`.
//! - No WebGL: the passes need compute shaders.
//!
//! # Features
//!
//! - `gpu` (default): the passes on wgpu. Without it the library needs no driver and no graphics crate.

pub mod camera;
pub mod cpu;
#[cfg(feature = "gpu")]
mod effect;
pub mod epipolar;
mod error;
pub mod frame;
#[cfg(feature = "gpu")]
pub mod gpu;
mod inputs;
mod integrate;
pub mod light;
#[cfg(feature = "gpu")]
mod mesh;
#[cfg(feature = "gpu")]
mod passes;
pub mod phase;
pub mod physics;
#[cfg(feature = "gpu")]
pub mod shader;
pub mod shadow;
pub mod techniques;
#[cfg(feature = "gpu")]
pub mod temporal;
mod validate;

#[cfg(feature = "gpu")]
pub use effect::{CreateError, Effect, EffectOptions, EffectView, OutputPrecision};
pub use error::PrepareError;
#[cfg(feature = "gpu")]
pub use inputs::{Count, CountValue, FrameInputs, LightInputs, PointCloud, SurfaceShadows};
#[cfg(feature = "gpu")]
pub use mesh::{Occluder, OccluderError, OccluderMesh};
