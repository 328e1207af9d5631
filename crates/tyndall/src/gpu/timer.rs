//! Timestamps round named passes, for callers that measure a frame's cost.

/// Collects the timestamps that passes write. The owner makes it, resolves it after recording and reads the buffer.
pub struct PassTimer {
    queries: wgpu::QuerySet,
    names: Vec<String>,
    capacity: u32,
}

impl PassTimer {
    /// A timer for at most `passes` passes (further ones go untimed); `None` where the device has no timestamps.
    pub fn new(device: &wgpu::Device, passes: u32) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let capacity = passes.min(wgpu::QUERY_SET_MAX_QUERIES / 2);
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("tyndall pass timer"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * capacity,
        });
        Some(Self {
            queries,
            names: Vec::new(),
            capacity,
        })
    }

    /// Forgets the passes of the frame before.
    pub fn reset(&mut self) {
        self.names.clear();
    }

    fn next(&mut self, name: &str) -> Option<u32> {
        let index = self.names.len() as u32;
        (index < self.capacity).then(|| {
            self.names.push(name.to_owned());
            2 * index
        })
    }

    /// The timestamps of the next render pass.
    pub fn render_pass(&mut self, name: &str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let first = self.next(name)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// The timestamps of the next compute pass.
    pub fn compute_pass(&mut self, name: &str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let first = self.next(name)?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Names of the passes timed since the last reset, in order.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Bytes the resolve buffer must have.
    pub fn resolved_bytes(&self) -> u64 {
        u64::from(2 * self.capacity) * u64::from(wgpu::QUERY_SIZE)
    }

    /// Writes two ticks a pass (begin, end; u64) to the start of `buffer` (usage `QUERY_RESOLVE`);
    /// a tick is [`wgpu::Queue::get_timestamp_period`] nanoseconds.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let count = 2 * self.names.len() as u32;
        if count > 0 {
            encoder.resolve_query_set(&self.queries, 0..count, buffer, 0);
        }
    }
}
