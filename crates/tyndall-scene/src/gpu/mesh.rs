//! The scene's triangles in vertex and index buffers, its nodes' places in an instance buffer, and the draws.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::Affine3A;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, Device, Queue, RenderPass};

use super::{error::GpuSceneError, material::Materials};
use crate::{
    geometry::world_from_nodes,
    scene::{Blocking, Primitive, Scene},
};

/// A vertex in mesh space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    uv: [f32; 2],
}

/// The place of an instance of a mesh: the rows of world_from_local.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Instance {
    world_from_local: [[f32; 4]; 3],
}

impl Instance {
    fn new(world_from_local: &Affine3A) -> Self {
        let columns = [
            world_from_local.matrix3.x_axis,
            world_from_local.matrix3.y_axis,
            world_from_local.matrix3.z_axis,
            world_from_local.translation,
        ];
        Self {
            world_from_local: std::array::from_fn(|row| columns.map(|column| column[row])),
        }
    }
}

/// Vertex buffers as the pipelines read them: per vertex and per instance.
pub(super) const VERTEX_LAYOUTS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2],
    }),
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<Instance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![3 => Float32x4, 4 => Float32x4, 5 => Float32x4],
    }),
];

/// The kind of pipeline that a draw belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum DrawClass {
    Opaque,
    Masked,
    Translucent,
}

impl From<Blocking> for DrawClass {
    fn from(blocking: Blocking) -> Self {
        match blocking {
            Blocking::Opaque => Self::Opaque,
            Blocking::Masked { .. } => Self::Masked,
            Blocking::Transmissive { .. } | Blocking::Blended => Self::Translucent,
        }
    }
}

/// One primitive, drawn once an instance of its mesh.
struct Draw {
    class: DrawClass,
    material: usize,
    chunk: usize,
    indices: Range<u32>,
    base_vertex: i32,
    instances: Range<u32>,
}

/// Vertices and indices of some primitives, small enough for the device.
struct Chunk {
    vertices: Buffer,
    indices: Buffer,
}

/// All triangles of a scene.
pub(super) struct Meshes {
    chunks: Vec<Chunk>,
    /// Sorted by class and material.
    draws: Vec<Draw>,
    instances: Buffer,
    /// The node of each instance; instances of one mesh lie side by side.
    instance_nodes: Vec<usize>,
}

impl Meshes {
    /// Uploads every mesh that a node shows.
    pub(super) fn new(device: &Device, scene: &Scene) -> Result<Self, GpuSceneError> {
        let (instance_nodes, ranges) = instances_by_mesh(scene);
        let shown = shown_primitives(scene, &ranges);
        let limit = device.limits().max_buffer_size;
        let sizes: Vec<u64> = shown.iter().map(|s| buffer_bytes(s.primitive)).collect();
        if let Some((item, &found)) = shown.iter().zip(&sizes).find(|&(_, &bytes)| bytes > limit) {
            return Err(GpuSceneError::BufferSize {
                what: format!("primitive {} of mesh {}", item.index, item.mesh),
                found,
                limit,
            });
        }

        let mut chunks = Vec::new();
        let mut draws = Vec::new();
        for range in pack(&sizes, limit) {
            let members = &shown[range];
            draws.extend(chunk_draws(scene, members, chunks.len()));
            chunks.push(Chunk::new(device, members));
        }
        draws.sort_by_key(|draw| (draw.class, draw.material));
        Ok(Self {
            chunks,
            draws,
            instances: create_instances(device, scene, &instance_nodes)?,
            instance_nodes,
        })
    }

    /// Rewrites the places of all instances; `scene` differs from the uploaded one in nodes' places alone.
    pub(super) fn place(&self, queue: &Queue, scene: &Scene) {
        let instances = instance_data(scene, &self.instance_nodes);
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
    }

    /// True if anything of a class is there to be drawn.
    pub(super) fn has(&self, class: DrawClass) -> bool {
        self.draws.iter().any(|draw| draw.class == class)
    }

    /// Triangles of a class, each instance's own.
    pub(super) fn triangles(&self, class: DrawClass) -> usize {
        let of_class = self.draws.iter().filter(|draw| draw.class == class);
        of_class
            .map(|draw| draw.indices.len() / 3 * draw.instances.len())
            .sum()
    }

    /// Draws one class; `materials` bind to group 1 where the pipeline reads them.
    pub(super) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        class: DrawClass,
        materials: Option<&Materials>,
    ) {
        let (mut chunk, mut material) = (None, None);
        pass.set_vertex_buffer(1, self.instances.slice(..));
        for draw in self.draws.iter().filter(|draw| draw.class == class) {
            if chunk.replace(draw.chunk) != Some(draw.chunk) {
                let chunk = &self.chunks[draw.chunk];
                pass.set_vertex_buffer(0, chunk.vertices.slice(..));
                pass.set_index_buffer(chunk.indices.slice(..), wgpu::IndexFormat::Uint32);
            }
            if let Some(materials) = materials
                && material.replace(draw.material) != Some(draw.material)
            {
                pass.set_bind_group(1, materials.bind_group(draw.material), &[]);
            }
            pass.draw_indexed(
                draw.indices.clone(),
                draw.base_vertex,
                draw.instances.clone(),
            );
        }
    }
}

/// A primitive that some node shows.
struct Shown<'a> {
    mesh: usize,
    index: usize,
    primitive: &'a Primitive,
    instances: Range<u32>,
}

