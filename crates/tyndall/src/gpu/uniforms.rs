//! The uniform blocks, byte for byte as their WGSL namesakes; positions are relative to the eye.

use bytemuck::Zeroable;
use glam::{DMat4, DVec3};

use crate::{
    camera::CameraRays,
    frame::{self, DepthRange, Emitter, Projection, ShadowProjection},
    light::texture::{MappingKind, TextureMapping},
    phase::MAX_PARAMS,
    physics::{medium::Optics, reals},
    shader::block,
    shadow,
};

block! {
    /// The shaders' `Frame`.
    pub(crate) struct FrameUniform = "Frame" in "tyndall::gpu::frame", checked by frame_is_laid_out_as_in_wgsl {
        pub(crate) camera: CameraUniform,
        pub(crate) medium: MediumUniform,
    }
}

block! {
    /// The shaders' `Camera`.
    pub(crate) struct CameraUniform = "Camera" in "tyndall::camera::camera", checked by camera_is_laid_out_as_in_wgsl {
        pub(crate) right: [f32; 3],
        pub(crate) near: f32,
        pub(crate) up: [f32; 3],
        pub(crate) far: f32,
        pub(crate) forward: [f32; 3],
        pub(crate) flags: u32,
        pub(crate) half_extent: [f32; 2],
        pub(crate) center: [f32; 2],
        pub(crate) size: [f32; 2],
        pad: [f32; 2],
    }
}

block! {
    /// The shaders' `Medium`.
    pub(crate) struct MediumUniform = "Medium" in "tyndall::physics::medium", checked by medium_is_laid_out_as_in_wgsl {
        pub(crate) sigma_t: [f32; 3],
        pub(crate) count: u32,
        pub(crate) components: [MediumComponentUniform; frame::Medium::MAX_COMPONENTS],
    }
}

block! {
    /// The shaders' `MediumComponent`.
    pub(crate) struct MediumComponentUniform = "MediumComponent" in "tyndall::physics::medium", checked by medium_component_is_laid_out_as_in_wgsl {
        pub(crate) sigma_s: [f32; 3],
        pub(crate) phase: u32,
        pub(crate) parameters: [f32; MAX_PARAMS],
        pad: [f32; 2],
    }
}

block! {
    /// The shaders' `Light`.
    #[derive(Default)]
    pub(crate) struct LightUniform = "Light" in "tyndall::light::light", checked by light_is_laid_out_as_in_wgsl {
        pub(crate) color: [f32; 3],
        pub(crate) cos_inner: f32,
        pub(crate) position: [f32; 3],
        pub(crate) cos_outer: f32,
        pub(crate) direction: [f32; 3],
        pad_direction: f32,
        pub(crate) texture_rows: [[f32; 4]; 3],
        pub(crate) clip_from_world: [[f32; 4]; 4],
        pub(crate) cube_depth: [f32; 2],
        pub(crate) standard_depth: u32,
        pad: u32,
    }
}

/// Which kind of light and which phase functions a pipeline is made for: `LIGHT_KIND`, `LIGHT_TEXTURE`, `SHADOW_KIND`,
/// `SHADOW_GLASS`, `MEDIUM_PHASES`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct LightVariant {
    pub(crate) kind: u32,
    pub(crate) texture: u32,
    pub(crate) shadow: u32,
    pub(crate) glass: bool,
    /// Bit n is set where the medium has phase function n.
    pub(crate) phases: u32,
}

impl LightVariant {
    /// The same in this medium.
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
            ("SHADOW_GLASS", f64::from(u8::from(self.glass))),
            ("MEDIUM_PHASES", self.phases.into()),
        ]
    }
}

const CAMERA_REVERSED_DEPTH: u32 = 1;
const CAMERA_ORTHOGRAPHIC: u32 = 2;
const CAMERA_INFINITE_DEPTH: u32 = 4;

impl FrameUniform {
    pub(crate) fn new(frame: &frame::Frame, rays: &CameraRays, size: [u32; 2]) -> Self {
        Self {
            camera: CameraUniform::new(&frame.camera, rays, size),
            medium: MediumUniform::new(&frame.medium),
        }
    }
}

