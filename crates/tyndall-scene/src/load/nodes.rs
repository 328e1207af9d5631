//! The hierarchy: places, cameras and lights.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4, Vec3};
use gltf::{Document, json, khr_lights_punctual::Kind, scene::Transform};
use tyndall::frame::{Emitter, Projection};

use super::{
    error::{Refusal, broken, called},
    places::FilePlace,
};
use crate::{
    geometry::world_from_nodes,
    scene::{Node, Scene},
};

/// Width / height of cameras that leave it out.
const DEFAULT_ASPECT: f32 = 4.0 / 3.0;

/// Least far / near of cameras without a far plane.
const MIN_DEPTH_RATIO: f32 = 1000.0;

/// Reads the nodes of the default scene, parents first, and the scene's index of each node of the document, where it has
/// one; `places` has the document's nodes' places in double precision, `mesh_index` gives the scene's index of a mesh.
/// Cameras without a far plane have an infinite one until [`bound_cameras`].
pub(super) fn read(
    document: &Document,
    places: &[FilePlace],
    mut mesh_index: impl FnMut(&gltf::Mesh<'_>) -> Result<usize, Refusal>,
) -> Result<(Vec<Node>, Vec<Option<usize>>), Refusal> {
    let mut nodes = Vec::new();
    let mut scene_node = vec![None; document.nodes().len()];
    let mut pending: Vec<(Option<usize>, gltf::Node<'_>)> = roots(document)
        .into_iter()
        .map(|root| (None, root))
        .collect();
    while let Some((parent, source)) = pending.pop() {
        let place = called("node", source.index(), source.name());
        if scene_node[source.index()].replace(nodes.len()).is_some() {
            return Err(broken(
                place,
                "must have one parent, found a second one or a cycle",
            ));
        }
        let precise = places.get(source.index()).copied().unwrap_or_default();
        let node = read_node(&source, precise, parent, document)
            .map_err(|refusal| refusal.within(&place))?;
        let mesh = source.mesh().map(|mesh| mesh_index(&mesh)).transpose()?;
        nodes.push(Node { mesh, ..node });
        let index = nodes.len() - 1;
        pending.extend(source.children().map(|child| (Some(index), child)));
    }
    Ok((nodes, scene_node))
}

fn roots(document: &Document) -> Vec<gltf::Node<'_>> {
    if let Some(scene) = document
        .default_scene()
        .or_else(|| document.scenes().next())
    {
        return scene.nodes().collect();
    }
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children()) {
        is_child[child.index()] = true;
    }
    document
        .nodes()
        .filter(|node| !is_child[node.index()])
        .collect()
}

/// Everything but the node's mesh.
fn read_node(
    source: &gltf::Node<'_>,
    place: FilePlace,
    parent: Option<usize>,
    document: &Document,
) -> Result<Node, Refusal> {
    let camera = document.as_json().nodes[source.index()]
        .camera
        .map(|index| read_camera(&document.as_json().cameras[index.value()], index.value()))
        .transpose()?;
    Ok(Node {
        name: source.name().unwrap_or_default().to_owned(),
        parent,
        parent_from_local: read_transform(source.transform(), place)?,
        mesh: None,
        camera,
        light: source.light().map(|light| read_light(&light)).transpose()?,
    })
}

fn read_transform(transform: Transform, place: FilePlace) -> Result<DAffine3, Refusal> {
    let refuse = |field: &str, expected: &str, found: &dyn std::fmt::Debug| {
        broken(field, format!("must be {expected}, found {found:?}"))
    };
    match transform {
        Transform::Matrix { matrix } => {
            let rounded = DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)));
            let columns = place
                .matrix
                .map_or(rounded, |matrix| DMat4::from_cols_array(&matrix));
            if !rounded.is_finite() || columns.row(3) != DVec4::W {
                return Err(refuse(
                    "matrix",
                    "finite with a last row of 0 0 0 1",
                    &matrix,
                ));
            }
            Ok(DAffine3::from_mat4(columns))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let rotation = DQuat::from_array(rotation.map(f64::from));
            if !rotation.is_finite() || rotation.length_squared() < f32::MIN_POSITIVE.into() {
                return Err(refuse("rotation", "finite and not zero", &rotation));
            }
            let (rounded, scale) = (Vec3::from(translation), Vec3::from(scale));
            if !rounded.is_finite() || !scale.is_finite() {
                return Err(refuse("translation and scale", "finite", &(rounded, scale)));
            }
            Ok(DAffine3::from_scale_rotation_translation(
                scale.as_dvec3(),
                rotation.normalize(),
                place.translation.map_or(rounded.as_dvec3(), DVec3::from),
            ))
        }
    }
}

