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

#[cfg(test)]
mod tests {
    use tyndall_testkit::{rust_layout, shader};

    use super::*;
    use crate::gpu::{
        material::MaterialUniform,
        uniforms::{ShadeLightUniform, ShadeViewUniform},
        view::ViewUniform,
    };

    fn parse(shader: &Shader) -> shader::Shader {
        shader::Shader::new(shader.files).unwrap_or_else(|error| panic!("{}: {error}", shader.name))
    }

    #[test]
    fn all_shaders_are_valid() {
        for shader in [
            G_BUFFER,
            VIEW_TINT,
            SHADOW_MAP,
            GLASS,
            SHADE_BASE,
            SHADE_LIGHT,
        ] {
            parse(&shader);
        }
    }

    #[test]
    fn uniforms_lie_as_the_shaders_read_them() {
        let (mesh, light) = (parse(&G_BUFFER), parse(&SHADE_LIGHT));
        for (shader, name, expected) in [
            (
                &mesh,
                "View",
                rust_layout!(ViewUniform {
                    clip_from_relative,
                    origin,
                    viewer
                }),
            ),
            (
                &mesh,
                "Material",
                rust_layout!(MaterialUniform {
                    base_color,
                    emissive,
                    cutoff,
                    transmission,
                    blended
                }),
            ),
            (
                &light,
                "ShadeView",
                rust_layout!(ShadeViewUniform {
                    right,
                    near,
                    up,
                    far,
                    forward,
                    depth_range,
                    center,
                    orthographic,
                    sigma_t,
                    ambient,
                    sun,
                    normal_offset,
                    sky_horizon,
                    light_radius,
                    sky_zenith,
                    ambient_tilt
                }),
            ),
            (
                &light,
                "ShadeLight",
                rust_layout!(ShadeLightUniform {
                    color,
                    kind,
                    position,
                    cos_inner,
                    direction,
                    cos_outer,
                    edge_x,
                    samples,
                    edge_y,
                    picture,
                    picture_rows,
                    clip_from_world,
                    faces,
                    standard_depth,
                    glass_layers,
                    visibility
                }),
            ),
        ] {
            assert_eq!(shader.struct_layout(name), Ok(expected), "{name}");
        }
    }
}
