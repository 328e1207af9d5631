//! A scene flattened: every instance of every mesh as triangles in world space.

use glam::{Affine3A, DAffine3, Mat3A, Vec2, Vec3};

use crate::scene::{Primitive, Scene};

/// An axis-aligned box in world space \[m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The smallest box around some points; `None` where there are none.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        points
            .into_iter()
            .map(|p| Self { min: p, max: p })
            .reduce(|a, b| Self {
                min: a.min.min(b.min),
                max: a.max.max(b.max),
            })
    }

    /// The middle \[m].
    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// The edges' lengths \[m].
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }
}

/// All triangles of a scene in world space, one entry each in every array.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Corners \[m].
    pub positions: Vec<[Vec3; 3]>,
    /// Unit normals at the corners.
    pub normals: Vec<[Vec3; 3]>,
    /// Texture coordinates at the corners.
    pub uvs: Vec<[Vec2; 3]>,
    /// Indices into [`Scene::materials`].
    pub materials: Vec<u32>,
}

impl Geometry {
    /// Flattens a scene. Instances of one mesh become triangles of their own.
    pub fn new(scene: &Scene) -> Self {
        let mut geometry = Self::default();
        for (node, world_from_local) in scene.nodes.iter().zip(world_from_nodes(scene)) {
            let primitives = node.mesh.map_or(&[][..], |m| &scene.meshes[m].primitives);
            for primitive in primitives {
                geometry.push(primitive, &world_from_local);
            }
        }
        geometry
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// True if there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The box around everything; `None` where there are no triangles.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.positions.iter().flatten().copied())
    }

    /// The triangles in another order: triangle `i` was `order[i]`.
    pub(crate) fn reordered(&self, order: &[u32]) -> Self {
        fn pick<T: Copy>(from: &[T], order: &[u32]) -> Vec<T> {
            order.iter().map(|&i| from[i as usize]).collect()
        }
        Self {
            positions: pick(&self.positions, order),
            normals: pick(&self.normals, order),
            uvs: pick(&self.uvs, order),
            materials: pick(&self.materials, order),
        }
    }

    fn push(&mut self, primitive: &Primitive, world_from_local: &Affine3A) {
        let normal_matrix = normal_matrix(world_from_local);
        let corners = |[a, b, c]: [usize; 3], of: &dyn Fn(usize) -> Vec3| [of(a), of(b), of(c)];
        for triangle in primitive.indices.chunks_exact(3) {
            let indices = [0, 1, 2].map(|i| triangle[i] as usize);
            self.positions.push(corners(indices, &|i| {
                world_from_local.transform_point3(primitive.positions[i])
            }));
            self.normals.push(corners(indices, &|i| {
                (normal_matrix * primitive.normals[i]).normalize_or(Vec3::Y)
            }));
            self.uvs.push(indices.map(|i| primitive.uvs[i]));
            self.materials.push(primitive.material as u32);
        }
    }
}

/// Transforms from the nodes' own spaces to world space, one a node. They are chained in double precision, so that nodes far
/// from the root's origin lose nothing if [`Scene::origin`] is near them.
pub fn world_from_nodes(scene: &Scene) -> Vec<Affine3A> {
    let world_from_root = DAffine3::from_translation(-scene.origin);
    let mut world_from_node: Vec<DAffine3> = Vec::with_capacity(scene.nodes.len());
    for node in &scene.nodes {
        let world_from_parent = node
            .parent
            .map_or(world_from_root, |parent| world_from_node[parent]);
        world_from_node.push(world_from_parent * node.parent_from_local);
    }
    world_from_node.iter().map(DAffine3::as_affine3a).collect()
}

/// The matrix that keeps normals normal to their surface: the cofactors, which unlike the inverse's transpose exist
/// for flattening transforms as well.
fn normal_matrix(transform: &Affine3A) -> Mat3A {
    let m = transform.matrix3;
    let cofactors = Mat3A::from_cols(
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    );
    if m.determinant() < 0.0 {
        -cofactors
    } else {
        cofactors
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, vec3};

    use super::*;
    use crate::scene::{Mesh, Node};

    fn node(parent: Option<usize>, parent_from_local: Affine3A, mesh: Option<usize>) -> Node {
        Node {
            name: String::new(),
            parent,
            parent_from_local: parent_from_local.as_daffine3(),
            mesh,
            camera: None,
            light: None,
        }
    }

    fn slanted_triangle() -> Mesh {
        let positions = vec![
            vec3(1.0, 0.0, 0.0),
            vec3(0.0, 2.0, 0.0),
            vec3(0.0, 0.0, 3.0),
        ];
        let normal = (positions[1] - positions[0])
            .cross(positions[2] - positions[0])
            .normalize();
        Mesh {
            primitives: vec![Primitive {
                normals: vec![normal; 3],
                uvs: vec![Vec2::ZERO; 3],
                indices: vec![0, 1, 2],
                material: 0,
                positions,
            }],
        }
    }

    #[test]
    fn nothing_has_no_bounds() {
        let geometry = Geometry::new(&Scene::default());
        assert!(geometry.is_empty());
        assert_eq!(geometry.bounds(), None);
    }

    #[test]
    fn transforms_chain_and_normals_stay_normal() {
        let parent = Affine3A::from_scale_rotation_translation(
            vec3(2.0, 0.5, -1.0),
            Quat::from_rotation_z(0.3),
            vec3(5.0, 0.0, -7.0),
        );
        let child = Affine3A::from_rotation_y(1.1);
        let scene = Scene {
            nodes: vec![
                node(None, parent, None),
                node(Some(0), child, Some(0)),
                node(None, Affine3A::IDENTITY, Some(0)),
            ],
            meshes: vec![slanted_triangle()],
            ..Scene::default()
        };
        let geometry = Geometry::new(&scene);
        assert_eq!(geometry.len(), 2);
        for (transform, positions) in [parent * child, Affine3A::IDENTITY]
            .iter()
            .zip(&geometry.positions)
        {
            let expected = transform.transform_point3(vec3(0.0, 2.0, 0.0));
            assert!((positions[1] - expected).length() < 1e-5);
        }
        for (positions, normals) in geometry.positions.iter().zip(&geometry.normals) {
            let [a, b, c] = *positions;
            assert!(normals[0].dot((b - a).normalize()).abs() < 1e-6);
            assert!(normals[0].dot((c - a).normalize()).abs() < 1e-6);
        }
    }

    #[test]
    fn flattened_instances_keep_finite_normals() {
        let flat = Affine3A::from_scale(vec3(1.0, 0.0, 1.0));
        let scene = Scene {
            nodes: vec![node(None, flat, Some(0))],
            meshes: vec![slanted_triangle()],
            ..Scene::default()
        };
        let geometry = Geometry::new(&scene);
        assert!(geometry.normals[0].iter().all(|n| n.is_normalized()));
        let bounds = geometry.bounds().unwrap();
        assert_eq!(bounds.extent(), vec3(1.0, 0.0, 3.0));
        assert_eq!(bounds.center(), vec3(0.5, 0.0, 1.5));
    }
}
