//! The WESL modules of the scene, linked with each other and with tyndall's shader package.

use tyndall::shader::{Linked, Linker};
use wgpu::{Device, ShaderModule, ShaderSource};

macro_rules! modules {
    ($($name:literal),+ $(,)?) => {
        &[$((concat!("scene::gpu::", $name), include_str!(concat!($name, ".wesl")))),+]
    };
}

/// Modules by path.
const MODULES: &[(&str, &str)] = modules![
    "g_buffer",
    "glass",
    "material",
    "mesh",
    "shade",
    "shade_base",
    "shade_light",
    "shade_shadow",
    "shade_surface",
    "shadow_map",
    "view",
    "view_tint",
];

pub(super) const G_BUFFER: &str = "scene::gpu::g_buffer";
pub(super) const VIEW_TINT: &str = "scene::gpu::view_tint";
pub(super) const SHADOW_MAP: &str = "scene::gpu::shadow_map";
pub(super) const GLASS: &str = "scene::gpu::glass";
/// Surfaces: sky and emission.
pub(super) const SHADE_BASE: &str = "scene::gpu::shade_base";
/// Surfaces: a light.
pub(super) const SHADE_LIGHT: &str = "scene::gpu::shade";

/// A module with all that it imports, as plain WGSL.
///
/// # Panics
/// Where it cannot be linked: a test links all of them.
pub(super) fn link(path: &str) -> Linked {
    // Group 1 is the surfaces': without a light, they are drawn as well.
    let package = Linker::new().group(1, 2);
    let linker = MODULES
        .iter()
        .fold(package, |linker, (path, text)| linker.module(*path, *text));
    linker.link(path).expect("modules that link")
}

/// Creates the shader of a module and all that it imports.
pub(super) fn module(device: &Device, path: &str) -> ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(path),
        source: ShaderSource::Wgsl(link(path).wgsl.into()),
    })
}

#[cfg(test)]
mod tests {
    use tyndall_testkit::{rust_layout, shader};

    use super::*;
    use crate::gpu::{
        material::MaterialUniform,
        uniforms::{ShadeLightUniform, ShadeUniform},
        view::ViewUniform,
    };

    fn parse(path: &str) -> shader::Shader {
        shader::Shader::new(&[&link(path).wgsl]).unwrap_or_else(|error| panic!("{path}: {error}"))
    }

    #[test]
    fn every_module_is_valid_by_itself() {
        for (path, _) in MODULES {
            parse(path);
        }
    }

    #[test]
    fn uniforms_lie_as_the_shaders_read_them() {
        let (mesh, light) = (parse(G_BUFFER), parse(SHADE_LIGHT));
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
                "Shade",
                rust_layout!(ShadeUniform {
                    sun,
                    ambient,
                    sky_horizon,
                    ambient_tilt,
                    sky_zenith,
                    normal_offset,
                    normal_offset_grazing
                }),
            ),
            (
                &light,
                "ShadeLight",
                rust_layout!(ShadeLightUniform {
                    edge_x,
                    patch_radius,
                    edge_y
                }),
            ),
        ] {
            assert_eq!(shader.struct_layout(name), Ok(expected), "{name}");
        }
    }
}
