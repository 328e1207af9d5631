//! The scene as rays see it: hits, exact shadows on view rays, G-buffers and shadow maps, in f64 on all cores.
//!
//! | file | what |
//! |---|---|
//! | `tracer` | the scene made ready for rays: hits, glass, blocked or not |
//! | `bvh` | the tree and its traversals |
//! | `triangle` | watertight ray against triangle |
//! | `surface` | a material's blocking and tinting of light |
//! | `sweep` | the exact stretches of a view ray that surfaces shade |
//! | `texels` | a textured surface's tint along a line |
//! | `g_buffer` | a camera's depth, normals and colours |
//! | `map_rays` | the rays through a shadow map's texels |
//! | `shadow_map` | a light's depths |
//! | `glass_map` | a light's layers of coloured glass |
//! | `points` | the surfaces that block light as points |

mod bvh;
mod g_buffer;
mod glass_map;
mod map_rays;
mod points;
mod shadow_map;
mod surface;
mod sweep;
mod texels;
mod tracer;
mod triangle;

pub use g_buffer::GBuffer;
pub use glass_map::GLASS_LAYERS;
pub use tracer::{GlassHit, Hit, Tracer};

#[cfg(test)]
mod tests;
