//! The GPU that tests run on: by default a software driver, because tolerances were measured on one.
//!
//! `TYNDALL_TEST_DRIVER` picks the adapter whose name or driver holds that word, e.g. `llvmpipe`, `SwiftShader` or `NVIDIA`.
//! `VK_ICD_FILENAMES`, read by the Vulkan loader itself, picks a driver that is not installed.

use crate::skip::{in_ci, skip};
use std::sync::{OnceLock, mpsc};

const DRIVER_VARIABLE: &str = "TYNDALL_TEST_DRIVER";

/// Taken where the adapter has them. The library needs none of them.
const OPTIONAL_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::FLOAT32_BLENDABLE);

/// A device with WebGPU's default limits, shared by all tests of a program.
pub struct TestDevice {
    /// What the device runs on.
    pub info: wgpu::AdapterInfo,
    /// The device. An error that nobody asks for panics, and so fails the test.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// Why there is no device to test on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Missing {
    /// No driver was found.
    #[error("no GPU driver found; `cargo xtask test` installs or names one")]
    Driver,
    /// The adapter that was asked for is not there.
    #[error("{DRIVER_VARIABLE}: expected an adapter named `{wanted}`, found {found}")]
    Wanted {
        /// The word it was asked for by.
        wanted: String,
        /// The adapters there are, joined by commas.
        found: String,
    },
    /// The adapter gave no device.
    #[error("{adapter} gives no device: {reason}")]
    Device {
        /// The adapter's name.
        adapter: String,
        /// What it says.
        reason: String,
    },
}

impl Missing {
    /// True where tests may skip themselves: nobody asked for a certain driver, and this is no continuous integration run.
    pub fn is_excused(&self) -> bool {
        *self == Self::Driver && !in_ci()
    }
}

/// Why the device's memory could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadBackError {
    /// The device was lost, or did not finish.
    #[error("the device did not finish its work: {0}")]
    Poll(#[from] wgpu::PollError),
    /// The memory was not mapped.
    #[error("the buffer cannot be mapped: {0}")]
    Map(String),
}

impl TestDevice {
    /// Waits for the work submitted so far and returns a buffer (usage `COPY_SRC`, size a multiple of 4 bytes) as values of `T`.
    ///
    /// # Errors
    /// Where the device does not finish its work.
    pub fn read_buffer<T: bytemuck::Pod>(
        &self,
        buffer: &wgpu::Buffer,
    ) -> Result<Vec<T>, ReadBackError> {
        let staging = self.staging(buffer.size());
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        self.map(&staging, |bytes| bytemuck::pod_collect_to_vec(bytes))
    }

    /// Waits for the work submitted so far and returns the first mip level of a texture (usage `COPY_SRC`, uncompressed,
    /// one aspect) as values of `T`: layer by layer, row by row, without padding.
    ///
    /// # Errors
    /// Where the device does not finish its work.
    pub fn read_texture<T: bytemuck::Pod>(
        &self,
        texture: &wgpu::Texture,
    ) -> Result<Vec<T>, ReadBackError> {
        let texel = texture.format().block_copy_size(None).unwrap_or(4);
        let row = texture.width() * texel;
        let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let rows = texture.height() * texture.depth_or_array_layers();
        let staging = self.staging(u64::from(stride) * u64::from(rows));
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(stride),
                    rows_per_image: Some(texture.height()),
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        self.map(&staging, |bytes| {
            let rows = bytes.chunks_exact(stride as usize);
            let packed: Vec<u8> = rows
                .flat_map(|bytes| &bytes[..row as usize])
                .copied()
                .collect();
            bytemuck::pod_collect_to_vec(&packed)
        })
    }

    fn staging(&self, size: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    fn map<R>(
        &self,
        staging: &wgpu::Buffer,
        read: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, ReadBackError> {
        let (sender, receiver) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver outlives the poll below.
            let _ = sender.send(result);
        });
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let map_error = |error: &dyn std::fmt::Display| ReadBackError::Map(error.to_string());
        receiver
            .recv()
            .map_err(|e| map_error(&e))?
            .map_err(|e| map_error(&e))?;
        Ok(read(
            &staging.get_mapped_range(..).map_err(|e| map_error(&e))?,
        ))
    }
}

/// The device that all tests of this program share.
///
/// # Errors
/// Where there is no driver, not the one that was asked for, or it does not work.
pub fn device() -> Result<&'static TestDevice, Missing> {
    static DEVICE: OnceLock<Result<TestDevice, Missing>> = OnceLock::new();
    DEVICE
        .get_or_init(|| open_blocking(OPTIONAL_FEATURES))
        .as_ref()
        .map_err(Missing::clone)
}

fn open_blocking(optional: wgpu::Features) -> Result<TestDevice, Missing> {
    let wanted = std::env::var(DRIVER_VARIABLE).ok();
    pollster::block_on(open(wanted.as_deref(), optional))
}

