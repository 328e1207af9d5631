//! The viewpoint of a camera or a light, as one uniform.
//!
//! Vertices are taken relative to the eye before they are projected, so that near surfaces keep their precision
//! in a world of many kilometres; matrices are put together in f64.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DMat4, DVec3, DVec4, Vec3};
use tyndall::{
    camera::CameraRays,
    frame::{Camera, DepthRange, Emitter, Projection, ShadowProjection},
    shadow::faces,
};

/// `View` of `view.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ViewUniform {
    /// Clip space from world-space offsets from `origin`, column-major.
    pub(super) clip_from_relative: [[f32; 4]; 4],
    /// World-space point that vertices are taken relative to \[m].
    pub(super) origin: [f32; 3],
    _pad: f32,
    /// Direction from a point to the viewer is `xyz - w * (point - origin)`.
    pub(super) viewer: [f32; 4],
}

impl ViewUniform {
    /// The view of a camera.
    pub(super) fn of_camera(camera: &Camera) -> Self {
        // The basis does not depend on the image's size.
        let rays = CameraRays::new(camera, [1, 1]);
        let viewer = match camera.projection {
            Projection::Perspective { .. } => DVec4::W,
            Projection::Orthographic { .. } => (-rays.forward).extend(0.0),
        };
        let view_from_relative = DMat3::from_cols(rays.right, rays.up, rays.forward).transpose();
        let clip_from_view = clip_from_view(&camera.projection, camera.depth_range);
        Self::new(
            clip_from_view * DMat4::from_mat3(view_from_relative),
            camera.eye.into(),
            viewer,
        )
    }

    /// The views of a light, one a face of its shadow map. There are none if a cube is given to a light without a position.
    pub(super) fn of_light(emitter: &Emitter, projection: &ShadowProjection) -> Vec<Self> {
        let reversed = reversed_depth(projection);
        faces(emitter, projection)
            .unwrap_or_default()
            .iter()
            .map(|face| {
                let clip_from_world = if reversed {
                    face.clip_from_world
                } else {
                    FLIP_DEPTH * face.clip_from_world
                };
                let origin = light_origin(emitter, clip_from_world);
                let clip_from_relative =
                    clip_from_world * DMat4::from_translation(origin.as_dvec3());
                Self::new(clip_from_relative, origin, DVec4::W)
            })
            .collect()
    }

    fn new(clip_from_relative: DMat4, origin: Vec3, viewer: DVec4) -> Self {
        Self {
            clip_from_relative: clip_from_relative.as_mat4().to_cols_array_2d(),
            origin: origin.to_array(),
            _pad: 0.0,
            viewer: viewer.as_vec4().to_array(),
        }
    }
}

/// Turns depth that is 1 at the near plane into depth that is 0 there: z to w - z.
const FLIP_DEPTH: DMat4 = DMat4::from_cols(
    DVec4::X,
    DVec4::Y,
    DVec4::NEG_Z,
    DVec4::new(0.0, 0.0, 1.0, 1.0),
);

/// True if a shadow map holds 1 at its near plane.
pub(super) fn reversed_depth(projection: &ShadowProjection) -> bool {
    match *projection {
        ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. } => reversed_depth,
    }
}

/// A point near the surfaces on the light's map: the light itself or, for a sun, the middle of the map.
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

/// Clip space from a view space whose z is depth.
fn clip_from_view(projection: &Projection, depth_range: DepthRange) -> DMat4 {
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
    }) = *projection;
    let ([hx, hy], [cx, cy]) = (half_extent.map(f64::from), center.map(f64::from));
    let (near, far) = (f64::from(near), f64::from(far));
    // Depths at which the depth buffer holds 0 and 1.
    let (zero, one) = if depth_range.is_reversed() {
        (far, near)
    } else {
        (near, far)
    };
    let (x, y) = (DVec4::X / hx, DVec4::Y / hy);
    match projection {
        Projection::Perspective { .. } => {
            // z_ndc = (scale * z + offset) / z
            let (scale, offset) = if depth_range == DepthRange::ReversedInfinite {
                (0.0, near)
            } else {
                (one / (one - zero), -one * zero / (one - zero))
            };
            DMat4::from_cols(
                x,
                y,
                DVec4::new(-cx / hx, -cy / hy, scale, 1.0),
                DVec4::new(0.0, 0.0, offset, 0.0),
            )
        }
        Projection::Orthographic { .. } => {
            let scale = 1.0 / (one - zero);
            DMat4::from_cols(
                x,
                y,
                DVec4::new(0.0, 0.0, scale, 0.0),
                DVec4::new(-cx / hx, -cy / hy, -scale * zero, 1.0),
            )
        }
    }
}
