//! Hand-made scenes, and cameras and lights among them.

use glam::{Affine3A, DMat4, DVec3, Quat, Vec2, Vec3, dcamera::rh, vec2};
use tyndall::frame::{Camera, DepthRange, Emitter, Projection, ShadowProjection};
use tyndall_scene::scene::{Blocking, Material, Mesh, Node, Primitive, Scene, Texture, Wrap};
use tyndall_testkit::samples::in_box;

/// A scene of rectangles, each with a material of its own.
#[derive(Default)]
pub(crate) struct Builder {
    scene: Scene,
}

impl Builder {
    /// Adds a rectangle from a corner along two edges, the texture's left-to-right and top-to-bottom.
    pub(crate) fn rectangle(mut self, corner: Vec3, edges: [Vec3; 2], material: Material) -> Self {
        let uvs = [
            vec2(0.0, 0.0),
            vec2(1.0, 0.0),
            vec2(1.0, 1.0),
            vec2(0.0, 1.0),
        ];
        let normal = edges[0].cross(edges[1]).normalize();
        let mesh = self.scene.meshes.len();
        self.scene.meshes.push(Mesh {
            primitives: vec![Primitive {
                positions: uvs
                    .map(|uv| corner + uv.x * edges[0] + uv.y * edges[1])
                    .to_vec(),
                normals: vec![normal; 4],
                uvs: uvs.map(Vec2::from).to_vec(),
                indices: vec![0, 1, 2, 0, 2, 3],
                material: self.scene.materials.len(),
            }],
        });
        self.scene.materials.push(material);
        self.scene.nodes.push(node(Affine3A::IDENTITY, mesh));
        self
    }

