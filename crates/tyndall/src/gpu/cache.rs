//! Programs by their type: made once an effect, whoever asks.

use std::sync::Arc;

use super::{by_type::Held, shared::Shared};

/// Programs that belong together: those of a technique, or of passes that several techniques use.
pub(crate) trait Programs: Held {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self;
}

impl Shared {
    /// The effect's programs of this type.
    pub(crate) fn programs<P: Programs>(&self, device: &wgpu::Device) -> Arc<P> {
        self.by_type.get(|| P::new(device, self))
    }
}
