//! The ranges of a frame, on any backend.

use std::f32::consts::FRAC_PI_2;

use super::require::{Checked, direction, finite, not_negative, not_parallel, require};
use crate::{
    frame::{Camera, DepthRange, Emitter, Frame, Light, Medium, Projection, ShadowProjection},
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
        not_negative(
            &format!("medium.components[{i}].sigma_s"),
            component.sigma_s,
        )?;
        not_negative(
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
            not_negative(&name("illuminance"), illuminance)?;
        }
        Emitter::Point {
            position,
            intensity,
            radius,
        } => {
            finite(&name("position"), position)?;
            not_negative(&name("intensity"), intensity)?;
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
            finite(&name("position"), position)?;
            direction(&name("direction"), axis)?;
            not_negative(&name("intensity"), intensity)?;
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
    Ok(())
}

fn lamp_radius(name: &dyn Fn(&str) -> String, radius: f32) -> Checked {
    require(
        radius.is_finite() && radius >= 0.0,
        name("radius"),
        "a finite number >= 0 [m]",
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
