//! What a frame and its inputs must be. Every refusal names the field, what was expected and what was found.

use glam::DVec3;

use crate::{
    cpu::{CpuInputs, GlassMap},
    error::PrepareError,
    frame::{
        Camera, DepthRange, Emitter, Frame, Light, Medium, Phase, Projection, ShadowProjection,
    },
    light::texture::TextureMapping,
    physics::medium::reals,
    techniques::{Backends, LightKind},
};

/// The largest picture side [pixels] that is taken at all, so that sizes never overflow.
const MAX_SIDE: u32 = 1 << 16;
/// The most samples of a rectangular light.
const MAX_SAMPLES: u32 = 1024;

type Checked = Result<(), PrepareError>;

fn require(
    holds: bool,
    field: impl Into<String>,
    expected: &'static str,
    found: impl std::fmt::Debug,
) -> Checked {
    if holds {
        return Ok(());
    }
    Err(PrepareError::OutOfRange {
        field: field.into(),
        expected,
        found: format!("{found:?}"),
    })
}

fn finite(field: &str, value: [f32; 3]) -> Checked {
    require(
        value.iter().all(|x| x.is_finite()),
        field,
        "three finite numbers",
        value,
    )
}

fn not_negative(field: &str, value: [f32; 3]) -> Checked {
    require(
        value.iter().all(|x| x.is_finite() && *x >= 0.0),
        field,
        "three finite numbers >= 0",
        value,
    )
}

/// Shorter vectors have no direction in f32.
fn direction(field: &str, value: [f32; 3]) -> Checked {
    let length = reals(value).length();
    require(
        length.is_finite() && length > 1e-18,
        field,
        "a finite vector that is not zero",
        value,
    )
}

fn not_parallel(field: &str, value: [f32; 3], other: [f32; 3], expected: &'static str) -> Checked {
    direction(field, value)?;
    let cross = reals(value)
        .normalize()
        .cross(reals(other).normalize_or(DVec3::ZERO));
    require(cross.length() > 1e-6, field, expected, value)
}

/// Checks everything about a frame that does not depend on the backend.
pub(crate) fn frame(frame: &Frame) -> Checked {
    camera(&frame.camera)?;
    medium(&frame.medium)?;
    frame
        .lights
        .iter()
        .enumerate()
        .try_for_each(|(i, l)| light(&format!("lights[{i}]"), l))
}

fn camera(camera: &Camera) -> Checked {
    finite("camera.eye", camera.eye)?;
    direction("camera.forward", camera.forward)?;
    not_parallel(
        "camera.up",
        camera.up,
        camera.forward,
        "a direction that is not parallel to camera.forward",
    )?;
    let (Projection::Perspective {
        half_extent,
        center,
        near,
        far,
    }
    | Projection::Orthographic {
        half_extent,
        center,
        near,
        far,
    }) = camera.projection;
    require(
        half_extent.iter().all(|x| x.is_finite() && *x > 0.0),
        "camera.projection.half_extent",
        "two finite numbers > 0",
        half_extent,
    )?;
    require(
        center.iter().all(|x| x.is_finite()),
        "camera.projection.center",
        "two finite numbers",
        center,
    )?;
    let perspective = matches!(camera.projection, Projection::Perspective { .. });
    require(
        near.is_finite() && (near > 0.0 || !perspective),
        "camera.projection.near",
        "a finite number (> 0 for perspective)",
        near,
    )?;
    require(
        far.is_finite() && far > near,
        "camera.projection.far",
        "a finite number > near",
        far,
    )?;
    require(
        perspective || camera.depth_range != DepthRange::ReversedInfinite,
        "camera.depth_range",
        "Standard or Reversed, for an orthographic camera's far plane is finite",
        camera.depth_range,
    )
}

fn medium(medium: &Medium) -> Checked {
    require(
        medium.components.len() <= Medium::MAX_COMPONENTS,
        "medium.components",
        "at most 4 components",
        medium.components.len(),
    )?;
    for (i, component) in medium.components.iter().enumerate() {
        not_negative(
            &format!("medium.components[{i}].sigma_s"),
            component.sigma_s,
        )?;
        not_negative(
            &format!("medium.components[{i}].sigma_a"),
            component.sigma_a,
        )?;
        if let Phase::HenyeyGreenstein { g } = component.phase {
            require(
                g.abs() < 1.0,
                format!("medium.components[{i}].phase.g"),
                "a number between -1 and 1, both excluded",
                g,
            )?;
        }
    }
    Ok(())
}

