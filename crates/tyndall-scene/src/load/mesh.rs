//! Meshes: attributes and topology, as indexed triangle lists.

use std::collections::HashMap;

use glam::{Mat2, Vec2, Vec3};
use gltf::{Semantic, mesh::Mode};

use super::{
    accessor::{Integers, read_indices, read_vectors},
    buffers::Buffers,
    error::{Refusal, broken, called},
    material::Materials,
};
use crate::scene::{Material, Mesh, Primitive, Texture};

/// Most vertices and indices of a file, so that many references to one accessor cannot fill the memory.
const MAX_ELEMENTS: usize = 1 << 28;

/// The meshes that the scene uses, and their materials.
pub(super) struct Meshes<'a> {
    buffers: &'a Buffers<'a>,
    materials: Materials<'a>,
    quantized: bool,
    meshes: Vec<Mesh>,
    /// Scene index by the document's index.
    indices: HashMap<usize, usize>,
    elements: usize,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(document: &'a gltf::Document, buffers: &'a Buffers<'a>) -> Self {
        Self {
            buffers,
            materials: Materials::new(buffers),
            quantized: document
                .extensions_used()
                .any(|name| name == "KHR_mesh_quantization"),
            meshes: Vec::new(),
            indices: HashMap::new(),
            elements: 0,
        }
    }

    /// The scene's index of a mesh, which is read when it is first asked for.
    pub(super) fn index_of(&mut self, source: &gltf::Mesh<'_>) -> Result<usize, Refusal> {
        if let Some(&index) = self.indices.get(&source.index()) {
            return Ok(index);
        }
        let place = called("mesh", source.index(), source.name());
        let mut mesh = Mesh::default();
        for primitive in source.primitives() {
            let place = format!("{place}, primitive {}", primitive.index());
            let read = self
                .read_primitive(&primitive)
                .map_err(|refusal| refusal.within(&place))?;
            mesh.primitives.extend(read);
        }
        self.meshes.push(mesh);
        let index = self.meshes.len() - 1;
        self.indices.insert(source.index(), index);
        Ok(index)
    }

    pub(super) fn into_parts(self) -> (Vec<Mesh>, Vec<Material>, Vec<Texture>) {
        let (materials, textures) = self.materials.into_parts();
        (self.meshes, materials, textures)
    }

    /// `None` for points, lines, and primitives with too few vertices for a triangle, or none.
    fn read_primitive(
        &mut self,
        source: &gltf::Primitive<'_>,
    ) -> Result<Option<Primitive>, Refusal> {
        let Some(topology) = Topology::of(source.mode()) else {
            return Ok(None);
        };
        let Some(positions) = self.read_attribute::<3, Vec3>(source, &Semantic::Positions, None)?
        else {
            return Ok(None);
        };
        let count = positions.len();
        let indices = topology.triangles(&self.read_corners(source, count)?);
        if indices.is_empty() {
            return Ok(None);
        }
        let normals = self.read_attribute(source, &Semantic::Normals, Some(count))?;
        let primitive = Primitive {
            uvs: self.read_uvs(source, count)?,
            normals: Vec::new(),
            material: self.materials.index_of(&source.material())?,
            positions,
            indices,
        };
        Ok(Some(match normals.and_then(unit_normals) {
            Some(normals) => Primitive {
                normals,
                ..primitive
            },
            None => flat_shaded(primitive),
        }))
    }

    /// Reads an attribute of `count` vertices, where the primitive has it.
    fn read_attribute<const N: usize, V: From<[f32; N]>>(
        &mut self,
        source: &gltf::Primitive<'_>,
        semantic: &Semantic,
        count: Option<usize>,
    ) -> Result<Option<Vec<V>>, Refusal> {
        let Some(accessor) = source.get(semantic) else {
            return Ok(None);
        };
        let place = semantic.to_string();
        self.reserve(&accessor)?;
        let integers = match semantic {
            _ if self.quantized => Integers::Quantized,
            Semantic::TexCoords(_) => Integers::UnsignedNormalized,
            _ => Integers::Refused,
        };
        let vectors = read_vectors(&accessor, self.buffers, integers)
            .map_err(|refusal| refusal.within(&place))?;
        match count {
            Some(count) if count != vectors.len() => Err(broken(
                place,
                format!(
                    "must have {count} elements as POSITION has, found {}",
                    vectors.len()
                ),
            )),
            _ => Ok(Some(vectors.into_iter().map(V::from).collect())),
        }
    }

    /// The vertices in the order in which the topology joins them.
    fn read_corners(
        &mut self,
        source: &gltf::Primitive<'_>,
        vertices: usize,
    ) -> Result<Vec<u32>, Refusal> {
        let Some(accessor) = source.indices() else {
            return u32::try_from(vertices)
                .map(|vertices| (0..vertices).collect())
                .map_err(|_| broken("POSITION", format!("has too many elements: {vertices}")));
        };
        self.reserve(&accessor)?;
        let corners =
            read_indices(&accessor, self.buffers).map_err(|refusal| refusal.within("indices"))?;
        match corners.iter().find(|&&corner| corner as usize >= vertices) {
            None => Ok(corners),
            Some(corner) => Err(broken(
                "indices",
                format!("index {corner} is out of range for {vertices} vertices"),
            )),
        }
    }

    /// Texture coordinates for the base colour texture, with its transform applied.
    fn read_uvs(
        &mut self,
        source: &gltf::Primitive<'_>,
        vertices: usize,
    ) -> Result<Vec<Vec2>, Refusal> {
        let unused = vec![Vec2::ZERO; vertices];
        let material = source.material();
        let Some(info) = material.pbr_metallic_roughness().base_color_texture() else {
            return Ok(unused);
        };
        let transform = info.texture_transform();
        let set = transform
            .as_ref()
            .and_then(|transform| transform.tex_coord())
            .unwrap_or(info.tex_coord());
        let Some(mut uvs) =
            self.read_attribute::<2, Vec2>(source, &Semantic::TexCoords(set), Some(vertices))?
        else {
            return Ok(unused);
        };
        if let Some(transform) = transform {
            transform_uvs(&mut uvs, &transform)?;
        }
        Ok(uvs)
    }

    /// Counts an accessor against the file's limit, before anything is allocated for it.
    fn reserve(&mut self, accessor: &gltf::Accessor<'_>) -> Result<(), Refusal> {
        self.elements = self.elements.saturating_add(accessor.count());
        if self.elements <= MAX_ELEMENTS {
            return Ok(());
        }
        Err(broken(
            called("accessor", accessor.index(), accessor.name()),
            format!(
                "brings the file to {} vertices and indices, at most {MAX_ELEMENTS} are supported",
                self.elements
            ),
        ))
    }
}