/// The device, or `None` after saying aloud that `test` is skipped.
///
/// # Panics
/// Where the device is missing without [excuse](Missing::is_excused).
pub fn device_or_skip(test: &str) -> Option<&'static TestDevice> {
    or_skip(test, device())
}

/// A device of its own with none of the optional features, or `None` as [`device_or_skip`].
///
/// # Panics
/// As [`device_or_skip`].
pub fn plain_device_or_skip(test: &str) -> Option<TestDevice> {
    or_skip(test, open_blocking(wgpu::Features::empty()))
}

#[allow(clippy::panic, reason = "a test fails by panicking")]
fn or_skip<D>(test: &str, device: Result<D, Missing>) -> Option<D> {
    match device {
        Ok(device) => Some(device),
        Err(missing) if missing.is_excused() => {
            skip(test, &missing.to_string());
            None
        }
        Err(missing) => panic!("{test}: {missing}"),
    }
}

async fn open(wanted: Option<&str>, optional: wgpu::Features) -> Result<TestDevice, Missing> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = instance.enumerate_adapters(wgpu::Backends::PRIMARY).await;
    let infos: Vec<_> = adapters.iter().map(wgpu::Adapter::get_info).collect();
    let chosen = choose(&infos, wanted)?;
    let (adapter, info) = (&adapters[chosen], infos[chosen].clone());
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            label: Some("tyndall tests"),
            required_features: adapter.features() & optional,
            ..wgpu::DeviceDescriptor::default()
        })
        .await
        .map_err(|error| Missing::Device {
            adapter: info.name.clone(),
            reason: error.to_string(),
        })?;
    Ok(TestDevice {
        info,
        device,
        queue,
    })
}

/// Index of the adapter to test on: the one that was asked for, else a software one, else the first.
fn choose(adapters: &[wgpu::AdapterInfo], wanted: Option<&str>) -> Result<usize, Missing> {
    if let Some(wanted) = wanted {
        return adapters
            .iter()
            .position(|info| is_named(info, wanted))
            .ok_or_else(|| Missing::Wanted {
                wanted: wanted.to_owned(),
                found: list(adapters),
            });
    }
    adapters
        .iter()
        .position(|info| info.device_type == wgpu::DeviceType::Cpu)
        .or((!adapters.is_empty()).then_some(0))
        .ok_or(Missing::Driver)
}

fn is_named(info: &wgpu::AdapterInfo, word: &str) -> bool {
    let word = word.to_lowercase();
    [&info.name, &info.driver, &info.driver_info]
        .iter()
        .any(|text| text.to_lowercase().contains(&word))
}

fn list(adapters: &[wgpu::AdapterInfo]) -> String {
    if adapters.is_empty() {
        return "none".to_owned();
    }
    let names: Vec<_> = adapters.iter().map(|info| info.name.as_str()).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::util::DeviceExt;
    use wgpu::{AdapterInfo, Backend, DeviceType};

    fn adapter(name: &str, device_type: DeviceType) -> AdapterInfo {
        AdapterInfo {
            name: name.to_owned(),
            ..AdapterInfo::new(device_type, Backend::Vulkan)
        }
    }

    #[test]
    fn software_is_preferred_unless_another_is_asked_for() {
        let hardware = adapter("Radeon", DeviceType::DiscreteGpu);
        let software = adapter("llvmpipe (LLVM 15)", DeviceType::Cpu);
        let both = [hardware.clone(), software];
        assert_eq!(choose(&both, None), Ok(1));
        assert_eq!(choose(&both, Some("radeon")), Ok(0));
        assert_eq!(choose(&both, Some("LLVMPIPE")), Ok(1));
        assert_eq!(choose(&[hardware], None), Ok(0));
    }

    #[test]
    fn textures_are_read_back_without_padding() {
        let Some(gpu) = device_or_skip("TestDevice::read_texture") else {
            return;
        };
        // 3 texels of 4 bytes a row: padded to 256 on the device.
        let texels: Vec<f32> = (0..3 * 2 * 2_u8).map(f32::from).collect();
        let texture = gpu.device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: 3,
                    height: 2,
                    depth_or_array_layers: 2,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::R32Float,
                usage: wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(&texels),
        );
        assert_eq!(gpu.read_texture::<f32>(&texture).unwrap(), texels);
    }

    #[test]
    fn an_adapter_that_is_not_there_is_named() {
        assert_eq!(choose(&[], None), Err(Missing::Driver));
        let found = |adapters: &[AdapterInfo]| {
            choose(adapters, Some("swiftshader"))
                .unwrap_err()
                .to_string()
        };
        assert!(!choose(&[], Some("swiftshader")).unwrap_err().is_excused());
        assert!(found(&[]).contains("`swiftshader`, found none"));
        assert!(found(&[adapter("Radeon", DeviceType::DiscreteGpu)]).contains("found Radeon"));
    }
}
