//! Errors of scenes on a device.

/// Reason why a scene, or a target to draw it on, cannot be made on a device.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuSceneError {
    /// A texture is empty or larger than the device's.
    #[error("{what} must be 1 to {limit} texels a side (the device's `max_texture_dimension_2d`), found {} x {}", size[0], size[1])]
    TextureSize {
        /// The texture's name.
        what: String,
        /// Its size \[texels].
        size: [u32; 2],
        /// The device's limit \[texels].
        limit: u32,
    },
    /// A texture's pixels do not fill its size.
    #[error("{what} must have {expected} texels, found {found}")]
    TexelCount {
        /// The texture's name.
        what: String,
        /// Width times height.
        expected: usize,
        /// Number of texels there are.
        found: usize,
    },
    /// An array texture needs more layers than the device's.
    #[error(
        "{what} needs {found} array layers; the device's `max_texture_array_layers` is {limit}"
    )]
    TextureLayers {
        /// The texture's name.
        what: String,
        /// Layers needed.
        found: u32,
        /// The device's limit.
        limit: u32,
    },
    /// One buffer would have to be larger than the device's.
    #[error("{what} needs a buffer of {found} bytes; the device's `max_buffer_size` is {limit}")]
    BufferSize {
        /// The buffer's contents.
        what: String,
        /// Bytes needed.
        found: u64,
        /// The device's limit \[bytes].
        limit: u64,
    },
    /// Lights are added up by blending, which the device cannot do on this format.
    #[error("the device cannot blend on the target format {format:?}")]
    TargetFormat {
        /// The format asked for.
        format: wgpu::TextureFormat,
    },
}
