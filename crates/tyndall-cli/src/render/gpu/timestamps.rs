//! Milliseconds a pass, from the device's timestamps.
//!
//! A pass is taken to last from the end of the pass before it, for its own first timestamp may come late: lavapipe writes
//! that of a compute pass when the work is done. An empty pass marks where the first one begins.

use tyndall::gpu::PassTimer;
use tyndall_scene::gpu::readback;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device, Queue};

use crate::failure::Failure;

/// More passes than this go untimed.
const TIMED_PASSES: u32 = 2048;

/// A timer of passes with the buffers its ticks are read through; does nothing where the device has no timestamps.
pub(crate) struct Timestamps(Option<Timed>);

struct Timed {
    timer: PassTimer,
    resolved: Buffer,
    mappable: Buffer,
}

impl Timestamps {
    pub(crate) fn new(device: &Device) -> Self {
        Self(PassTimer::new(device, TIMED_PASSES).map(|timer| {
            let buffer = |label, usage| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: timer.resolved_bytes(),
                    usage,
                    mapped_at_creation: false,
                })
            };
            let resolve = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
            let map = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
            Timed {
                resolved: buffer("timestamps", resolve),
                mappable: buffer("timestamps to read", map),
                timer,
            }
        }))
    }

    /// Times nothing.
    pub(crate) fn none() -> Self {
        Self(None)
    }

    /// The timer of the next passes.
    pub(crate) fn timer(&mut self) -> Option<&mut PassTimer> {
        self.0.as_mut().map(|timed| &mut timed.timer)
    }

    /// Forgets the passes of the frame before, and marks where the next ones begin.
    pub(crate) fn begin(&mut self, encoder: &mut CommandEncoder) {
        if let Some(timer) = self.timer() {
            timer.reset();
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("start of the passes"),
                timestamp_writes: timer.compute_pass("start"),
            });
        }
    }

    /// Ends a frame's passes: their ticks are there once the encoder's work is done.
    pub(crate) fn resolve(&self, encoder: &mut CommandEncoder) {
        if let Some(timed) = &self.0 {
            let bytes = timed.resolved.size();
            timed.timer.resolve(encoder, &timed.resolved);
            encoder.copy_buffer_to_buffer(&timed.resolved, 0, &timed.mappable, 0, bytes);
        }
    }

    /// Each pass's name and milliseconds, in order, once they were resolved. Waits for the device.
    ///
    /// # Errors
    /// [`Failure::Device`] where the device is lost.
    pub(crate) fn read(
        &self,
        device: &Device,
        queue: &Queue,
    ) -> Result<Vec<(String, f64)>, Failure> {
        let Some(Timed {
            timer, mappable, ..
        }) = &self.0
        else {
            return Ok(Vec::new());
        };
        let bytes = readback::map(device, mappable).map_err(Failure::device)?;
        let period = f64::from(queue.get_timestamp_period()) * 1e-6;
        let (ticks, _) = bytes.as_chunks::<8>();
        let ends: Vec<u64> = ticks
            .chunks_exact(2)
            .map(|pass| u64::from_le_bytes(pass[1]))
            .collect();
        let milliseconds = ends
            .windows(2)
            .map(|pair| pair[1].saturating_sub(pair[0]) as f64 * period);
        let names = timer.names().iter().skip(1).cloned();
        Ok(names.zip(milliseconds).collect())
    }
}
