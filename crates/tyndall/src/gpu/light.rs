//! A light as the shaders read it, and the kind of pipeline that it needs.

use glam::{DMat4, DVec3};

use super::floats::floats;
use crate::{
    frame::{self, Emitter, ShadowProjection},
    light::{
        fade, light_radius,
        texture::{MappingKind, TextureMapping},
    },
    physics::reals,
    shader::{block, constant},
    shadow,
};

block! {
    /// The shaders' `Light`.
    #[derive(Default)]
    pub(crate) struct LightUniform = "Light" in "tyndall::light::light", checked by light_is_laid_out_as_in_wgsl {
        pub(crate) color: [f32; 3],
        pub(crate) cos_inner: f32,
        pub(crate) position: [f32; 3],
        pub(crate) cos_outer: f32,
        pub(crate) direction: [f32; 3],
        pub(crate) radius: f32,
        pub(crate) texture_rows: [[f32; 4]; 3],
        pub(crate) clip_from_world: [[f32; 4]; 4],
        pub(crate) cube_depth: [f32; 2],
        pub(crate) standard_depth: u32,
        pad: u32,
    }
}

/// The kind of light and the phase functions that a pipeline is made for: the overrides `LIGHT_KIND`, `LIGHT_TEXTURE`,
/// `SHADOW_KIND`, `SHADOW_GLASS_LAYERS`, `MEDIUM_PHASES`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct LightVariant {
    pub(crate) kind: u32,
    pub(crate) texture: u32,
    pub(crate) shadow: u32,
    /// Layers of coloured glass a face; 0: there is none.
    pub(crate) glass_layers: u32,
    /// Bit n is set where the medium has phase function n.
    pub(crate) phases: u32,
}

impl LightVariant {
    /// The variant of a light, in no medium yet.
    pub(crate) fn new(light: &frame::Light, glass_layers: u32) -> Self {
        let texture = texture_mapping(light).map(|mapping| mapping.kind);
        Self {
            kind: constant(kind_name(&light.emitter)),
            texture: constant(match texture {
                None => "LIGHT_TEXTURE_NONE",
                Some(MappingKind::Affine) => "LIGHT_TEXTURE_AFFINE",
                Some(MappingKind::Projective) => "LIGHT_TEXTURE_PROJECTIVE",
                Some(MappingKind::Sphere) => "LIGHT_TEXTURE_SPHERE",
            }),
            shadow: constant(match light.shadow {
                None => "SHADOW_NONE",
                Some(ShadowProjection::Single { .. }) => "SHADOW_SINGLE",
                Some(ShadowProjection::Cube { .. }) => "SHADOW_CUBE",
            }),
            glass_layers,
            phases: 0,
        }
    }

    /// The variant in this medium.
    pub(crate) fn within(self, medium: &frame::Medium) -> Self {
        let bits = medium.components.iter().map(|c| 1 << c.phase.number());
        Self {
            phases: bits.fold(0, |all, bit: u32| all | bit),
            ..self
        }
    }

    /// The values of the shader's overrides.
    pub(crate) fn constants(self) -> [(&'static str, f64); 5] {
        [
            ("LIGHT_KIND", self.kind.into()),
            ("LIGHT_TEXTURE", self.texture.into()),
            ("SHADOW_KIND", self.shadow.into()),
            ("SHADOW_GLASS_LAYERS", self.glass_layers.into()),
            ("MEDIUM_PHASES", self.phases.into()),
        ]
    }
}

impl LightUniform {
    /// A light as the shaders see it, and the variant of pipeline it needs.
    pub(crate) fn new(
        light: &frame::Light,
        camera: &frame::Camera,
        glass_layers: u32,
    ) -> (Self, LightVariant) {
        let eye = reals(camera.eye);
        let mut uniform = Self {
            radius: light_radius(&light.emitter, camera) as f32,
            ..Self::default()
        };
        uniform.set_emitter(&light.emitter, eye);
        if let Some(projection) = &light.shadow {
            uniform.set_shadow(&light.emitter, projection, eye);
        }
        if let Some(mapping) = texture_mapping(light) {
            uniform.texture_rows = mapping.rows.map(|row| {
                row.extend(row.dot(eye - mapping.origin))
                    .as_vec4()
                    .to_array()
            });
        }
        (uniform, LightVariant::new(light, glass_layers))
    }

    fn set_emitter(&mut self, emitter: &Emitter, eye: DVec3) {
        match *emitter {
            Emitter::Directional {
                direction,
                illuminance,
            } => {
                self.color = illuminance;
                self.direction = floats(reals(direction).normalize_or_zero());
            }
            Emitter::Point {
                position,
                intensity,
                ..
            } => {
                self.color = intensity;
                self.position = floats(reals(position) - eye);
            }
            Emitter::Spot {
                position,
                direction,
                intensity,
                inner,
                outer,
                ..
            } => {
                self.color = intensity;
                self.position = floats(reals(position) - eye);
                self.direction = floats(reals(direction).normalize_or_zero());
                [self.cos_inner, self.cos_outer] = fade(inner, outer).map(|cosine| cosine as f32);
            }
            Emitter::Rect {
                center,
                edge_x,
                edge_y,
                radiance,
                ..
            } => {
                self.color = radiance;
                self.position = floats(reals(center) - eye);
                let normal = reals(edge_x).cross(reals(edge_y));
                self.direction = floats(normal.normalize_or_zero());
            }
        }
    }

    fn set_shadow(&mut self, emitter: &Emitter, projection: &ShadowProjection, eye: DVec3) {
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) = *projection;
        self.standard_depth = u32::from(!reversed_depth);
        match *projection {
            ShadowProjection::Single { .. } => {
                if let Some(faces) = shadow::faces(emitter, projection) {
                    let relative = faces[0].clip_from_world * DMat4::from_translation(eye);
                    self.clip_from_world = relative.as_mat4().to_cols_array_2d();
                }
            }
            ShadowProjection::Cube { near, far, .. } => {
                let scale = f64::from(near) / (f64::from(far) - f64::from(near));
                self.cube_depth = [(scale * f64::from(far)) as f32, -scale as f32];
            }
        }
    }
}

/// Where the light's texture falls, if it has one that fits it.
fn texture_mapping(light: &frame::Light) -> Option<TextureMapping> {
    TextureMapping::new(&light.emitter, &light.texture?)
}

/// The shaders' constant of this kind of light.
fn kind_name(emitter: &Emitter) -> &'static str {
    match emitter {
        Emitter::Directional { .. } => "LIGHT_DIRECTIONAL",
        Emitter::Point { .. } => "LIGHT_POINT",
        Emitter::Spot { .. } => "LIGHT_SPOT",
        Emitter::Rect { .. } => "LIGHT_RECT",
    }
}
