//! The scene's materials as bind groups.

use bytemuck::{Pod, Zeroable};
use half::f16;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BindGroup, BindGroupLayout, Device, Queue, TextureView};

use super::{binding::uniform_entry, error::GpuSceneError, texture};
use crate::scene::{Blocking, Material, Scene, Texture, Wrap};

/// `Material` of `material.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct MaterialUniform {
    pub(super) base_color: [f32; 4],
    pub(super) emissive: [f32; 3],
    pub(super) cutoff: f32,
    pub(super) transmission: f32,
    pub(super) blended: u32,
    _pad: [u32; 2],
}

impl From<&Material> for MaterialUniform {
    fn from(material: &Material) -> Self {
        let (cutoff, transmission, blended) = match material.blocking {
            Blocking::Opaque => (0.0, 0.0, false),
            Blocking::Masked { cutoff } => (cutoff, 0.0, false),
            Blocking::Transmissive { transmission } => (0.0, transmission, false),
            Blocking::Blended => (0.0, 0.0, true),
        };
        Self {
            base_color: material.base_color,
            emissive: material.emissive.map(|e| e.min(f16::MAX.to_f32())),
            cutoff,
            transmission,
            blended: blended.into(),
            _pad: [0; 2],
        }
    }
}

/// Bind groups of all materials.
pub(super) struct Materials {
    bind_groups: Vec<BindGroup>,
}

impl Materials {
    /// Uploads every material, and every texture with its mip levels.
    pub(super) fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        layout: &BindGroupLayout,
    ) -> Result<Self, GpuSceneError> {
        let views = scene
            .textures
            .iter()
            .enumerate()
            .map(|(index, texture)| texture::upload(device, queue, index, texture))
            .collect::<Result<Vec<TextureView>, _>>()?;
        let white = texture::upload_white(device, queue);
        let bind_groups = scene
            .materials
            .iter()
            .map(|material| {
                let texture = material.base_color_texture;
                let view = texture.map_or(&white, |t| &views[t]);
                let wrap = texture.map_or([Wrap::ClampToEdge; 2], |t| scene.textures[t].wrap);
                create_bind_group(device, layout, material, view, wrap)
            })
            .collect();
        Ok(Self { bind_groups })
    }

    pub(super) fn bind_group(&self, material: usize) -> &BindGroup {
        &self.bind_groups[material]
    }

    /// Group 1 of the pipelines that read materials.
    pub(super) fn layout(device: &Device) -> BindGroupLayout {
        let visibility = wgpu::ShaderStages::FRAGMENT;
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        };
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("material"),
            entries: &[
                uniform_entry(visibility),
                entry(
                    1,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                ),
                entry(
                    2,
                    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                ),
            ],
        })
    }
}

fn create_bind_group(
    device: &Device,
    layout: &BindGroupLayout,
    material: &Material,
    view: &TextureView,
    wrap: [Wrap; 2],
) -> BindGroup {
    let uniform = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("material"),
        contents: bytemuck::bytes_of(&MaterialUniform::from(material)),
        usage: wgpu::BufferUsages::UNIFORM,
    });
    let [address_mode_u, address_mode_v] = wrap.map(address_mode);
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u,
        address_mode_v,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("material"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(view),
            },
            wgpu::BindGroupEntry {
                binding: 2,
                resource: wgpu::BindingResource::Sampler(&sampler),
            },
        ],
    })
}

fn address_mode(wrap: Wrap) -> wgpu::AddressMode {
    match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    }
}

/// True if the scene's glass and blended surfaces change the colour of any light that goes through them.
/// Clear glass (tint 1 everywhere) is no glass at all.
pub(super) fn has_tinted_glass(scene: &Scene) -> bool {
    scene.materials.iter().any(|material| {
        let texture = material.base_color_texture.map(|t| &scene.textures[t]);
        match material.blocking {
            Blocking::Opaque | Blocking::Masked { .. } => false,
            Blocking::Transmissive { transmission } => {
                transmission < 1.0 || !is_white(material, texture)
            }
            Blocking::Blended => !is_invisible(material, texture) && !is_white(material, texture),
        }
    })
}

fn is_white(material: &Material, texture: Option<&Texture>) -> bool {
    material.base_color[..3].iter().all(|&c| c >= 1.0)
        && texture.is_none_or(|t| t.texels.iter().all(|texel| texel[..3] == [255; 3]))
}

fn is_invisible(material: &Material, texture: Option<&Texture>) -> bool {
    material.base_color[3] <= 0.0
        || texture.is_some_and(|t| t.texels.iter().all(|texel| texel[3] == 0))
}
