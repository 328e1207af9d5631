//! Textures back from the device, for tests and files. A frame that is only shown needs none of this.

use half::f16;
use wgpu::{Device, Queue, Texture, TextureFormat};

/// Reason why a texture could not be read.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadbackError {
    /// The texture's format is none that is read as the numbers asked for.
    #[error("a texture of format {found:?} cannot be read as {expected}")]
    Format {
        /// The numbers asked for.
        expected: &'static str,
        /// The texture's format.
        found: TextureFormat,
    },
    /// The copy is larger than the device's buffers.
    #[error(
        "reading the texture needs a buffer of {found} bytes; the device's `max_buffer_size` is {limit}"
    )]
    Size {
        /// Bytes needed.
        found: u64,
        /// The device's limit \[bytes].
        limit: u64,
    },
    /// The device was lost or could not map the buffer.
    #[error("the device failed while a texture was read: {0}")]
    Device(String),
}

/// The numbers of a float, half or depth texture: layer by layer, row by row from the top left, as many a texel as the
/// format has channels. Waits for the device.
///
/// # Errors
/// [`ReadbackError`]; formats other than `Depth32Float`, `R32Float`, `Rgba16Float` and `Rgba32Float` are not read.
pub fn texture_f32(
    device: &Device,
    queue: &Queue,
    texture: &Texture,
) -> Result<Vec<f32>, ReadbackError> {
    match texture.format() {
        TextureFormat::Depth32Float | TextureFormat::R32Float | TextureFormat::Rgba32Float => Ok(
            words(&texture_bytes(device, queue, texture)?, f32::from_le_bytes),
        ),
        TextureFormat::Rgba16Float => Ok(words(&texture_bytes(device, queue, texture)?, |bits| {
            f16::from_le_bytes(bits).to_f32()
        })),
        found => Err(ReadbackError::Format {
            expected: "f32",
            found,
        }),
    }
}

/// The numbers of an `R32Uint`, `Rg32Uint` or `Rgba32Uint` texture, in the order of [`texture_f32`]. Waits for the device.
///
/// # Errors
/// [`ReadbackError`].
pub fn texture_u32(
    device: &Device,
    queue: &Queue,
    texture: &Texture,
) -> Result<Vec<u32>, ReadbackError> {
    match texture.format() {
        TextureFormat::R32Uint | TextureFormat::Rg32Uint | TextureFormat::Rgba32Uint => Ok(words(
            &texture_bytes(device, queue, texture)?,
            u32::from_le_bytes,
        )),
        found => Err(ReadbackError::Format {
            expected: "u32",
            found,
        }),
    }
}

fn words<const N: usize, T>(bytes: &[u8], decode: impl Fn([u8; N]) -> T) -> Vec<T> {
    bytes
        .as_chunks()
        .0
        .iter()
        .map(|&chunk| decode(chunk))
        .collect()
}

/// The u32 at an offset [bytes, a multiple of 4] of a buffer of usage `COPY_SRC`. Waits for the device.
///
/// # Errors
/// [`ReadbackError::Device`].
pub fn buffer_u32(
    device: &Device,
    queue: &Queue,
    buffer: &wgpu::Buffer,
    offset: u64,
) -> Result<u32, ReadbackError> {
    let mappable = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read-back"),
        size: 4,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, offset, &mappable, 0, 4);
    queue.submit([encoder.finish()]);
    let numbers = words(&map(device, &mappable)?, u32::from_le_bytes);
    numbers
        .first()
        .copied()
        .ok_or_else(|| ReadbackError::Device("an empty buffer was mapped".into()))
}

/// The texels of level 0 of all layers, without padding.
fn texture_bytes(
    device: &Device,
    queue: &Queue,
    texture: &Texture,
) -> Result<Vec<u8>, ReadbackError> {
    let texel_bytes = texture.format().block_copy_size(None).unwrap_or(0);
    let row_bytes = texture.width() * texel_bytes;
    let padded_row_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let rows = u64::from(texture.height()) * u64::from(texture.depth_or_array_layers());
    let found = u64::from(padded_row_bytes) * rows;
    let limit = device.limits().max_buffer_size;
    if found > limit {
        return Err(ReadbackError::Size { found, limit });
    }

    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read-back"),
        size: found,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_row_bytes),
                rows_per_image: Some(texture.height()),
            },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);

    let padded = map(device, &buffer)?;
    Ok(padded
        .chunks_exact(padded_row_bytes as usize)
        .flat_map(|row| &row[..row_bytes as usize])
        .copied()
        .collect())
}

/// The bytes of a mappable buffer, once all work submitted before is done.
///
/// # Errors
/// [`ReadbackError::Device`].
pub fn map(device: &Device, buffer: &wgpu::Buffer) -> Result<Vec<u8>, ReadbackError> {
    let failed = |error: &dyn std::fmt::Display| ReadbackError::Device(error.to_string());
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver is gone only where polling failed, which is reported below.
        let _ = sender.send(result);
    });
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|e| failed(&e))?;
    receiver
        .recv()
        .map_err(|e| failed(&e))?
        .map_err(|e| failed(&e))?;
    let bytes = buffer
        .get_mapped_range(..)
        .map_err(|e| failed(&e))?
        .to_vec();
    buffer.unmap();
    Ok(bytes)
}