impl CameraUniform {
    fn new(camera: &frame::Camera, rays: &CameraRays, size: [u32; 2]) -> Self {
        let (projection_flag, half_extent, center, near, far) = match camera.projection {
            Projection::Perspective {
                half_extent,
                center,
                near,
                far,
            } => (0, half_extent, center, near, far),
            Projection::Orthographic {
                half_extent,
                center,
                near,
                far,
            } => (CAMERA_ORTHOGRAPHIC, half_extent, center, near, far),
        };
        let depth_flags = match camera.depth_range {
            DepthRange::Standard => 0,
            DepthRange::Reversed => CAMERA_REVERSED_DEPTH,
            DepthRange::ReversedInfinite => CAMERA_REVERSED_DEPTH | CAMERA_INFINITE_DEPTH,
        };
        Self {
            right: floats(rays.right),
            near,
            up: floats(rays.up),
            far,
            forward: floats(rays.forward),
            flags: projection_flag | depth_flags,
            half_extent,
            center,
            size: size.map(|n| n as f32),
            pad: [0.0; 2],
        }
    }
}

impl MediumUniform {
    fn new(medium: &frame::Medium) -> Self {
        let mut components = [MediumComponentUniform::zeroed(); frame::Medium::MAX_COMPONENTS];
        for (slot, component) in components.iter_mut().zip(&medium.components) {
            *slot = MediumComponentUniform {
                sigma_s: component.sigma_s,
                phase: component.phase.number(),
                parameters: component.phase.values(),
                pad: [0.0; 2],
            };
        }
        Self {
            sigma_t: floats(Optics::new(medium).sigma_t),
            count: medium.components.len() as u32,
            components,
        }
    }
}

impl LightUniform {
    /// A light as the shaders see it, and the variant of pipeline it needs.
    pub(crate) fn new(light: &frame::Light, eye: DVec3, has_glass: bool) -> (Self, LightVariant) {
        let mut uniform = Self::default();
        let mut variant = LightVariant {
            glass: has_glass,
            ..LightVariant::default()
        };
        uniform.set_emitter(&light.emitter, eye, &mut variant);
        if let Some(projection) = &light.shadow {
            uniform.set_shadow(&light.emitter, projection, eye, &mut variant);
        }
        let mapping = light
            .texture
            .and_then(|placement| TextureMapping::new(&light.emitter, &placement));
        if let Some(mapping) = mapping {
            uniform.texture_rows = mapping.rows.map(|row| {
                row.extend(row.dot(eye - mapping.origin))
                    .as_vec4()
                    .to_array()
            });
            variant.texture = match mapping.kind {
                MappingKind::Affine => 1,
                MappingKind::Projective => 2,
                MappingKind::Sphere => 3,
            };
        }
        (uniform, variant)
    }

    fn set_emitter(&mut self, emitter: &Emitter, eye: DVec3, variant: &mut LightVariant) {
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
            } => {
                variant.kind = 1;
                self.color = intensity;
                self.position = floats(reals(position) - eye);
            }
            Emitter::Spot {
                position,
                direction,
                intensity,
                inner,
                outer,
            } => {
                variant.kind = 2;
                self.color = intensity;
                self.position = floats(reals(position) - eye);
                self.direction = floats(reals(direction).normalize_or_zero());
                self.cos_inner = inner.cos();
                self.cos_outer = outer.cos();
            }
            Emitter::Rect {
                center,
                edge_x,
                edge_y,
                radiance,
                ..
            } => {
                variant.kind = 3;
                self.color = radiance;
                self.position = floats(reals(center) - eye);
                let normal = reals(edge_x).cross(reals(edge_y));
                self.direction = floats(normal.normalize_or_zero());
            }
        }
    }

    fn set_shadow(
        &mut self,
        emitter: &Emitter,
        projection: &ShadowProjection,
        eye: DVec3,
        variant: &mut LightVariant,
    ) {
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) = *projection;
        self.standard_depth = u32::from(!reversed_depth);
        match *projection {
            ShadowProjection::Single { .. } => {
                variant.shadow = 1;
                if let Some(faces) = shadow::faces(emitter, projection) {
                    let relative = faces[0].clip_from_world * DMat4::from_translation(eye);
                    self.clip_from_world = relative.as_mat4().to_cols_array_2d();
                }
            }
            ShadowProjection::Cube { near, far, .. } => {
                variant.shadow = 2;
                let scale = f64::from(near) / (f64::from(far) - f64::from(near));
                self.cube_depth = [(scale * f64::from(far)) as f32, -scale as f32];
            }
        }
    }
}

fn floats(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}
