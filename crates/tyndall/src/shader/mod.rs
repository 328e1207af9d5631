//! The shader package: WGSL modules of one topic each that import from each other, and a linker for them.
//!
//! A module is a `.wesl` file; its path is the file's in `src`, `tyndall::physics::medium` for `src/physics/medium.wesl`. It
//! begins with what it imports, in the syntax of [WESL](https://wesl-lang.dev). One has no file: `tyndall::phase::table`
//! follows from the [table of phase functions](crate::phase::TABLE).
//!
//! ```wgsl
//! import package::physics::medium::{medium_scattering, Medium};
//! ```
//!
//! The [`Linker`] joins a module with all that it imports, each module once, into plain WGSL. Names are not changed, so that
//! pipeline constants and entry points are found by the names in the files, and drivers' messages speak of these; a name
//! that two linked modules declare is an error.
//!
//! An engine's own shaders import from the package as well, by its name in place of `package`:
//!
//! ```
//! use tyndall::shader::Linker;
//!
//! let fog = "
//! import tyndall::phase::henyey_greenstein::phase_hg;
//! import tyndall::physics::transmittance::transmittance;
//!
//! fn fog_glow(distance: f32, cos_theta: f32) -> vec3f {
//!     return transmittance(vec3f(0.1), distance) * phase_hg(0.6, cos_theta);
//! }
//! ";
//! let wgsl = Linker::new().module("engine::fog", fog).link("engine::fog")?.wgsl;
//! assert!(wgsl.contains("fn phase_hg(g: f32, cos_theta: f32) -> f32"));
//! # Ok::<(), tyndall::shader::LinkError>(())
//! ```
//!
//! # What there is
//!
//! | module | what it has | reads bind group |
//! |---|---|---|
//! | `phase::isotropic`, `rayleigh`, `henyey_greenstein`, `cornette_shanks`, `draine` | a phase function each | |
//! | `phase::table` | all of them, by their numbers | |
//! | `physics::transmittance` | extinction along a path, and its integral | |
//! | `physics::medium` | scattering of the frame's medium | 0 |
//! | `physics::airlight` | airlight of point lights from the frame's tables | 0 |
//! | `camera::camera` | view rays, depth | 0 |
//! | `gpu::frame` | the frame itself, a pixel's ray, a triangle over the whole picture | 0 |
//! | `gpu::choice` | small numbers of uniforms that branches and loops hang on | 0 |
//! | `light::light` | how much of a light reaches a point, its texture, its cone | 0, 1 |
//! | `light::stretch` | light of a lit stretch of a view ray, in closed form | 0, 1 |
//! | `shadow::shadow` | shadow maps and coloured glass, looked up by points | 0, 1 |
//!
//! Bind groups 0 (the frame) and 1 (a light), and the pipeline constants of a light, come from
//! [`Bindings`](crate::gpu::Bindings); the engine's own are from 2 on. [`Linker::group`] moves them where 0 and 1 are taken.

mod block;
mod constants;
mod link;
mod package;
mod phases;
mod reflect;
mod scan;
#[cfg(test)]
pub(crate) mod tests;

pub(crate) use block::block;
pub(crate) use constants::constant;
pub use link::{LinkError, Linked, Linker};
pub use package::modules;
pub(crate) use reflect::Reflection;
