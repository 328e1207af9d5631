//! What all passes of an effect share.

use std::sync::{Arc, atomic::AtomicUsize};

use super::{bindings::Bindings, by_type::ByType, shader::Shaders};

/// What all passes of an effect share.
pub(crate) struct Shared {
    pub(crate) bindings: Bindings,
    /// Format of the in-scattered light.
    pub(crate) output: wgpu::TextureFormat,
    pub(crate) shaders: Shaders,
    /// Programs, by their types.
    pub(super) by_type: ByType,
    /// Pipelines made so far.
    pub(crate) pipelines: Arc<AtomicUsize>,
}

impl Shared {
    pub(crate) fn new(device: &wgpu::Device, output: wgpu::TextureFormat) -> Self {
        Self {
            bindings: Bindings::new(device),
            output,
            shaders: Shaders::default(),
            by_type: ByType::default(),
            pipelines: Arc::default(),
        }
    }
}
