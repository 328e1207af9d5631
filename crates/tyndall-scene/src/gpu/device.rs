//! An adapter and a device, where the caller has none of its own.

use wgpu::{Adapter, Backends, Device, Features, Limits, PowerPreference, Queue};

/// Reason why there is no device.
#[derive(Clone, Debug, thiserror::Error)]
pub enum NoAdapter {
    /// No driver offers an adapter.
    #[error("no graphics adapter: {0}")]
    Adapter(#[from] wgpu::RequestAdapterError),
    /// The adapter refused to make a device.
    #[error("the graphics adapter gives no device: {0}")]
    Device(#[from] wgpu::RequestDeviceError),
}

/// Features to use if the adapter has them; none is required.
const WANTED: Features = Features::TIMESTAMP_QUERY
    .union(Features::FLOAT32_BLENDABLE)
    .union(Features::FLOAT32_FILTERABLE);

/// Connects to an adapter of a backend that has compute shaders (Vulkan, Metal, Direct3D 12), with the timestamps and
/// the 32-bit float blending and filtering it has, and textures and buffers as large as it allows.
/// wgpu's environment variables (`WGPU_BACKEND` and the like) are honoured.
///
/// # Errors
/// [`NoAdapter`] where there is no driver, or it makes no device.
pub fn connect(prefer: PowerPreference) -> Result<(Adapter, Device, Queue), NoAdapter> {
    pollster::block_on(connect_async(prefer))
}

async fn connect_async(prefer: PowerPreference) -> Result<(Adapter, Device, Queue), NoAdapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    // OpenGL is no fallback: it lacks features that the passes need, and a missing display makes its loader noisy.
    descriptor.backends = Backends::PRIMARY;
    let instance = wgpu::Instance::new(descriptor.with_env());
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: prefer,
            ..Default::default()
        })
        .await?;
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            label: Some("tyndall"),
            required_features: adapter.features() & WANTED,
            required_limits: limits(&adapter.limits()),
            ..Default::default()
        })
        .await?;
    Ok((adapter, device, queue))
}

/// WebGPU's default limits, but sizes of textures and buffers as far as the adapter goes.
fn limits(adapter: &Limits) -> Limits {
    Limits {
        max_texture_dimension_2d: adapter.max_texture_dimension_2d,
        max_texture_array_layers: adapter.max_texture_array_layers,
        max_buffer_size: adapter.max_buffer_size,
        max_storage_buffer_binding_size: adapter.max_storage_buffer_binding_size,
        ..Limits::default().or_worse_values_from(adapter)
    }
}
