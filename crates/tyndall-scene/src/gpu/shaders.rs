//! The WGSL: one topic a file, joined by these lists.

use wgpu::{Device, ShaderModule, ShaderSource};

const VIEW: &str = include_str!("wgsl/view.wgsl");
const MESH: &str = include_str!("wgsl/mesh.wgsl");
const MATERIAL: &str = include_str!("wgsl/material.wgsl");

/// A shader: its name and the files it is joined of.
pub(super) struct Shader {
    pub(super) name: &'static str,
    pub(super) files: &'static [&'static str],
}

pub(super) const G_BUFFER: Shader = Shader {
    name: "g-buffer",
    files: &[VIEW, MESH, MATERIAL, include_str!("wgsl/g_buffer.wgsl")],
};
pub(super) const VIEW_TINT: Shader = Shader {
    name: "view tint",
    files: &[VIEW, MESH, MATERIAL, include_str!("wgsl/view_tint.wgsl")],
};
pub(super) const SHADOW_MAP: Shader = Shader {
    name: "shadow map",
    files: &[VIEW, MESH, MATERIAL, include_str!("wgsl/shadow_map.wgsl")],
};
pub(super) const GLASS: Shader = Shader {
    name: "glass",
    files: &[VIEW, MESH, MATERIAL, include_str!("wgsl/glass.wgsl")],
};

const SHADE_VIEW: &str = include_str!("wgsl/shade_view.wgsl");

pub(super) const SHADE_BASE: Shader = Shader {
    name: "surfaces: sky and emission",
    files: &[SHADE_VIEW, include_str!("wgsl/shade_base.wgsl")],
};
pub(super) const SHADE_LIGHT: Shader = Shader {
    name: "surfaces: a light",
    files: &[
        SHADE_VIEW,
        include_str!("wgsl/shade_light.wgsl"),
        include_str!("wgsl/shade_shadow.wgsl"),
        include_str!("wgsl/shade.wgsl"),
    ],
};

impl Shader {
    pub(super) fn source(&self) -> String {
        self.files.join("\n")
    }

    pub(super) fn module(&self, device: &Device) -> ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: ShaderSource::Wgsl(self.source().into()),
        })
    }
}
