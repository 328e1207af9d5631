//! The effect on a device, and readback of its output.

use tyndall::{Count, CountValue, Effect, EffectOptions, EffectView, OutputPrecision};
use tyndall_scene::gpu::readback;
use wgpu::{Device, Queue, TextureFormat};

use crate::{failure::Failure, picture::Picture, render::layers::rgb};

/// Counts of the technique in the frame that was recorded last. Waits for the device.
///
/// # Errors
/// [`Failure::Device`] where the device is lost.
pub(super) fn counts(
    view: &EffectView,
    device: &Device,
    queue: &Queue,
) -> Result<Vec<(String, u64)>, Failure> {
    let value = |value: &CountValue| match value {
        CountValue::Known(known) => Ok(*known),
        CountValue::Written { buffer, offset } => {
            readback::buffer_u32(device, queue, buffer, *offset).map(u64::from)
        }
    };
    let count = |count: &Count| Ok((count.name.clone(), value(&count.value)?));
    let counts: Result<_, readback::ReadbackError> = view.counts().iter().map(count).collect();
    counts.map_err(Failure::device)
}

/// The effect, with an output that is exact enough to be measured.
pub(super) fn new_effect(device: &Device, target_format: TextureFormat) -> Result<Effect, Failure> {
    let options = EffectOptions {
        target_format,
        output: OutputPrecision::Full,
    };
    Effect::new(device, &options).map_err(Failure::device)
}

/// 32-bit floats where they can be blended, for radiance of any range.
pub(crate) fn target_format(device: &Device) -> TextureFormat {
    if device
        .features()
        .contains(wgpu::Features::FLOAT32_BLENDABLE)
    {
        TextureFormat::Rgba32Float
    } else {
        TextureFormat::Rgba16Float
    }
}

/// The colours of an `Rgba32Float` texture.
pub(crate) fn picture(size: [u32; 2], channels: &[f32]) -> Picture {
    let (pixels, _) = channels.as_chunks::<4>();
    Picture {
        size,
        pixels: rgb(pixels),
    }
}
