//! Bind group layouts that all passes share, and the textures that stand in for inputs that are not there.

use crate::shader::Reflection;

/// Bind group 0: the frame's uniforms, the depth buffer, the in-scattered light so far, airlight tables.
pub(crate) fn frame(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    declared(device, "tyndall frame", "tyndall::gpu::frame", 0)
}

/// Bind group 1: a light's uniforms, shadow map, glass, texture and sampler.
pub(crate) fn light(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    declared(device, "tyndall light", "tyndall::shadow::shadow", 1)
}

/// All that a module of the package and those it imports declare of a group.
///
/// # Panics
/// Where the module is no valid shader: tests link all of them.
fn declared(
    device: &wgpu::Device,
    label: &'static str,
    module: &str,
    group: u32,
) -> wgpu::BindGroupLayout {
    let reflection = Reflection::new(module).expect("a valid shader of the package");
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &reflection.bindings_declared(group),
    })
}

/// Textures that are bound where a frame or a light has none of its own.
pub(crate) struct Absent {
    pub(crate) depth: wgpu::TextureView,
    pub(crate) shadow_map: wgpu::TextureView,
    pub(crate) glass: wgpu::TextureView,
    pub(crate) texture: wgpu::TextureView,
    pub(crate) light: wgpu::TextureView,
    pub(crate) airlight: wgpu::TextureView,
}

impl Absent {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let texel = |format, dimension| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("tyndall absent input"),
                size: wgpu::Extent3d::default(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(dimension),
                ..Default::default()
            })
        };
        use wgpu::{TextureFormat as Format, TextureViewDimension as Dimension};
        Self {
            depth: texel(Format::Depth32Float, Dimension::D2),
            shadow_map: texel(Format::Depth32Float, Dimension::D2Array),
            glass: texel(Format::Rg32Uint, Dimension::D2Array),
            texture: texel(Format::Rgba8Unorm, Dimension::D2),
            light: texel(Format::Rgba16Float, Dimension::D2),
            airlight: texel(Format::Rg32Float, Dimension::D2Array),
        }
    }
}
