//! A frame's textures on the GPU: sizes, formats, layers and uses.

use super::{
    inputs::{GivenInputs, light_inputs},
    require::{Checked, require},
};
use crate::{
    frame::{Emitter, Frame, Light},
    inputs::{FrameInputs, PointCloud, SurfaceShadows},
};

/// Checks the textures of the GPU backend.
pub(crate) fn gpu_inputs(frame: &Frame, inputs: &FrameInputs<'_>, view_size: [u32; 2]) -> Checked {
    let depth = inputs.depth.texture();
    require(
        [depth.width(), depth.height()] == view_size,
        "inputs.depth",
        "a texture of the view's size",
        [depth.width(), depth.height()],
    )?;
    depth_texture("inputs.depth", depth)?;
    let given = inputs.lights.iter().map(|l| GivenInputs {
        shadow_map: l.shadow_map.is_some(),
        glass: l.glass.is_some(),
        texture: l.texture.is_some(),
    });
    light_inputs(frame, given)?;
    for (i, (light, inputs)) in frame.lights.iter().zip(inputs.lights).enumerate() {
        let field = |key: &str| format!("inputs.lights[{i}].{key}");
        if let Some(map) = inputs.shadow_map {
            depth_texture(&field("shadow_map"), map.texture())?;
            layers(&field("shadow_map"), map.texture(), |n| n == light.faces())?;
        }
        if let Some(glass) = inputs.glass {
            let texture = glass.texture();
            bindable(&field("glass"), texture)?;
            require(
                texture.format() == wgpu::TextureFormat::Rg32Uint,
                field("glass"),
                "a texture of format Rg32Uint",
                texture.format(),
            )?;
            layers(&field("glass"), texture, |n| n % light.faces() == 0)?;
        }
        if let Some(texture) = inputs.texture {
            bindable(&field("texture"), texture.texture())?;
        }
        if let Some(points) = inputs.points {
            point_cloud(&field("points"), light, &points)?;
        }
    }
    Ok(())
}

/// Checks what shadows on surfaces are made of.
pub(crate) fn surface_shadows(shadows: &SurfaceShadows, view_size: [u32; 2]) -> Checked {
    const FIELD: &str = "surface_shadows.normals";
    let Some(normals) = &shadows.normals else {
        return Ok(());
    };
    let texture = normals.texture();
    bindable(FIELD, texture)?;
    let size = [texture.width(), texture.height()];
    require(
        size == view_size,
        FIELD,
        "a texture of the view's size",
        size,
    )?;
    let samples = texture.format().sample_type(None, None);
    require(
        matches!(samples, Some(wgpu::TextureSampleType::Float { .. })),
        FIELD,
        "a texture of a format of floats",
        texture.format(),
    )
}

fn point_cloud(field: &str, light: &Light, cloud: &PointCloud<'_>) -> Checked {
    require(
        matches!(light.emitter, Emitter::Rect { .. }),
        field,
        "none, for the light is no rectangle",
        "one",
    )?;
    require(
        (16..=1024).contains(&cloud.map_side),
        format!("{field}.map_side"),
        "a whole number from 16 to 1024",
        cloud.map_side,
    )?;
    let bytes = cloud.points.size();
    require(
        bytes > 0 && bytes.is_multiple_of(16),
        format!("{field}.points"),
        "a buffer of 16 bytes a point, of one point at least",
        bytes,
    )?;
    require(
        cloud.points.usage().contains(wgpu::BufferUsages::STORAGE),
        format!("{field}.points"),
        "a buffer with usage STORAGE",
        cloud.points.usage(),
    )
}

fn bindable(field: &str, texture: &wgpu::Texture) -> Checked {
    require(
        texture
            .usage()
            .contains(wgpu::TextureUsages::TEXTURE_BINDING),
        field,
        "a texture with usage TEXTURE_BINDING",
        texture.usage(),
    )?;
    require(
        texture.sample_count() == 1,
        field,
        "a texture of one sample",
        texture.sample_count(),
    )
}

fn depth_texture(field: &str, texture: &wgpu::Texture) -> Checked {
    bindable(field, texture)?;
    require(
        texture.format().has_depth_aspect(),
        field,
        "a texture of a depth format",
        texture.format(),
    )
}

fn layers(field: &str, texture: &wgpu::Texture, fits: impl Fn(u32) -> bool) -> Checked {
    let found = texture.depth_or_array_layers();
    require(
        fits(found),
        field,
        "one layer a face of the light's shadow map (glass: some layers a face)",
        found,
    )
}
