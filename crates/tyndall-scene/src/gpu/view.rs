//! Where the scene is seen from: a camera or a light, as one uniform.
//!
//! Vertices are taken relative to the eye before they are projected, so that what is near keeps its precision
//! in a world of many kilometres; matrices are put together in f64.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, DVec4, Vec3};
use tyndall::frame::{Camera, Emitter, Projection, ShadowProjection};

/// `View` of `view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ViewUniform {
    /// Clip space from world-space offsets from `origin`, column-major.
    pub(super) clip_from_relative: [[f32; 4]; 4],
    /// World-space point that vertices are taken relative to [m].
    pub(super) origin: [f32; 3],
    pub(super) _pad: f32,
    /// Direction from a point to the viewer is `xyz - w * (point - origin)`.
    pub(super) viewer: [f32; 4],
}

impl ViewUniform {
    /// What a camera sees.
    pub(super) fn of_camera(camera: &Camera) -> Self {
        let forward = DVec3::from(camera.forward.map(f64::from)).normalize_or_zero();
        let viewer = match camera.projection {
            Projection::Perspective { .. } => DVec4::W,
            Projection::Orthographic { .. } => (-forward).extend(0.0),
        };
        Self {
            clip_from_relative: clip_from_relative(camera).as_mat4().to_cols_array_2d(),
            origin: camera.eye,
            _pad: 0.0,
            viewer: viewer.as_vec4().to_array(),
        }
    }

    /// What a light sees: one view a face of its shadow map.
    pub(super) fn of_light(emitter: &Emitter, projection: &ShadowProjection) -> Vec<Self> {
        match *projection {
            ShadowProjection::Single {
                clip_from_world, ..
            } => {
                let clip_from_world =
                    DMat4::from_cols_array_2d(&clip_from_world.map(|c| c.map(f64::from)));
                let origin = light_origin(emitter, clip_from_world);
                let clip_from_relative =
                    clip_from_world * DMat4::from_translation(origin.as_dvec3());
                vec![Self::of_matrix(clip_from_relative, origin)]
            }
            ShadowProjection::Cube {
                near,
                far,
                reversed_depth,
            } => {
                let origin = light_origin(emitter, DMat4::IDENTITY);
                let projection = clip_from_view(
                    &Projection::Perspective {
                        half_extent: [1.0; 2],
                        center: [0.0; 2],
                        near,
                        far,
                    },
                    reversed_depth,
                );
                CUBE_FACES
                    .iter()
                    .map(|face| {
                        let [right, up, forward] = face.map(DVec3::from);
                        Self::of_matrix(projection * view_from_relative(right, up, forward), origin)
                    })
                    .collect()
            }
        }
    }

    fn of_matrix(clip_from_relative: DMat4, origin: Vec3) -> Self {
        Self {
            clip_from_relative: clip_from_relative.as_mat4().to_cols_array_2d(),
            origin: origin.to_array(),
            _pad: 0.0,
            viewer: [0.0, 0.0, 0.0, 1.0],
        }
    }
}

/// Right, up and forward of the faces +X, -X, +Y, -Y, +Z, -Z as WebGPU and Direct3D lay them out.
/// The bases are left-handed: a cube map is seen from within.
const CUBE_FACES: [[[f64; 3]; 3]; 6] = [
    [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
];

/// A point near what the light's map shows: the light itself, or, of a sun, the middle of the map.
fn light_origin(emitter: &Emitter, clip_from_world: DMat4) -> Vec3 {
    match *emitter {
        Emitter::Point { position, .. } | Emitter::Spot { position, .. } => position.into(),
        Emitter::Rect { center, .. } => center.into(),
        Emitter::Directional { .. } => clip_from_world
            .inverse()
            .project_point3(DVec3::new(0.0, 0.0, 0.5))
            .as_vec3(),
    }
}

/// The camera's clip space from world-space offsets from its eye.
pub(super) fn clip_from_relative(camera: &Camera) -> DMat4 {
    let [right, up, forward] = basis(camera);
    clip_from_view(&camera.projection, camera.reversed_depth)
        * view_from_relative(right, up, forward)
}

/// The camera's unit right, up and forward in world space.
pub(super) fn basis(camera: &Camera) -> [DVec3; 3] {
    let forward = DVec3::from(camera.forward.map(f64::from)).normalize_or_zero();
    let up = DVec3::from(camera.up.map(f64::from));
    let right = forward.cross(up).normalize_or_zero();
    [right, right.cross(forward), forward]
}

/// View space here is x right, y up, z forward: depth is z itself.
fn view_from_relative(right: DVec3, up: DVec3, forward: DVec3) -> DMat4 {
    DMat4::from_cols(
        right.extend(0.0),
        up.extend(0.0),
        forward.extend(0.0),
        DVec4::W,
    )
    .transpose()
}

/// Clip space from a view space whose z is depth.
fn clip_from_view(projection: &Projection, reversed_depth: bool) -> DMat4 {
    match *projection {
        Projection::Perspective {
            half_extent,
            center,
            near,
            far,
        } => {
            let ([hx, hy], [cx, cy]) = (half_extent.map(f64::from), center.map(f64::from));
            let (near, far) = (f64::from(near), f64::from(far));
            // z_ndc = (scale * z + offset) / z is 0 at one plane and 1 at the other.
            let (zero, one) = if reversed_depth {
                (far, near)
            } else {
                (near, far)
            };
            let scale = one / (one - zero);
            DMat4::from_cols(
                DVec4::new(1.0 / hx, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / hy, 0.0, 0.0),
                DVec4::new(-cx / hx, -cy / hy, scale, 1.0),
                DVec4::new(0.0, 0.0, -scale * zero, 0.0),
            )
        }
        Projection::Orthographic {
            half_extent,
            center,
            near,
            far,
        } => {
            let ([hx, hy], [cx, cy]) = (half_extent.map(f64::from), center.map(f64::from));
            let (near, far) = (f64::from(near), f64::from(far));
            let (zero, one) = if reversed_depth {
                (far, near)
            } else {
                (near, far)
            };
            let scale = 1.0 / (one - zero);
            DMat4::from_cols(
                DVec4::new(1.0 / hx, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / hy, 0.0, 0.0),
                DVec4::new(0.0, 0.0, scale, 0.0),
                DVec4::new(-cx / hx, -cy / hy, -scale * zero, 1.0),
            )
        }
    }
}