/// Reads the JSON, because the `gltf` crate's camera panics where type and values do not go together.
fn read_camera(camera: &json::Camera, index: usize) -> Result<Projection, Refusal> {
    use json::{camera::Type, validation::Checked};
    let place = called("camera", index, camera.name.as_deref());
    let refuse = |problem: String| Err(broken(&place, problem));
    match (&camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(Type::Perspective), Some(lens), _) => {
            let aspect = lens.aspect_ratio.unwrap_or(DEFAULT_ASPECT);
            let far = lens.zfar.unwrap_or(f32::INFINITY);
            let in_range = lens.yfov > 0.0
                && lens.yfov < PI
                && aspect > 0.0
                && aspect.is_finite()
                && lens.znear > 0.0
                && lens.znear < far;
            if !in_range {
                return refuse(format!(
                    "must have yfov in (0, pi), a positive aspectRatio and 0 < znear < zfar, found {}, {aspect}, {} and {far}",
                    lens.yfov, lens.znear
                ));
            }
            let tangent = (0.5 * lens.yfov).tan();
            Ok(Projection::Perspective {
                half_extent: [tangent * aspect, tangent],
                center: [0.0; 2],
                near: lens.znear,
                far,
            })
        }
        (Checked::Valid(Type::Orthographic), _, Some(lens)) => {
            let half_extent = [lens.xmag.abs(), lens.ymag.abs()];
            let in_range = half_extent.iter().all(|&x| x > 0.0 && x.is_finite())
                && lens.znear >= 0.0
                && lens.znear < lens.zfar
                && lens.zfar.is_finite();
            if !in_range {
                return refuse(format!(
                    "must have xmag and ymag other than 0 and 0 <= znear < zfar, found {half_extent:?}, {} and {}",
                    lens.znear, lens.zfar
                ));
            }
            Ok(Projection::Orthographic {
                half_extent,
                center: [0.0; 2],
                near: lens.znear,
                far: lens.zfar,
            })
        }
        _ => refuse("has no values for its type".to_owned()),
    }
}

fn read_light(light: &gltf::khr_lights_punctual::Light<'_>) -> Result<Emitter, Refusal> {
    let place = || called("light", light.index(), light.name());
    let strength = light.color().map(|channel| channel * light.intensity());
    if !strength.iter().all(|&x| x.is_finite() && x >= 0.0) {
        return Err(broken(
            place(),
            format!("color * intensity must be finite and at least 0, found {strength:?}"),
        ));
    }
    let (position, direction) = ([0.0; 3], [0.0, 0.0, -1.0]);
    Ok(match light.kind() {
        Kind::Directional => Emitter::Directional {
            direction,
            illuminance: strength,
        },
        Kind::Point => Emitter::Point {
            position,
            intensity: strength,
            radius: 0.0,
        },
        Kind::Spot {
            inner_cone_angle: inner,
            outer_cone_angle: outer,
        } => {
            if !(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= FRAC_PI_2) {
                return Err(broken(
                    place(),
                    format!(
                        "must have 0 <= innerConeAngle <= outerConeAngle <= pi/2, found {inner} and {outer}"
                    ),
                ));
            }
            Emitter::Spot {
                position,
                direction,
                intensity: strength,
                inner,
                outer,
                radius: 0.0,
            }
        }
    })
}

/// Gives cameras without a far plane one behind everything there is.
pub(super) fn bound_cameras(scene: &mut Scene) {
    let world_from_node = world_from_nodes(scene);
    let points: Vec<Vec3> = scene
        .nodes
        .iter()
        .zip(&world_from_node)
        .filter_map(|(node, transform)| Some((&scene.meshes[node.mesh?], transform)))
        .flat_map(|(mesh, transform)| {
            mesh.primitives
                .iter()
                .flat_map(|primitive| &primitive.positions)
                .map(|&position| transform.transform_point3(position))
        })
        .collect();
    for (node, transform) in scene.nodes.iter_mut().zip(&world_from_node) {
        if let Some(Projection::Perspective { near, far, .. }) = &mut node.camera
            && far.is_infinite()
        {
            let eye = Vec3::from(transform.translation);
            let farthest = points.iter().map(|point| point.distance(eye));
            *far = farthest.fold(MIN_DEPTH_RATIO * *near, f32::max);
        }
    }
}
