//! The extent of a light's mesh: faces, cells, and its end beyond all that is seen.

use glam::{DMat4, DVec3};

use super::{mesh::ParamsUniform, tessellation::Square};
use crate::{
    camera::CameraRays,
    frame::{Emitter, Light},
    shadow,
};

/// The mesh of one light, from one eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// Cells a side of a face: texels + 1.
    pub(super) cells: [u32; 2],
    /// Faces of the map.
    pub(super) faces: u32,
    /// World space, relative to the eye, from a single map's clip space.
    world_from_clip: DMat4,
    /// See `mesh.wesl`.
    far_plane: [f64; 4],
    /// True where the map is mirrored: right x up points away from the light.
    mirrored: bool,
}

impl Extent {
    /// For a map of `size` texels a face. `None` without shadow map.
    pub(super) fn new(light: &Light, size: [u32; 2], rays: &CameraRays) -> Option<Self> {
        let faces = shadow::faces(&light.emitter, light.shadow.as_ref()?)?;
        let reach = 1.01 * rays.reach();
        let cells = size.map(|n| n + 1);
        if faces.len() > 1 {
            let from_eye = light_position(&light.emitter)?.distance(rays.eye);
            return Some(Self {
                cells,
                faces: faces.len() as u32,
                world_from_clip: DMat4::IDENTITY,
                far_plane: [0.0, 0.0, 0.0, from_eye + reach],
                mirrored: true,
            });
        }
        let clip_from_world = faces[0].clip_from_world * DMat4::from_translation(rays.eye);
        let world_from_clip = clip_from_world.inverse();
        let point = |x: f64, y: f64, z: f64| world_from_clip.project_point3(DVec3::new(x, y, z));
        // Depth is 1 nearest to the light.
        let away = (point(0.0, 0.0, 0.25) - point(0.0, 0.0, 0.75)).normalize_or_zero();
        let right = point(0.5, 0.0, 0.5) - point(-0.5, 0.0, 0.5);
        let up = point(0.0, 0.5, 0.5) - point(0.0, -0.5, 0.5);
        Some(Self {
            cells,
            faces: 1,
            world_from_clip,
            far_plane: away.extend(reach).to_array(),
            mirrored: right.cross(up).dot(away) > 0.0,
        })
    }

    /// Triangles that the adaptive mesh may have: half as many as the full one, which is drawn beyond that.
    pub(super) fn capacity(&self, limits: &wgpu::Limits) -> u32 {
        (self.full_triangles() / 2).min(limits.max_storage_buffer_binding_size / 4) as u32
    }

    /// Triangles of the surface with no cells merged.
    pub(super) fn full_triangles(&self) -> u64 {
        let [columns, rows] = self.cells.map(u64::from);
        2 * columns * rows * u64::from(self.faces)
    }

    /// The shaders' parameters.
    pub(super) fn uniform(&self, tolerance: f64, capacity: u32) -> ParamsUniform {
        let square = Square::new(self.cells);
        ParamsUniform {
            world_from_clip: self.world_from_clip.as_mat4().to_cols_array_2d(),
            far_plane: self.far_plane.map(|x| x as f32),
            cells: self.cells,
            pitch: square.pitch(),
            rows: square.rows(),
            tolerance: tolerance as f32,
            capacity,
            mirrored: u32::from(self.mirrored),
            pad: 0,
        }
    }
}

/// Position of a local light \[m].
fn light_position(emitter: &Emitter) -> Option<DVec3> {
    match *emitter {
        Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
            Some(crate::physics::reals(position))
        }
        Emitter::Directional { .. } | Emitter::Rect { .. } => None,
    }
}