fn shown_primitives<'a>(scene: &'a Scene, instances: &[Range<u32>]) -> Vec<Shown<'a>> {
    scene
        .meshes
        .iter()
        .zip(instances)
        .enumerate()
        .filter(|(_, (_, instances))| !instances.is_empty())
        .flat_map(|(mesh, (data, instances))| {
            data.primitives
                .iter()
                .enumerate()
                .map(move |(index, primitive)| Shown {
                    mesh,
                    index,
                    primitive,
                    instances: instances.clone(),
                })
        })
        .filter(|shown| !shown.primitive.indices.is_empty())
        .collect()
}

/// The nodes of each instance, sorted by mesh, and each mesh's range of instances.
fn instances_by_mesh(scene: &Scene) -> (Vec<usize>, Vec<Range<u32>>) {
    let mut nodes = Vec::new();
    let ranges = (0..scene.meshes.len())
        .map(|mesh| {
            let start = nodes.len() as u32;
            nodes.extend((0..scene.nodes.len()).filter(|&n| scene.nodes[n].mesh == Some(mesh)));
            start..nodes.len() as u32
        })
        .collect();
    (nodes, ranges)
}

/// The larger of a primitive's vertex and index buffer \[bytes].
fn buffer_bytes(primitive: &Primitive) -> u64 {
    let vertices = primitive.positions.len() * size_of::<Vertex>();
    let indices = primitive.indices.len() * size_of::<u32>();
    vertices.max(indices) as u64
}

/// Splits items of these sizes, none above `limit`, into runs of at most `limit` each.
fn pack(sizes: &[u64], limit: u64) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let mut filled = 0;
    for (item, &size) in sizes.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if filled + size <= limit => {
                run.end = item + 1;
                filled += size;
            }
            _ => {
                runs.push(item..item + 1);
                filled = size;
            }
        }
    }
    runs
}

/// The draws of a chunk's primitives, which lie in it one after the other.
fn chunk_draws<'a>(
    scene: &'a Scene,
    members: &'a [Shown<'_>],
    chunk: usize,
) -> impl Iterator<Item = Draw> + 'a {
    let (mut vertex, mut index) = (0, 0);
    members.iter().map(move |shown| {
        let indices = index..index + shown.primitive.indices.len() as u32;
        let base_vertex = vertex;
        index = indices.end;
        vertex += shown.primitive.positions.len() as i32;
        Draw {
            class: scene.materials[shown.primitive.material].blocking.into(),
            material: shown.primitive.material,
            chunk,
            indices,
            base_vertex,
            instances: shown.instances.clone(),
        }
    })
}

impl Chunk {
    fn new(device: &Device, members: &[Shown<'_>]) -> Self {
        let vertices: Vec<Vertex> = members.iter().flat_map(|s| vertices(s.primitive)).collect();
        let indices: Vec<u32> = members
            .iter()
            .flat_map(|s| s.primitive.indices.iter().copied())
            .collect();
        Self {
            vertices: device.create_buffer_init(&BufferInitDescriptor {
                label: Some("scene vertices"),
                contents: bytemuck::cast_slice(&vertices),
                usage: BufferUsages::VERTEX,
            }),
            indices: device.create_buffer_init(&BufferInitDescriptor {
                label: Some("scene indices"),
                contents: bytemuck::cast_slice(&indices),
                usage: BufferUsages::INDEX,
            }),
        }
    }
}

fn vertices(primitive: &Primitive) -> impl Iterator<Item = Vertex> {
    primitive
        .positions
        .iter()
        .zip(&primitive.normals)
        .zip(&primitive.uvs)
        .map(|((position, normal), uv)| Vertex {
            position: position.to_array(),
            normal: normal.to_array(),
            uv: uv.to_array(),
        })
}

fn create_instances(
    device: &Device,
    scene: &Scene,
    nodes: &[usize],
) -> Result<Buffer, GpuSceneError> {
    let mut instances = instance_data(scene, nodes);
    let found = size_of_val(instances.as_slice()) as u64;
    let limit = device.limits().max_buffer_size;
    if found > limit {
        return Err(GpuSceneError::BufferSize {
            what: "the places of all nodes".to_owned(),
            found,
            limit,
        });
    }
    // An empty buffer can't be bound.
    if instances.is_empty() {
        instances.push(Instance::zeroed());
    }
    Ok(device.create_buffer_init(&BufferInitDescriptor {
        label: Some("scene instances"),
        contents: bytemuck::cast_slice(&instances),
        usage: BufferUsages::VERTEX | BufferUsages::COPY_DST,
    }))
}

fn instance_data(scene: &Scene, nodes: &[usize]) -> Vec<Instance> {
    let world_from_node = world_from_nodes(scene);
    nodes
        .iter()
        .map(|&node| Instance::new(&world_from_node[node]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_fills_runs_up_to_the_limit() {
        for (sizes, limit, expected) in [
            (vec![], 10, vec![]),
            (vec![10, 10], 10, vec![0..1, 1..2]),
            (vec![4, 6, 1], 10, vec![0..2, 2..3]),
            (vec![9, 9, 1, 9], 10, vec![0..1, 1..3, 3..4]),
        ] {
            assert_eq!(pack(&sizes, limit), expected, "{sizes:?}");
        }
    }
}