fn light(field: &str, light: &Light) -> Checked {
    let name = |key: &str| format!("{field}.emitter.{key}");
    match light.emitter {
        Emitter::Directional {
            direction: way,
            illuminance,
        } => {
            direction(&name("direction"), way)?;
            not_negative(&name("illuminance"), illuminance)?;
        }
        Emitter::Point {
            position,
            intensity,
        } => {
            finite(&name("position"), position)?;
            not_negative(&name("intensity"), intensity)?;
        }
        Emitter::Spot {
            position,
            direction: axis,
            intensity,
            inner,
            outer,
        } => {
            finite(&name("position"), position)?;
            direction(&name("direction"), axis)?;
            not_negative(&name("intensity"), intensity)?;
            require(
                outer > 0.0 && outer < std::f32::consts::FRAC_PI_2,
                name("outer"),
                "an angle between 0 and pi/2 rad, both excluded",
                outer,
            )?;
            require(
                inner >= 0.0 && inner < outer,
                name("inner"),
                "an angle from 0 to below outer [rad]",
                inner,
            )?;
        }
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            samples,
        } => {
            finite(&name("center"), center)?;
            direction(&name("edge_x"), edge_x)?;
            not_parallel(
                &name("edge_y"),
                edge_y,
                edge_x,
                "an edge that is not parallel to edge_x",
            )?;
            not_negative(&name("radiance"), radiance)?;
            require(
                (1..=MAX_SAMPLES).contains(&samples),
                name("samples"),
                "a whole number from 1 to 1024",
                samples,
            )?;
        }
    }
    if let Some(projection) = &light.shadow {
        shadow(field, &light.emitter, projection)?;
    }
    if let Some(placement) = &light.texture {
        require(
            TextureMapping::new(&light.emitter, placement)
                .is_some_and(|m| m.rows.iter().all(|r| r.is_finite()) && m.origin.is_finite()),
            format!("{field}.texture"),
            "a placement of this kind of light that is not degenerate",
            placement,
        )?;
    }
    Ok(())
}

fn shadow(field: &str, emitter: &Emitter, projection: &ShadowProjection) -> Checked {
    let field = format!("{field}.shadow");
    match *projection {
        ShadowProjection::Single {
            clip_from_world, ..
        } => require(
            clip_from_world.iter().flatten().all(|x| x.is_finite()),
            field,
            "a matrix of finite numbers",
            clip_from_world,
        ),
        ShadowProjection::Cube { near, far, .. } => {
            require(
                matches!(emitter, Emitter::Point { .. } | Emitter::Spot { .. }),
                field.clone(),
                "a single map: only point and spot lights have a cube",
                projection,
            )?;
            require(
                near > 0.0 && far > near && far.is_finite(),
                field,
                "0 < near < far, both finite",
                [near, far],
            )
        }
    }
}

/// Checks that the technique can do the frame's lights on this backend.
pub(crate) fn technique(frame: &Frame, backend: Backends) -> Checked {
    let info = frame.technique.info();
    let unsupported = |what: String| PrepareError::Unsupported {
        technique: info.name,
        what,
    };
    if info.backends != backend && info.backends != Backends::Both {
        let there = if backend == Backends::Cpu {
            "the CPU"
        } else {
            "the GPU"
        };
        return Err(unsupported(format!("its work on {there}")));
    }
    for (i, light) in frame.lights.iter().enumerate() {
        let kind = LightKind::of(&light.emitter);
        if !info.lights.contains(&kind) {
            return Err(unsupported(format!("{} lights (lights[{i}])", kind.name())));
        }
        if kind == LightKind::Rect && light.shadow.is_some() {
            return Err(unsupported(format!(
                "a shadow map for a rectangular light (lights[{i}])"
            )));
        }
    }
    frame.technique.check(frame)
}

impl LightKind {
    /// The kind of an emitter.
    pub fn of(emitter: &Emitter) -> Self {
        match emitter {
            Emitter::Directional { .. } => Self::Directional,
            Emitter::Point { .. } => Self::Point,
            Emitter::Spot { .. } => Self::Spot,
            Emitter::Rect { .. } => Self::Rect,
        }
    }
}

