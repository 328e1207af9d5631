//! The scene on the GPU: the inputs that an engine gives [`tyndall::Effect`] besides the frame.
//!
//! A [`SceneRenderer`] holds the uploaded scene and every pipeline; its methods only record passes on the caller's
//! encoder: a G-buffer, shadow maps, layers of coloured glass, and lit surfaces. It has a twin on the CPU
//! ([`crate::trace`], [`crate::shading`]), whose results it equals but for rasterisation and rounding.
//!
//! [`connect`] makes a device for callers without one; [`readback`] reads textures back as numbers.

mod binding;
mod device;
mod error;
mod g_buffer;
mod glass;
mod material;
mod mesh;
mod occluders;
mod pipeline;
mod points;
pub mod readback;
mod renderer;
mod shade;
mod shaders;
mod shadow_map;
mod targets;
mod texture;
mod uniforms;
mod uploaded;
mod view;

pub use device::{NoAdapter, connect};
pub use error::GpuSceneError;
pub use occluders::SceneOccluders;
pub use points::upload_point_cloud;
pub use renderer::SceneRenderer;
pub use shade::SurfaceLights;
pub use targets::{GBufferTargets, GlassMapTarget, ShadowMapTarget};
pub use texture::upload_light_texture;
