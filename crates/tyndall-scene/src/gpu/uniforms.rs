//! The uniform blocks of surface shading, member by member as in `shade_view.wgsl` and `shade_light.wgsl`.
//! Positions are relative to the eye.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3};
use tyndall::{
    LightInputs,
    camera::CameraRays,
    frame::{DepthRange, Emitter, Frame, Light, Projection, ShadowProjection},
    light::{
        LIGHT_RADIUS,
        texture::{MappingKind, TextureMapping},
    },
    physics::medium::Optics,
    shadow::faces,
};

use super::view::reversed_depth;
use crate::{
    shading::{
        AMBIENT, AMBIENT_TILT, NORMAL_OFFSET_TEXELS, RECT_SAMPLES, SKY_HORIZON, SKY_ZENITH,
        sun_illuminance,
    },
    trace::GLASS_LAYERS,
};

/// `ShadeView`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ShadeViewUniform {
    pub(super) right: [f32; 3],
    pub(super) near: f32,
    pub(super) up: [f32; 3],
    pub(super) far: f32,
    pub(super) forward: [f32; 3],
    pub(super) depth_range: u32,
    pub(super) center: [f32; 3],
    pub(super) orthographic: u32,
    pub(super) sigma_t: [f32; 3],
    pub(super) ambient: f32,
    pub(super) sun: [f32; 3],
    pub(super) normal_offset: f32,
    pub(super) sky_horizon: [f32; 3],
    pub(super) light_radius: f32,
    pub(super) sky_zenith: [f32; 3],
    pub(super) ambient_tilt: f32,
}

impl ShadeViewUniform {
    pub(super) fn new(frame: &Frame, rays: &CameraRays) -> Self {
        let (half_extent, center, near, far, orthographic) = match frame.camera.projection {
            Projection::Perspective {
                half_extent,
                center,
                near,
                far,
            } => (half_extent, center, near, far, false),
            Projection::Orthographic {
                half_extent,
                center,
                near,
                far,
            } => (half_extent, center, near, far, true),
        };
        let [half_x, half_y] = half_extent.map(f64::from);
        let [center_x, center_y] = center.map(f64::from);
        let sun: DVec3 = frame.lights.iter().map(sun_illuminance).sum();
        Self {
            right: floats(half_x * rays.right),
            near,
            up: floats(half_y * rays.up),
            far,
            forward: floats(rays.forward),
            depth_range: match frame.camera.depth_range {
                DepthRange::Standard => 0,
                DepthRange::Reversed => 1,
                DepthRange::ReversedInfinite => 2,
            },
            center: floats(center_x * rays.right + center_y * rays.up),
            orthographic: orthographic.into(),
            sigma_t: floats(Optics::new(&frame.medium).sigma_t),
            ambient: AMBIENT as f32,
            sun: floats(sun),
            normal_offset: NORMAL_OFFSET_TEXELS as f32,
            sky_horizon: floats(SKY_HORIZON.into()),
            light_radius: LIGHT_RADIUS as f32,
            sky_zenith: floats(SKY_ZENITH.into()),
            ambient_tilt: AMBIENT_TILT as f32,
        }
    }
}

/// `ShadeLight`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ShadeLightUniform {
    pub(super) color: [f32; 3],
    pub(super) kind: u32,
    pub(super) position: [f32; 3],
    pub(super) cos_inner: f32,
    pub(super) direction: [f32; 3],
    pub(super) cos_outer: f32,
    pub(super) edge_x: [f32; 3],
    pub(super) samples: u32,
    pub(super) edge_y: [f32; 3],
    pub(super) picture: u32,
    pub(super) picture_rows: [[f32; 4]; 3],
    pub(super) clip_from_world: [[[f32; 4]; 4]; 6],
    pub(super) faces: u32,
    pub(super) standard_depth: u32,
    pub(super) glass_layers: u32,
    pub(super) visibility: u32,
}

impl ShadeLightUniform {
    pub(super) fn new(light: &Light, inputs: &LightInputs<'_>, eye: DVec3) -> Self {
        let mut uniform = Self::of_emitter(&light.emitter, eye);
        let mapping = light
            .texture
            .filter(|_| inputs.texture.is_some())
            .and_then(|placement| TextureMapping::new(&light.emitter, &placement));
        if let Some(mapping) = mapping {
            uniform.set_picture(&mapping, eye);
        }
        if let (Some(projection), true) = (light.shadow, inputs.shadow_map.is_some()) {
            uniform.set_shadow(&light.emitter, &projection, eye);
            uniform.glass_layers = inputs.glass.map_or(0, |_| GLASS_LAYERS);
        }
        uniform
    }

    fn of_emitter(emitter: &Emitter, eye: DVec3) -> Self {
        let unit = |v| floats(vector(v).normalize_or_zero());
        let relative = |v| floats(vector(v) - eye);
        let blank = Self::zeroed();
        match *emitter {
            Emitter::Directional {
                direction,
                illuminance,
            } => Self {
                color: illuminance,
                direction: unit(direction),
                ..blank
            },
            Emitter::Point {
                position,
                intensity,
            } => Self {
                color: intensity,
                kind: 1,
                position: relative(position),
                ..blank
            },
            Emitter::Spot {
                position,
                direction,
                intensity,
                inner,
                outer,
            } => Self {
                color: intensity,
                kind: 2,
                position: relative(position),
                cos_inner: f64::from(inner).cos() as f32,
                direction: unit(direction),
                cos_outer: f64::from(outer).cos() as f32,
                ..blank
            },
            Emitter::Rect {
                center,
                edge_x,
                edge_y,
                radiance,
                ..
            } => Self {
                color: radiance,
                kind: 3,
                position: relative(center),
                direction: floats(vector(edge_x).cross(vector(edge_y)).normalize_or_zero()),
                edge_x,
                samples: RECT_SAMPLES,
                edge_y,
                ..blank
            },
        }
    }

    fn set_picture(&mut self, mapping: &TextureMapping, eye: DVec3) {
        self.picture = match mapping.kind {
            MappingKind::Affine => 1,
            MappingKind::Projective => 2,
            MappingKind::Sphere => 3,
        };
        self.picture_rows = mapping.rows.map(|row| {
            row.extend(row.dot(eye - mapping.origin))
                .as_vec4()
                .to_array()
        });
    }

    fn set_shadow(&mut self, emitter: &Emitter, projection: &ShadowProjection, eye: DVec3) {
        let faces = faces(emitter, projection).unwrap_or_default();
        self.faces = faces.len() as u32;
        self.standard_depth = (!reversed_depth(projection)).into();
        for (slot, face) in self.clip_from_world.iter_mut().zip(&faces) {
            let clip_from_relative = face.clip_from_world * DMat4::from_translation(eye);
            *slot = clip_from_relative.as_mat4().to_cols_array_2d();
        }
    }
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

fn floats(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}