/// Checks that one input set a light was given, and what each light needs.
pub(crate) fn light_inputs(
    frame: &Frame,
    given: impl ExactSizeIterator<Item = GivenInputs>,
) -> Checked {
    if given.len() != frame.lights.len() {
        return Err(PrepareError::WrongSize {
            field: "inputs.lights".into(),
            expected: frame.lights.len(),
            found: given.len(),
        });
    }
    for (i, (light, given)) in frame.lights.iter().zip(given).enumerate() {
        let missing = |key: &str, reason| PrepareError::Missing {
            field: format!("inputs.lights[{i}].{key}"),
            reason,
        };
        if light.shadow.is_some() && !given.shadow_map {
            return Err(missing("shadow_map", "the light has a shadow projection"));
        }
        if light.texture.is_some() && !given.texture {
            return Err(missing("texture", "the light has a texture placement"));
        }
        let surplus = [
            ("shadow_map", given.shadow_map, light.shadow.is_some()),
            ("glass", given.glass, light.shadow.is_some()),
            ("texture", given.texture, light.texture.is_some()),
        ];
        for (key, is_given, is_used) in surplus {
            require(
                is_used || !is_given,
                format!("inputs.lights[{i}].{key}"),
                "none, for the light has no projection or placement for it",
                "one",
            )?;
        }
    }
    Ok(())
}

/// Which pictures of a light were given.
pub(crate) struct GivenInputs {
    pub(crate) shadow_map: bool,
    pub(crate) glass: bool,
    pub(crate) texture: bool,
}

/// Checks the pictures of the CPU backend.
pub(crate) fn cpu_inputs(frame: &Frame, inputs: &CpuInputs<'_>) -> Checked {
    let pixels = area("inputs.size", inputs.size)?;
    size("inputs.depth", pixels, inputs.depth.len())?;
    require(
        inputs.depth.iter().all(|d| !d.is_nan()),
        "inputs.depth",
        "numbers",
        "NaN",
    )?;
    let given = inputs.lights.iter().map(|l| GivenInputs {
        shadow_map: l.shadow_map.is_some(),
        glass: l.glass.is_some(),
        texture: l.texture.is_some(),
    });
    light_inputs(frame, given)?;
    for (i, (light, inputs)) in frame.lights.iter().zip(inputs.lights).enumerate() {
        let field = |key: &str| format!("inputs.lights[{i}].{key}");
        let faces = faces(light) as usize;
        if let Some(map) = inputs.shadow_map {
            let texels = area(&field("shadow_map.size"), map.size)?;
            size(&field("shadow_map.depth"), faces * texels, map.depth.len())?;
        }
        if let Some(GlassMap {
            size: side,
            layers,
            texels,
        }) = inputs.glass
        {
            let area = area(&field("glass.size"), *side)?;
            size(
                &field("glass.texels"),
                faces * area * *layers as usize,
                texels.len(),
            )?;
        }
        if let Some(texture) = inputs.texture {
            let texels = area(&field("texture.size"), texture.size)?;
            size(&field("texture.texels"), texels, texture.texels.len())?;
        }
    }
    Ok(())
}

fn area(field: &str, size: [u32; 2]) -> Result<usize, PrepareError> {
    require(
        size.iter().all(|n| (1..=MAX_SIDE).contains(n)),
        field,
        "1 to 65536 a side",
        size,
    )?;
    Ok(size[0] as usize * size[1] as usize)
}

fn size(field: &str, expected: usize, found: usize) -> Checked {
    if expected == found {
        return Ok(());
    }
    Err(PrepareError::WrongSize {
        field: field.to_owned(),
        expected,
        found,
    })
}

/// Faces of a light's shadow map.
pub(crate) fn faces(light: &Light) -> u32 {
    match light.shadow {
        Some(ShadowProjection::Cube { .. }) => 6,
        _ => 1,
    }
}

/// Checks the textures of the GPU backend.
#[cfg(feature = "gpu")]
pub(crate) fn gpu_inputs(
    frame: &Frame,
    inputs: &crate::effect::FrameInputs<'_>,
    view_size: [u32; 2],
) -> Checked {
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
            layers(&field("shadow_map"), map.texture(), |n| n == faces(light))?;
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
            layers(&field("glass"), texture, |n| n % faces(light) == 0)?;
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
#[cfg(feature = "gpu")]
pub(crate) fn surface_shadows(
    shadows: &crate::effect::SurfaceShadows,
    view_size: [u32; 2],
) -> Checked {
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

#[cfg(feature = "gpu")]
fn point_cloud(field: &str, light: &Light, cloud: &crate::effect::PointCloud<'_>) -> Checked {
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

#[cfg(feature = "gpu")]
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

#[cfg(feature = "gpu")]
fn depth_texture(field: &str, texture: &wgpu::Texture) -> Checked {
    bindable(field, texture)?;
    require(
        texture.format().has_depth_aspect(),
        field,
        "a texture of a depth format",
        texture.format(),
    )
}

#[cfg(feature = "gpu")]
fn layers(field: &str, texture: &wgpu::Texture, fits: impl Fn(u32) -> bool) -> Checked {
    let found = texture.depth_or_array_layers();
    require(
        fits(found),
        field,
        "one layer a face of the light's shadow map (glass: some layers a face)",
        found,
    )
}
