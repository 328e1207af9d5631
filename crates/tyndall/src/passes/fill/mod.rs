//! Buffers whose words are all set to one value.

use crate::gpu::{
    cache,
    pass::Dispatch,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

/// The most workgroups a dimension may have on every device.
const MAX_WORKGROUPS: u32 = 65_535;
/// Vectors of four words that a thread sets at least.
const VECTORS_A_THREAD: u64 = 4;

/// A program that sets the words of a buffer.
pub(crate) struct Fill(ComputeProgram);

impl cache::Programs for Fill {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = ComputeProgram::new(device, shared, "passes::fill::fill", "fill_words");
        Self(program.for_all_lights())
    }
}

impl Fill {
    /// Sets every word of a buffer, whose size is a multiple of 16 bytes; `name` is that of the value.
    pub(crate) fn dispatch(
        &self,
        scope: &mut LightScope<'_>,
        name: &'static str,
        words: &wgpu::Buffer,
        value: u32,
    ) -> Dispatch {
        let uniform = scope.uniform(name, &[value, 0, 0, 0]);
        let threads = (words.size() / 16).div_ceil(VECTORS_A_THREAD);
        let [groups, ..] = self.0.workgroups([threads as u32, 1, 1]);
        let groups = [groups.clamp(1, MAX_WORKGROUPS), 1, 1];
        let resources = [uniform.as_entire_binding(), words.as_entire_binding()];
        scope.dispatch(&self.0, &resources, groups)
    }
}

#[cfg(test)]
mod tests {
    use crate::shader::tests::harness;
    use tyndall_testkit::{device::device_or_skip, wgsl};
    use wgpu::util::DeviceExt;

    #[test]
    fn every_word_is_set() {
        let Some(gpu) = device_or_skip("fill.wgsl") else {
            return;
        };
        for (count, groups) in [(4, 1), (4 * 1000, 3)] {
            let buffer = |contents: &[u8], usage| {
                let init = wgpu::util::BufferInitDescriptor {
                    label: None,
                    contents,
                    usage: usage | wgpu::BufferUsages::COPY_SRC,
                };
                gpu.device.create_buffer_init(&init)
            };
            let uniform = bytemuck::bytes_of(&[7_u32, 0, 0, 0]);
            let uniform = buffer(uniform, wgpu::BufferUsages::UNIFORM);
            let words = vec![1_u32; count];
            let words = buffer(bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
            let bound = (2, &[&uniform, &words][..]);
            let fill = harness("import tyndall::passes::fill::fill::fill_words;", &[], &[]);
            wgsl::dispatch(gpu, &[&fill], "fill_words", &[], bound, [groups, 1, 1])
                .expect("the shader runs");
            let found: Vec<u32> = gpu.read_buffer(&words).expect("readable");
            assert_eq!(found, vec![7; count]);
        }
    }
}
