//! Buffers and textures that a view keeps from frame to frame, by name: made when they are first asked for, made anew
//! when they are asked for with another size or use, dropped when a frame does without them.

use std::{any::Any, collections::HashMap};

/// Whose something is, and what it is called.
pub(crate) type Key = (Owner, &'static str);

/// Whose something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Owner {
    /// The view's own.
    View,
    /// A light's, by its index: what it holds stays from frame to frame.
    Light(usize),
    /// Any light's while its passes run, by its extent: the passes of one light end before those of the next begin, so that
    /// lights share it.
    Scratch([u64; 2]),
}

#[derive(Default)]
pub(crate) struct Pool {
    held: HashMap<Key, Held>,
    frame: u64,
}

struct Held {
    resource: Resource,
    last_used: u64,
}

enum Resource {
    Buffer(wgpu::Buffer),
    Texture(wgpu::Texture),
    Note(Box<dyn Any + Send + Sync>),
}

impl Pool {
    /// Begins a frame. Unless the passes of the one before ran, what was noted then does not hold.
    pub(crate) fn begin(&mut self, before_ran: bool) {
        self.frame += 1;
        if !before_ran {
            self.held
                .retain(|_, held| !matches!(held.resource, Resource::Note(_)));
        }
    }

    /// Ends a frame: what it did not ask for is dropped.
    pub(crate) fn end(&mut self) {
        let frame = self.frame;
        self.held.retain(|_, held| held.last_used == frame);
    }

    /// A buffer; its content is what was written to it last, zeros at first.
    pub(crate) fn buffer(
        &mut self,
        device: &wgpu::Device,
        key: Key,
        size: u64,
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let fits = |b: &wgpu::Buffer| b.size() == size && b.usage() == usage;
        if let Some(Resource::Buffer(buffer)) = self.find(key)
            && fits(buffer)
        {
            return buffer.clone();
        }
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(key.1),
            size,
            usage,
            mapped_at_creation: false,
        });
        self.hold(key, Resource::Buffer(buffer.clone()));
        buffer
    }

    /// A texture; its content is what was written to it last, zeros at first.
    pub(crate) fn texture(
        &mut self,
        device: &wgpu::Device,
        key: Key,
        size: wgpu::Extent3d,
        levels: u32,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        let fits = |t: &wgpu::Texture| {
            t.size() == size
                && t.mip_level_count() == levels
                && t.format() == format
                && t.usage() == usage
        };
        if let Some(Resource::Texture(texture)) = self.find(key)
            && fits(texture)
        {
            return texture.clone();
        }
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(key.1),
            size,
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        self.hold(key, Resource::Texture(texture.clone()));
        texture
    }

    /// A texture of this size that passes draw on, read and copy from.
    pub(crate) fn attachment(
        &mut self,
        device: &wgpu::Device,
        key: Key,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        self.texture(device, key, size, 1, format, usage)
            .create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// A uniform buffer that holds `value`.
    pub(crate) fn uniform<T: bytemuck::Pod>(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        key: Key,
        value: &T,
    ) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let buffer = self.buffer(device, key, size_of::<T>() as u64, usage);
        queue.write_buffer(&buffer, 0, bytemuck::bytes_of(value));
        buffer
    }

    /// Notes a value, and says whether the frame before noted the same: what its passes wrote then still stands in
    /// buffers and textures that both frames ask for.
    pub(crate) fn is_as_noted<T>(&mut self, key: Key, value: T) -> bool
    where
        T: PartialEq + Send + Sync + 'static,
    {
        let is_same = match self.find(key) {
            Some(Resource::Note(note)) => note.downcast_ref() == Some(&value),
            _ => false,
        };
        self.hold(key, Resource::Note(Box::new(value)));
        is_same
    }

    /// Bytes of all that is held.
    pub(crate) fn bytes(&self) -> u64 {
        let bytes = |held: &Held| match &held.resource {
            Resource::Note(_) => 0,
            Resource::Buffer(buffer) => buffer.size(),
            Resource::Texture(texture) => {
                let texel = texture.format().block_copy_size(None).unwrap_or(0);
                let level = |k: u32| {
                    let [w, h] = [texture.width(), texture.height()].map(|n| (n >> k).max(1));
                    u64::from(w) * u64::from(h)
                };
                let texels: u64 = (0..texture.mip_level_count()).map(level).sum();
                texels * u64::from(texture.depth_or_array_layers()) * u64::from(texel)
            }
        };
        self.held.values().map(bytes).sum()
    }

    fn find(&mut self, key: Key) -> Option<&Resource> {
        let frame = self.frame;
        let held = self.held.get_mut(&key)?;
        held.last_used = frame;
        Some(&held.resource)
    }

    fn hold(&mut self, key: Key, resource: Resource) {
        let last_used = self.frame;
        self.held.insert(
            key,
            Held {
                resource,
                last_used,
            },
        );
    }
}
