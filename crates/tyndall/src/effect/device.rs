//! The effect of one device: pipelines and tables, and what is recorded.

use std::sync::atomic::Ordering;

use super::{
    options::{CreateError, EffectOptions},
    view::EffectView,
};
use crate::{
    gpu::{
        PassTimer,
        pool::{Owner, Pool},
        scope::Shared,
    },
    passes::composite::Composite,
};

/// The effect's pipelines. Immutable, one a device.
pub struct Effect {
    pub(super) shared: Shared,
    composite: Composite,
}

impl Effect {
    /// Lays out every pipeline. Those that depend on the kind of light are compiled when the first such light is
    /// prepared, and kept.
    ///
    /// # Errors
    /// Fails if the device cannot blend the target format.
    pub fn new(device: &wgpu::Device, options: &EffectOptions) -> Result<Self, CreateError> {
        let format = options.target_format;
        let features = format.guaranteed_format_features(device.features());
        if !features
            .flags
            .contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
        {
            return Err(CreateError::NotBlendable { format });
        }
        let shared = Shared::new(device, options.output.format());
        Ok(Self {
            composite: Composite::new(device, &shared, format),
            shared,
        })
    }

    /// Pipelines compiled so far on behalf of prepared frames. It grows with the first light of each kind, technique and
    /// medium's phase functions, and stays after that: where it grows while a game is played, a frame waits for a compiler.
    pub fn pipelines(&self) -> usize {
        self.shared.pipelines.load(Ordering::Relaxed)
    }

    /// Makes the textures of a camera of this size \[pixels].
    ///
    /// # Errors
    /// Fails if the size is zero or beyond the device's textures.
    pub fn create_view(
        &self,
        device: &wgpu::Device,
        size: [u32; 2],
    ) -> Result<EffectView, CreateError> {
        let limit = device.limits().max_texture_dimension_2d;
        if size.iter().any(|n| !(1..=limit).contains(n)) {
            return Err(CreateError::Size { size, limit });
        }
        let mut pool = Pool::default();
        let output = self.sum(device, &mut pool, size, 0);
        Ok(EffectView::new(size, pool, output))
    }

    /// Records the passes of the frame that was prepared last; none before the first.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &mut EffectView,
        mut timer: Option<&mut PassTimer>,
    ) {
        view.is_recorded = true;
        for pass in &view.passes {
            pass.record(encoder, timer.as_deref_mut());
        }
    }

    /// Draws target * transmittance + in-scatter in the caller's pass, exactly per channel. The pass has one colour
    /// target of [`EffectOptions::target_format`] and of the view's size, no depth and one sample; its alpha stays.
    pub fn composite(&self, pass: &mut wgpu::RenderPass<'_>, view: &EffectView) {
        if let Some(frame) = &view.composite {
            self.composite.draw(pass, frame);
        }
    }

    /// One of the two textures that sum up the lights.
    pub(super) fn sum(
        &self,
        device: &wgpu::Device,
        pool: &mut Pool,
        size: [u32; 2],
        which: usize,
    ) -> wgpu::TextureView {
        let name = ["in-scatter, even", "in-scatter, odd"][which];
        pool.attachment(device, (Owner::View, name), size, self.shared.output)
    }
}