    /// Adds a texture; the next material may refer to it by this index: 0, 1, ...
    pub(crate) fn texture(mut self, size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> Self {
        let rows = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        self.scene.textures.push(Texture {
            size,
            texels: rows.map(|(x, y)| texel(x, y)).collect(),
            wrap: [Wrap::ClampToEdge; 2],
        });
        self
    }

    pub(crate) fn build(self) -> Scene {
        self.scene
    }
}

fn node(parent_from_local: Affine3A, mesh: usize) -> Node {
    Node {
        name: String::new(),
        parent: None,
        parent_from_local: parent_from_local.as_daffine3(),
        mesh: Some(mesh),
        camera: None,
        light: None,
    }
}

pub(crate) fn material(base_color: [f32; 4], blocking: Blocking) -> Material {
    Material {
        base_color,
        base_color_texture: None,
        blocking,
        emissive: [0.0; 3],
    }
}

/// A wall of half extent `half` about the origin of a plane, facing +Z.
pub(crate) fn wall(half: f32, z: f32) -> (Vec3, [Vec3; 2]) {
    (
        Vec3::new(-half, half, z),
        [2.0 * half * Vec3::X, -2.0 * half * Vec3::Y],
    )
}

/// Rectangles here and there, of every kind of material, plain and textured, placed by turned, stretched and mirrored
/// nodes, and a wall behind them all.
pub(crate) fn clutter(rectangles: usize) -> Scene {
    let checks = |x: u32, y: u32| {
        let [r, g, b] = [17 * x, 17 * y, 120 + 60 * ((x / 2 + y / 2) % 2)].map(|v| v as u8);
        [r, g, b, [255, 40][((x / 4 + y / 4) % 2) as usize]]
    };
    let kinds = [
        Blocking::Opaque,
        Blocking::Masked { cutoff: 0.5 },
        Blocking::Transmissive { transmission: 0.8 },
        Blocking::Blended,
    ];
    let builder = Builder::default().texture([16, 16], checks);
    let (corner, edges) = wall(20.0, -12.0);
    let builder = builder.rectangle(corner, edges, material([0.5; 4], Blocking::Opaque));
    let mut scene = (0..rectangles)
        .fold(builder, |builder, i| {
            let material = Material {
                base_color_texture: (i % 3 != 0).then_some(0),
                emissive: [0.0, 0.0, i as f32],
                ..material([0.9, 0.7, 0.8, 0.9], kinds[i % 4])
            };
            let (corner, edges) = wall(1.0, 0.0);
            builder.rectangle(corner, edges, material)
        })
        .build();
    // The samples begin with the box's corners.
    let places = in_box(7, rectangles, [const { -1.0..=1.0 }; 8]).split_off(1 << 8);
    for (i, [x, y, z, a, b, c, d, e]) in places.into_iter().enumerate() {
        scene.nodes[i + 1].parent_from_local = Affine3A::from_scale_rotation_translation(
            Vec3::new(1.5 + d, 1.5 + e, -1.0),
            Quat::from_euler(glam::EulerRot::XYZ, 3.0 * a, 3.0 * b, 3.0 * c),
            Vec3::new(5.0 * x, 4.0 * y, 6.0 * z),
        )
        .as_daffine3();
    }
    scene
}

/// Cameras of all kinds among the clutter.
pub(crate) fn cameras() -> Vec<(&'static str, Camera)> {
    let perspective = Projection::Perspective {
        half_extent: [0.8, 0.6],
        center: [0.1, -0.05],
        near: 0.1,
        far: 40.0,
    };
    let orthographic = Projection::Orthographic {
        half_extent: [4.0, 3.0],
        center: [0.5, 0.2],
        near: -1.0,
        far: 30.0,
    };
    [
        ("perspective", perspective, DepthRange::Standard),
        ("perspective reversed", perspective, DepthRange::Reversed),
        (
            "perspective infinite",
            perspective,
            DepthRange::ReversedInfinite,
        ),
        ("orthographic", orthographic, DepthRange::Standard),
        ("orthographic reversed", orthographic, DepthRange::Reversed),
    ]
    .map(|(name, projection, depth_range)| {
        let camera = Camera {
            eye: [1.0, 2.0, 9.0],
            forward: [-0.1, -0.2, -1.0],
            up: [0.1, 1.0, 0.0],
            projection,
            depth_range,
        };
        (name, camera)
    })
    .into()
}

/// Lights of all kinds that have shadow maps.
pub(crate) fn lights_with_maps() -> Vec<(&'static str, Emitter, ShadowProjection)> {
    let position = [0.5, 0.7, 1.0];
    let single = |clip_from_world: DMat4, reversed_depth| ShadowProjection::Single {
        clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
        reversed_depth,
    };
    let cube = |reversed_depth| ShadowProjection::Cube {
        near: 0.2,
        far: 30.0,
        reversed_depth,
    };
    let sun = Emitter::Directional {
        direction: [-0.3, -1.0, -0.5],
        illuminance: [1.0; 3],
    };
    let sun_view = rh::view::look_to_mat4(
        DVec3::new(3.0, 12.0, 6.0),
        DVec3::new(-0.3, -1.0, -0.5),
        DVec3::X,
    );
    let ortho =
        |near, far| rh::proj::directx::orthographic(-9.0, 9.0, -8.0, 8.0, near, far) * sun_view;
    let spot = Emitter::Spot {
        position,
        direction: [0.2, 0.1, -1.0],
        intensity: [1.0; 3],
        inner: 0.1,
        outer: 0.7,
        radius: 0.0,
    };
    let spot_view = rh::view::look_to_mat4(
        DVec3::from(position.map(f64::from)),
        DVec3::new(0.2, 0.1, -1.0),
        DVec3::Y,
    );
    let point = Emitter::Point {
        position,
        intensity: [1.0; 3],
        radius: 0.0,
    };
    let fov = |near, far| rh::proj::directx::perspective(1.4, 1.0, near, far) * spot_view;
    vec![
        ("sun", sun, single(ortho(0.5, 40.0), false)),
        ("sun reversed", sun, single(ortho(40.0, 0.5), true)),
        ("spot", spot, single(fov(0.2, 30.0), false)),
        ("spot reversed", spot, single(fov(30.0, 0.2), true)),
        ("point", point, cube(false)),
        ("point reversed", point, cube(true)),
    ]
}
