//! A scene's surfaces as occluders, for techniques that bound shadows by geometry.

use glam::Mat4;
use tyndall::{Occluder, OccluderError, OccluderMesh};
use wgpu::Device;

use crate::{
    geometry::world_from_nodes,
    scene::{Blocking, Mesh, Scene},
};

/// The meshes of a scene that block light: opaque and masked surfaces, the latter as if they had no holes.
pub struct SceneOccluders {
    /// One a mesh of the scene; `None` where no node shows it or nothing of it blocks.
    meshes: Vec<Option<OccluderMesh>>,
}

impl SceneOccluders {
    /// Uploads every mesh that a node shows.
    ///
    /// # Errors
    /// [`OccluderError`] if a mesh is larger than the device binds.
    pub fn new(device: &Device, scene: &Scene) -> Result<Self, OccluderError> {
        let is_shown = |index| scene.nodes.iter().any(|node| node.mesh == Some(index));
        let upload = |(index, mesh): (usize, &Mesh)| {
            let (positions, indices) = blockers(scene, mesh);
            (is_shown(index) && !indices.is_empty())
                .then(|| OccluderMesh::new(device, &positions, &indices))
                .transpose()
        };
        let meshes = scene.meshes.iter().enumerate().map(upload);
        Ok(Self {
            meshes: meshes.collect::<Result<_, _>>()?,
        })
    }

    /// The occluders at their places in `scene`, which differs from the uploaded one in its nodes' places alone; those of
    /// one mesh stand side by side.
    pub fn places(&self, scene: &Scene) -> Vec<Occluder<'_>> {
        let world_from_node = world_from_nodes(scene);
        let mut occluders = Vec::new();
        for (index, mesh) in self.meshes.iter().enumerate() {
            let Some(mesh) = mesh else { continue };
            let nodes = scene.nodes.iter().zip(&world_from_node);
            let shown = nodes.filter(|(node, _)| node.mesh == Some(index));
            occluders.extend(shown.map(|(_, place)| Occluder {
                mesh,
                world_from_mesh: Mat4::from(*place).to_cols_array_2d(),
            }));
        }
        occluders
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.meshes.iter().flatten().map(OccluderMesh::bytes).sum()
    }
}

/// Positions and indices of the triangles that block.
fn blockers(scene: &Scene, mesh: &Mesh) -> (Vec<[f32; 3]>, Vec<u32>) {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for primitive in &mesh.primitives {
        match scene.materials[primitive.material].blocking {
            Blocking::Opaque | Blocking::Masked { .. } => {}
            Blocking::Transmissive { .. } | Blocking::Blended => continue,
        }
        let first = positions.len() as u32;
        positions.extend(primitive.positions.iter().map(|p| p.to_array()));
        indices.extend(primitive.indices.iter().map(|i| first + i));
    }
    (positions, indices)
}
