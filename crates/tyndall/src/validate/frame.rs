//! The ranges of a frame, on any backend.

use std::f32::consts::FRAC_PI_2;

use super::{
    ranges::{self, coefficient, edge, is_distance, is_length, is_tangent, place, strength},
    require::{Checked, direction, not_parallel, require},
};
use crate::{
    frame::{
        Camera, DepthRange, Emitter, Frame, Light, Medium, Projection, ShadowProjection,
        TexturePlacement,
    },
    light::texture::TextureMapping,
};

/// The most samples of a rectangular light.
const MAX_SAMPLES: u32 = 1024;

/// Distance of the eye from the origin, in far planes, beyond which single precision is coarser than a thousandth of what is seen.
const FARTHEST_EYE: f32 = 8192.0;

/// Checks everything about a frame that does not depend on the backend.
pub(crate) fn frame(frame: &Frame) -> Checked {
    camera(&frame.camera)?;
    medium(&frame.medium)?;
    frame
        .lights
        .iter()
        .enumerate()
        .try_for_each(|(i, l)| light(&format!("lights[{i}]"), l))?;
    ranges::brightness(frame)
}

fn camera(camera: &Camera) -> Checked {
    place("camera.eye", camera.eye)?;
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
    let perspective = matches!(camera.projection, Projection::Perspective { .. });
    let is_half = if perspective { is_tangent } else { is_length };
    require(
        half_extent.into_iter().all(is_half),
        "camera.projection.half_extent",
        "two numbers from 1e-6 to 1e6 (orthographic: from 1e-9 to 1e12 [m])",
        half_extent,
    )?;
    let is_off = |x: f32| {
        if perspective {
            is_tangent(x.abs().max(1.0))
        } else {
            is_distance(x)
        }
    };
    require(
        center.into_iter().all(|x| !x.is_nan() && is_off(x)),
        "camera.projection.center",
        "two numbers from -1e6 to 1e6 (orthographic: from -1e12 to 1e12 [m])",
        center,
    )?;
    require(
        if perspective {
            is_length(near)
        } else {
            is_distance(near)
        },
        "camera.projection.near",
        "a number from 1e-9 to 1e12 [m] (orthographic: from -1e12)",
        near,
    )?;
    require(
        is_distance(far) && far > near,
        "camera.projection.far",
        "a number > near, up to 1e12 [m]",
        far,
    )?;
    require(
        camera
            .eye
            .iter()
            .all(|x| x.abs() <= FARTHEST_EYE * far.abs().max(near.abs())),
        "camera.eye",
        "a point within 8192 far planes of the origin: positions relative to one near the eye, subtracted in f64",
        camera.eye,
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
        coefficient(
            &format!("medium.components[{i}].sigma_s"),
            component.sigma_s,
        )?;
        coefficient(
            &format!("medium.components[{i}].sigma_a"),
            component.sigma_a,
        )?;
        for (param, value) in component.phase.params() {
            require(
                (param.allows)(value),
                format!("medium.components[{i}].phase.{}", param.key),
                param.range,
                value,
            )?;
        }
    }
    Ok(())
}

fn light(field: &str, light: &Light) -> Checked {
    emitter(field, &light.emitter)?;
    if let Some(projection) = &light.shadow {
        shadow(field, &light.emitter, projection)?;
    }
    if let Some(placement) = &light.texture {
        if let TexturePlacement::Parallelogram {
            center,
            edge_x,
            edge_y,
        } = *placement
        {
            place(&format!("{field}.texture.center"), center)?;
            edge(&format!("{field}.texture.edge_x"), edge_x)?;
            edge(&format!("{field}.texture.edge_y"), edge_y)?;
        }
        if let Emitter::Spot { outer, .. } = light.emitter {
            require(
                outer < FRAC_PI_2,
                format!("{field}.emitter.outer"),
                "below pi/2 rad with a texture, which is tan(outer) wide",
                outer,
            )?;
        }
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

fn emitter(field: &str, emitter: &Emitter) -> Checked {
    let name = |key: &str| format!("{field}.emitter.{key}");
    match *emitter {
        Emitter::Directional {
            direction: travel,
            illuminance,
        } => {
            direction(&name("direction"), travel)?;
            strength(&name("illuminance"), illuminance)?;
        }
        Emitter::Point {
            position,
            intensity,
            radius,
        } => {
            place(&name("position"), position)?;
            strength(&name("intensity"), intensity)?;
            lamp_radius(&name, radius)?;
        }
        Emitter::Spot {
            position,
            direction: axis,
            intensity,
            inner,
            outer,
            radius,
        } => {
            place(&name("position"), position)?;
            direction(&name("direction"), axis)?;
            strength(&name("intensity"), intensity)?;
            cone(&name, [inner, outer])?;
            lamp_radius(&name, radius)?;
        }
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            samples,
        } => {
            place(&name("center"), center)?;
            edge(&name("edge_x"), edge_x)?;
            edge(&name("edge_y"), edge_y)?;
            not_parallel(
                &name("edge_y"),
                edge_y,
                edge_x,
                "an edge that is not parallel to edge_x",
            )?;
            strength(&name("radiance"), radiance)?;
            require(
                (1..=MAX_SAMPLES).contains(&samples),
                name("samples"),
                "a whole number from 1 to 1024",
                samples,
            )?;
        }
    }
    Ok(())
}

fn lamp_radius(name: &dyn Fn(&str) -> String, radius: f32) -> Checked {
    require(
        radius >= 0.0 && is_distance(radius),
        name("radius"),
        "a number from 0 to 1e12 [m]",
        radius,
    )
}

fn cone(name: &dyn Fn(&str) -> String, [inner, outer]: [f32; 2]) -> Checked {
    require(
        outer > 0.0 && outer <= FRAC_PI_2,
        name("outer"),
        "an angle above 0 and up to pi/2 rad",
        outer,
    )?;
    require(
        inner >= 0.0 && inner <= outer,
        name("inner"),
        "an angle from 0 to outer [rad]",
        inner,
    )
}

fn shadow(field: &str, emitter: &Emitter, projection: &ShadowProjection) -> Checked {
    let field = format!("{field}.shadow");
    match *projection {
        ShadowProjection::Single {
            clip_from_world, ..
        } => require(
            clip_from_world.iter().flatten().all(|x| is_distance(*x)),
            field,
            "a matrix of numbers from -1e12 to 1e12",
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
                is_length(near) && is_length(far) && far > near,
                field,
                "1e-9 <= near < far <= 1e12 [m]",
                [near, far],
            )
        }
    }
}
