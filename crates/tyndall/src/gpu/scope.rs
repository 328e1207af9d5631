//! What a technique sees when it prepares a light: the frame, the light's inputs, and where to keep things.

use std::sync::Arc;

pub(crate) use super::shared::Shared;
use super::{
    cache::Programs,
    pass::{Dispatch, Draw, FullScreen, Pass, Vertices, Work, Workgroups},
    pool::{Owner, Pool},
    program::{ComputeProgram, ScreenProgram, Stencil},
    uniforms::LightVariant,
};
use crate::{
    camera::CameraRays,
    frame::{Frame, Light},
    inputs::{Count, CountValue, LightInputs, SurfaceShadows},
};

/// One light of a frame that is being prepared.
pub(crate) struct LightScope<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    pub(crate) shared: &'a Shared,
    pub(crate) pool: &'a mut Pool,
    pub(crate) frame: &'a Frame,
    pub(crate) rays: &'a CameraRays,
    /// Width and height of the picture \[pixels].
    pub(crate) size: [u32; 2],
    pub(crate) index: usize,
    pub(crate) light: &'a Light,
    pub(crate) inputs: LightInputs<'a>,
    pub(crate) variant: LightVariant,
    /// Bind group 0, with the lights before this one.
    pub(crate) frame_group: wgpu::BindGroup,
    /// Bind group 1.
    pub(crate) light_group: wgpu::BindGroup,
    /// What the last pass writes: the lights so far and this one (rgb), and the mean transmittance (a).
    pub(crate) target: wgpu::TextureView,
    /// Which pixels the last pass writes, where 1; `None`: all.
    pub(crate) stencil: Option<wgpu::TextureView>,
    /// Whether shadows on surfaces are asked for, and what is known of the surfaces.
    pub(crate) surface_shadows: Option<&'a SurfaceShadows>,
    /// What the frame's passes count.
    pub(crate) counts: &'a mut Vec<Count>,
}

/// Uniform blocks in one buffer.
pub(crate) struct Blocks<T> {
    pub(crate) values: Vec<T>,
    buffer: wgpu::Buffer,
    pitch: u64,
}

impl<T> Blocks<T> {
    /// One of them.
    pub(crate) fn binding(&self, index: u32) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.buffer,
            offset: u64::from(index) * self.pitch,
            size: std::num::NonZeroU64::new(size_of::<T>() as u64),
        })
    }
}

