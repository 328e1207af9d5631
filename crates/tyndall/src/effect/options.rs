//! Options that an effect is created with, and the errors of its creation.

/// Options that are fixed for the life of an [`Effect`](crate::Effect).
#[derive(Clone, Copy, Debug)]
pub struct EffectOptions {
    /// Format of the colour target that [`Effect::composite`](crate::Effect::composite) draws on; must be blendable.
    pub target_format: wgpu::TextureFormat,
    /// Format of [`EffectView::output`](crate::EffectView::output).
    pub output: OutputPrecision,
}

/// Format of the in-scattered light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPrecision {
    /// `Rgba16Float`, for images.
    Half,
    /// `Rgba32Float`, for measuring.
    Full,
}

impl OutputPrecision {
    pub(super) fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Half => wgpu::TextureFormat::Rgba16Float,
            Self::Full => wgpu::TextureFormat::Rgba32Float,
        }
    }
}

/// An effect or a view of it could not be created.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CreateError {
    /// The view is empty or larger than the device's textures.
    #[error("a view must be 1 to {limit} pixels a side, found {} x {}", size[0], size[1])]
    Size {
        /// The size asked for \[pixels].
        size: [u32; 2],
        /// The device's limit \[pixels].
        limit: u32,
    },
    /// The device cannot blend the target's format.
    #[error("the target format must be blendable on this device, found {format:?}")]
    NotBlendable {
        /// The format asked for.
        format: wgpu::TextureFormat,
    },
}
