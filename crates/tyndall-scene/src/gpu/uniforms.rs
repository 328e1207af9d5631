//! The uniform blocks of surface shading, member by member as in `shade_surface.wesl` and `shade_light.wesl`.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use tyndall::{
    frame::{Emitter, Frame, Light},
    light::patch_radius,
};

use crate::shading::{
    AMBIENT, AMBIENT_TILT, NORMAL_OFFSET_GRAZING_TEXELS, NORMAL_OFFSET_TEXELS, RECT_SAMPLES,
    SKY_HORIZON, SKY_ZENITH, sun_illuminance,
};

/// `Shade`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ShadeUniform {
    pub(super) sun: [f32; 3],
    pub(super) ambient: f32,
    pub(super) sky_horizon: [f32; 3],
    pub(super) ambient_tilt: f32,
    pub(super) sky_zenith: [f32; 3],
    pub(super) normal_offset: f32,
    pub(super) normal_offset_grazing: f32,
    _pad: [f32; 3],
}

impl ShadeUniform {
    pub(super) fn new(frame: &Frame) -> Self {
        let sun: DVec3 = frame.lights.iter().map(sun_illuminance).sum();
        Self {
            sun: sun.as_vec3().to_array(),
            ambient: AMBIENT as f32,
            sky_horizon: SKY_HORIZON.map(|l| l as f32),
            ambient_tilt: AMBIENT_TILT as f32,
            sky_zenith: SKY_ZENITH.map(|l| l as f32),
            normal_offset: NORMAL_OFFSET_TEXELS as f32,
            normal_offset_grazing: NORMAL_OFFSET_GRAZING_TEXELS as f32,
            _pad: [0.0; 3],
        }
    }
}

/// `ShadeLight`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ShadeLightUniform {
    pub(super) edge_x: [f32; 3],
    pub(super) patch_radius: f32,
    pub(super) edge_y: [f32; 3],
    _pad_y: f32,
}

impl ShadeLightUniform {
    pub(super) fn new(light: &Light) -> Self {
        let (edge_x, edge_y) = match light.emitter {
            Emitter::Rect { edge_x, edge_y, .. } => (edge_x, edge_y),
            _ => ([0.0; 3], [0.0; 3]),
        };
        let [x, y] = [edge_x, edge_y].map(|edge| Vec3::from(edge).as_dvec3());
        let area = x.cross(y).length();
        Self {
            edge_x,
            patch_radius: patch_radius(area, RECT_SAMPLES) as f32,
            edge_y,
            _pad_y: 0.0,
        }
    }
}