impl LightScope<'_> {
    /// The effect's programs of this type.
    pub(crate) fn programs<P: Programs>(&self) -> Arc<P> {
        self.shared.programs(self.device)
    }

    /// A uniform buffer of this light that holds `value`.
    pub(crate) fn uniform<T: bytemuck::Pod>(
        &mut self,
        name: &'static str,
        value: &T,
    ) -> wgpu::Buffer {
        self.pool.uniform(
            self.device,
            self.queue,
            (Owner::Light(self.index), name),
            value,
        )
    }

    /// Blocks of one kind in a uniform buffer of this light, for dispatches that take one each; room for at least one.
    pub(crate) fn blocks<T: bytemuck::Pod>(
        &mut self,
        name: &'static str,
        values: Vec<T>,
    ) -> Blocks<T> {
        let alignment = u64::from(self.device.limits().min_uniform_buffer_offset_alignment);
        let pitch = (size_of::<T>() as u64).next_multiple_of(alignment);
        let mut bytes = vec![0; values.len().max(1) * pitch as usize];
        for (block, value) in bytes.chunks_exact_mut(pitch as usize).zip(&values) {
            block[..size_of::<T>()].copy_from_slice(bytemuck::bytes_of(value));
        }
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let key = (Owner::Light(self.index), name);
        let buffer = self
            .pool
            .buffer(self.device, key, bytes.len() as u64, usage);
        self.queue.write_buffer(&buffer, 0, &bytes);
        Blocks {
            values,
            buffer,
            pitch,
        }
    }

    /// A storage buffer for the passes of this light, which others share.
    pub(crate) fn storage(&mut self, name: &'static str, bytes: u64) -> wgpu::Buffer {
        self.scratch(name, bytes, wgpu::BufferUsages::STORAGE)
    }

    /// A storage buffer of this light that holds what was written to it in frames before.
    pub(crate) fn kept_storage(&mut self, name: &'static str, bytes: u64) -> wgpu::Buffer {
        let key = (Owner::Light(self.index), name);
        let usage = wgpu::BufferUsages::STORAGE;
        self.pool.buffer(self.device, key, bytes, usage)
    }

    fn scratch(
        &mut self,
        name: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let key = (Owner::Scratch([bytes, 0]), name);
        self.pool.buffer(self.device, key, bytes, usage)
    }

    /// A storage buffer of this light that holds these values.
    pub(crate) fn upload<T: bytemuck::Pod>(
        &mut self,
        name: &'static str,
        values: &[T],
    ) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let key = (Owner::Light(self.index), name);
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let buffer = self
            .pool
            .buffer(self.device, key, bytes.len() as u64, usage);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// A texture for the passes of this light, which others share.
    pub(crate) fn texture(
        &mut self,
        name: &'static str,
        size: wgpu::Extent3d,
        levels: u32,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        let plane = u64::from(size.width) << 32 | u64::from(size.height);
        let key = (
            Owner::Scratch([plane, size.depth_or_array_layers.into()]),
            name,
        );
        self.pool
            .texture(self.device, key, size, levels, format, usage)
    }

    /// A storage buffer that holds the workgroups of so many dispatches of this light.
    pub(crate) fn indirect(&mut self, name: &'static str, dispatches: u64) -> wgpu::Buffer {
        self.indirect_bytes(name, dispatches * size_of::<[u32; 3]>() as u64)
    }

    /// A storage buffer that holds the vertices of so many draws of this light.
    pub(crate) fn indirect_draws(&mut self, name: &'static str, draws: u64) -> wgpu::Buffer {
        self.indirect_bytes(name, draws * size_of::<[u32; 4]>() as u64)
    }

    fn indirect_bytes(&mut self, name: &'static str, bytes: u64) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
        self.scratch(name, bytes, usage)
    }

    /// A texture for the passes of this light that a compute shader writes and others read.
    pub(crate) fn storage_texture(
        &mut self,
        name: &'static str,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING;
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        self.texture(name, size, 1, format, usage)
            .create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// A pass of one dispatch over the frame, the light and `resources`.
    pub(crate) fn compute(
        &self,
        program: &ComputeProgram,
        name: &str,
        resources: &[wgpu::BindingResource<'_>],
        workgroups: impl Into<Workgroups>,
    ) -> Pass {
        let dispatch = self.dispatch(program, resources, workgroups);
        Pass::compute(self.pass_name(name), vec![dispatch])
    }

    /// One dispatch over the frame, the light and `resources`.
    pub(crate) fn dispatch(
        &self,
        program: &ComputeProgram,
        resources: &[wgpu::BindingResource<'_>],
        workgroups: impl Into<Workgroups>,
    ) -> Dispatch {
        Dispatch {
            pipeline: program.get(self.device, self.variant),
            groups: self.groups(program.bind(self.device, resources)),
            workgroups: workgroups.into(),
        }
    }

    /// The pass that writes the target.
    pub(crate) fn full_screen(
        &self,
        program: &ScreenProgram,
        name: &str,
        resources: &[wgpu::BindingResource<'_>],
    ) -> Pass {
        let stencil = match self.stencil {
            None => Stencil::Absent,
            Some(_) => Stencil::Tested,
        };
        let draw = FullScreen {
            pipeline: program.with_stencil(self.device, self.variant, stencil),
            groups: self.groups(program.bind(self.device, resources)),
            target: self.target.clone(),
            stencil: self.stencil.clone(),
            gate: None,
        };
        Pass {
            name: self.pass_name(name),
            work: Work::FullScreen(vec![draw]),
        }
    }

    /// One full-screen draw over the frame, the light and `resources`.
    pub(crate) fn draw(
        &self,
        program: &ScreenProgram,
        resources: &[wgpu::BindingResource<'_>],
        target: wgpu::TextureView,
    ) -> FullScreen {
        FullScreen {
            pipeline: program.get(self.device, self.variant),
            groups: self.groups(program.bind(self.device, resources)),
            target,
            stencil: None,
            gate: None,
        }
    }

    /// One draw of a mesh over the frame, the light and `resources`.
    pub(crate) fn draw_mesh(
        &self,
        program: &ScreenProgram,
        resources: &[wgpu::BindingResource<'_>],
        vertices: Vertices,
    ) -> Draw {
        Draw {
            pipeline: program.get(self.device, self.variant),
            groups: self.groups(program.bind(self.device, resources)),
            vertices,
        }
    }

    /// Lists a number of this light.
    pub(crate) fn count(&mut self, name: &str, value: CountValue) {
        let name = self.pass_name(name);
        self.counts.push(Count { name, value });
    }

    /// A pass's name with its light's index.
    pub(crate) fn pass_name(&self, name: &str) -> String {
        format!("{name} light {}", self.index)
    }

    pub(crate) fn groups(&self, own: wgpu::BindGroup) -> Vec<wgpu::BindGroup> {
        vec![self.frame_group.clone(), self.light_group.clone(), own]
    }
}
