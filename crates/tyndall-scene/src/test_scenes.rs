//! Scenes and lights made in a line for tests.

use glam::{
    DAffine3, Vec2, Vec3,
    camera::rh::{proj::directx, view},
    vec3,
};
use tyndall::frame::{Emitter, ShadowProjection};

use crate::scene::{Blocking, Material, Mesh, Node, Primitive, Scene, Texture};

/// Random numbers, equal on every machine (Knuth's MMIX linear congruential generator).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in the cube [-1, 1).
    pub(crate) fn point(&mut self) -> glam::DVec3 {
        glam::DVec3::from_array(std::array::from_fn(|_| 2.0 * self.unit() - 1.0))
    }
}

pub(crate) fn material(blocking: Blocking, base_color: [f32; 4]) -> Material {
    Material {
        base_color,
        base_color_texture: None,
        blocking,
        emissive: [0.0; 3],
    }
}

/// A scene with one material (and texture), from loose triangles with texture coordinates.
pub(crate) fn scene(
    triangles: &[[Vec3; 3]],
    uvs: impl Fn(Vec3) -> Vec2,
    mut material: Material,
    texture: Option<Texture>,
) -> Scene {
    material.base_color_texture = texture.as_ref().map(|_| 0);
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    let normals = triangles.iter().flat_map(|[a, b, c]| {
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
        [normal; 3]
    });
    Scene {
        nodes: vec![Node {
            name: String::new(),
            parent: None,
            parent_from_local: DAffine3::IDENTITY,
            mesh: Some(0),
            camera: None,
            light: None,
        }],
        meshes: vec![Mesh {
            primitives: vec![Primitive {
                normals: normals.collect(),
                uvs: positions.iter().map(|&p| uvs(p)).collect(),
                indices: (0..positions.len() as u32).collect(),
                material: 0,
                positions,
            }],
        }],
        materials: vec![material],
        textures: texture.into_iter().collect(),
        ..Scene::default()
    }
}

/// A scene of opaque triangles.
pub(crate) fn opaque(triangles: &[[Vec3; 3]]) -> Scene {
    let grey = material(Blocking::Opaque, [0.5, 0.5, 0.5, 1.0]);
    scene(triangles, |_| Vec2::ZERO, grey, None)
}

/// Two triangles that span a parallelogram.
pub(crate) fn quad(corner: Vec3, x: Vec3, y: Vec3) -> [[Vec3; 3]; 2] {
    [
        [corner, corner + x, corner + x + y],
        [corner, corner + x + y, corner + y],
    ]
}

/// The six sides of a box.
pub(crate) fn block(min: Vec3, max: Vec3) -> Vec<[Vec3; 3]> {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * (max - min));
    [
        (min, x, y),
        (min, y, z),
        (min, z, x),
        (max, -x, -y),
        (max, -y, -z),
        (max, -z, -x),
    ]
    .into_iter()
    .flat_map(|(corner, x, y)| quad(corner, x, y))
    .collect()
}

/// A ball of `2 rings^2` quads, closed: neighbours share their corners' coordinates.
pub(crate) fn ball(center: Vec3, radius: f32, rings: u32) -> Vec<[Vec3; 3]> {
    use std::f32::consts::PI;
    let point = |i: u32, j: u32| {
        // Poles and the seam are the same numbers from either side.
        let (theta, phi) = (
            PI * i as f32 / rings as f32,
            PI * (j % (2 * rings)) as f32 / rings as f32,
        );
        let ring = if i == 0 || i == rings {
            0.0
        } else {
            theta.sin()
        };
        center + radius * vec3(ring * phi.cos(), theta.cos(), ring * phi.sin())
    };
    (0..rings)
        .flat_map(|i| (0..2 * rings).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [
                point(i, j),
                point(i, j + 1),
                point(i + 1, j + 1),
                point(i + 1, j),
            ];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Triangles of all sizes, strewn in the cube [-1, 1].
pub(crate) fn soup(count: usize, seed: u64) -> Vec<[Vec3; 3]> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let center = random.point();
            let size = 0.4 * random.unit().powi(3);
            std::array::from_fn(|_| (center + size * random.point()).as_vec3())
        })
        .collect()
}

/// A sun at the zenith.
pub(crate) const SUN_OVERHEAD: Emitter = Emitter::Directional {
    direction: [0.0, -1.0, 0.0],
    illuminance: [1.0; 3],
};

/// Looks down from y = 3 onto 4 x 4 m: the near plane at y = 3, the far plane at y = -1.
pub(crate) fn map_from_above(reversed_depth: bool) -> ShadowProjection {
    let view_from_world = view::look_to_mat4(3.0 * Vec3::Y, Vec3::NEG_Y, Vec3::NEG_Z);
    let (near, far) = if reversed_depth {
        (4.0, 0.0)
    } else {
        (0.0, 4.0)
    };
    let clip = directx::orthographic(-2.0, 2.0, -2.0, 2.0, near, far) * view_from_world;
    ShadowProjection::Single {
        clip_from_world: clip.to_cols_array_2d(),
        reversed_depth,
    }
}