/// The rule that joins corners to triangles.
#[derive(Clone, Copy)]
enum Topology {
    List,
    Strip,
    Fan,
}

impl Topology {
    fn of(mode: Mode) -> Option<Self> {
        match mode {
            Mode::Triangles => Some(Self::List),
            Mode::TriangleStrip => Some(Self::Strip),
            Mode::TriangleFan => Some(Self::Fan),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
        }
    }

    /// Three indices a triangle (glTF 2.0, section 3.7.2.1); corners that are left over are dropped.
    fn triangles(self, corners: &[u32]) -> Vec<u32> {
        match self {
            Self::List => corners.chunks_exact(3).flatten().copied().collect(),
            Self::Strip => corners
                .windows(3)
                .enumerate()
                .flat_map(|(i, w)| match i % 2 {
                    0 => [w[0], w[1], w[2]],
                    _ => [w[0], w[2], w[1]],
                })
                .collect(),
            Self::Fan => match corners {
                [center, rim @ ..] => rim
                    .windows(2)
                    .flat_map(|edge| [edge[0], edge[1], *center])
                    .collect(),
                [] => Vec::new(),
            },
        }
    }
}

/// `KHR_texture_transform`: scale, then rotate counter-clockwise as seen in the texture, then move.
fn transform_uvs(
    uvs: &mut [Vec2],
    transform: &gltf::texture::TextureTransform<'_>,
) -> Result<(), Refusal> {
    let linear = Mat2::from_angle(-transform.rotation())
        * Mat2::from_diagonal(Vec2::from(transform.scale()));
    let offset = Vec2::from(transform.offset());
    for uv in uvs.iter_mut() {
        *uv = linear * *uv + offset;
    }
    match uvs.iter().find(|uv| !uv.is_finite()) {
        None => Ok(()),
        Some(uv) => Err(broken(
            "KHR_texture_transform",
            format!("must give finite texture coordinates, found {uv}"),
        )),
    }
}

/// `None` if a normal has no direction; the file's normals are not to be trusted then.
fn unit_normals(normals: Vec<Vec3>) -> Option<Vec<Vec3>> {
    normals.into_iter().map(Vec3::try_normalize).collect()
}

/// Gives every triangle its own vertices, with the triangle's normal, as glTF asks for where there are no normals.
fn flat_shaded(shared: Primitive) -> Primitive {
    let corner = |&index: &u32| index as usize;
    let positions: Vec<Vec3> = shared
        .indices
        .iter()
        .map(|index| shared.positions[corner(index)])
        .collect();
    let normals = positions
        .chunks_exact(3)
        .flat_map(|p| [(p[1] - p[0]).cross(p[2] - p[0]).normalize_or(Vec3::Y); 3])
        .collect();
    Primitive {
        normals,
        uvs: shared
            .indices
            .iter()
            .map(|index| shared.uvs[corner(index)])
            .collect(),
        indices: (0..shared.indices.len() as u32).collect(),
        material: shared.material,
        positions,
    }
}
