//! The space that a scene's triangles sweep as its nodes move.

use std::ops::RangeInclusive;

use glam::{Affine3A, Vec3};
use tyndall_scene::{
    geometry::{Bounds, Geometry, world_from_nodes},
    scene::{Mesh, Scene},
};

/// The triangles that stay in place, and boxes round the others wherever they come in these frames. `pose` puts the nodes
/// where they are in a frame.
pub(super) fn swept(
    rest: &Scene,
    frames: RangeInclusive<u32>,
    pose: impl Fn(&mut Scene, u32),
) -> Geometry {
    let mut scene = Scene {
        origin: rest.origin,
        nodes: rest.nodes.clone(),
        animations: rest.animations.clone(),
        ..Scene::default()
    };
    let mut places: Vec<Vec<Affine3A>> = vec![Vec::new(); scene.nodes.len()];
    for frame in frames {
        pose(&mut scene, frame);
        for (places, place) in places.iter_mut().zip(world_from_nodes(&scene)) {
            if places.last() != Some(&place) {
                places.push(place);
            }
        }
    }
    let mut swept = Geometry::default();
    for (node, places) in scene.nodes.iter().zip(&places) {
        let Some(mesh) = node.mesh.and_then(|mesh| rest.meshes.get(mesh)) else {
            continue;
        };
        match places[..] {
            [place] => swept.positions.extend(triangles(mesh, &place)),
            _ => swept.positions.extend(boxes(mesh, places)),
        }
    }
    swept
}

fn triangles<'a>(mesh: &'a Mesh, place: &'a Affine3A) -> impl Iterator<Item = [Vec3; 3]> + 'a {
    mesh.primitives.iter().flat_map(move |primitive| {
        let corner = |i: u32| place.transform_point3(primitive.positions[i as usize]);
        let (triangles, _) = primitive.indices.as_chunks::<3>();
        triangles.iter().map(move |triangle| triangle.map(corner))
    })
}

/// The corners of a mesh's box at several places, as triangles that have them.
fn boxes(mesh: &Mesh, places: &[Affine3A]) -> Vec<[Vec3; 3]> {
    let points = mesh.primitives.iter().flat_map(|p| &p.positions).copied();
    let Some(Bounds { min, max }) = Bounds::of(points) else {
        return Vec::new();
    };
    let corner = |i: usize| {
        Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { max[k] } else { min[k] }))
    };
    let corners = |place: &Affine3A| -> Vec<[Vec3; 3]> {
        let triangle =
            |i: usize| [i, (i + 1) % 8, (i + 2) % 8].map(|i| place.transform_point3(corner(i)));
        (0..8).step_by(3).map(triangle).collect()
    };
    places.iter().flat_map(corners).collect()
}
