//! Animations of nodes. All of a file's play together, each from its own time 0; where two move the same property of a
//! node, the later one does. Morph weights stay in their rest pose.

use glam::{DAffine3, Quat, Vec3};
use gltf::{
    Document,
    animation::{Interpolation as Source, Property},
    json::{self, validation::Checked},
};

use super::{
    accessor::{Integers, read_vectors},
    buffers::Buffers,
    error::{Refusal, broken, called},
};
use crate::{
    animation::{Curve, Interpolation, NodeAnimation, Placement},
    scene::Node,
};

/// Reads every animation. `scene_node` has the scene's index of each node of the document that is part of it.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers<'_>,
    scene_node: &[Option<usize>],
    nodes: &[Node],
) -> Result<Vec<NodeAnimation>, Refusal> {
    let mut read: Vec<NodeAnimation> = Vec::new();
    for (animation, source) in document.animations().zip(&document.as_json().animations) {
        let place = called("animation", animation.index(), animation.name());
        for (index, channel) in source.channels.iter().enumerate() {
            let within = |refusal: Refusal| refusal.within(&format!("{place}, channel {index}"));
            let Some((node, property)) = target(channel, scene_node).map_err(within)? else {
                continue;
            };
            // The document's indices are known to be valid.
            let Some(sampler) = animation.samplers().nth(channel.sampler.value()) else {
                continue;
            };
            let at = read.iter().position(|known| known.node == node);
            let at = at.unwrap_or_else(|| {
                read.push(at_rest(node, &nodes[node].parent_from_local));
                read.len() - 1
            });
            read_channel(&mut read[at], property, &sampler, buffers).map_err(within)?;
        }
    }
    Ok(read)
}

/// The scene's node and its property that moves; `None` if the node is not part of the scene. Reads the JSON, because
/// the `gltf` crate takes both on trust.
fn target(
    channel: &json::animation::Channel,
    scene_node: &[Option<usize>],
) -> Result<Option<(usize, Property)>, Refusal> {
    let node = channel.target.node.value();
    let Some(node) = scene_node.get(node) else {
        let count = scene_node.len();
        return Err(broken(
            "target",
            format!("node {node} is out of range for {count} nodes"),
        ));
    };
    match channel.target.path {
        Checked::Valid(property) => Ok(node.map(|node| (node, property))),
        Checked::Invalid => Err(broken(
            "target",
            "path must be translation, rotation, scale or weights, found another word",
        )),
    }
}

fn at_rest(node: usize, parent_from_local: &DAffine3) -> NodeAnimation {
    let (scale, rotation, translation) = parent_from_local.to_scale_rotation_translation();
    NodeAnimation {
        node,
        rest: Placement {
            translation,
            rotation: rotation.as_quat(),
            scale: scale.as_vec3(),
        },
        translation: None,
        rotation: None,
        scale: None,
    }
}

fn read_channel(
    animation: &mut NodeAnimation,
    property: Property,
    sampler: &gltf::animation::Sampler<'_>,
    buffers: &Buffers<'_>,
) -> Result<(), Refusal> {
    match property {
        Property::Translation => {
            animation.translation = Some(curve(sampler, buffers, Vec3::from_array)?);
        }
        Property::Scale => animation.scale = Some(curve(sampler, buffers, Vec3::from_array)?),
        Property::Rotation => {
            let rotation = curve(sampler, buffers, Quat::from_array)?;
            let stride = if rotation.interpolation == Interpolation::Cubic {
                3
            } else {
                1
            };
            let keys = rotation.values.iter().skip(stride / 2).step_by(stride);
            for (key, value) in keys.enumerate() {
                if value.length_squared() < f32::MIN_POSITIVE {
                    return Err(broken("output", format!("rotation {key} must not be zero")));
                }
            }
            animation.rotation = Some(Curve {
                values: match rotation.interpolation {
                    Interpolation::Cubic => rotation.values,
                    _ => rotation.values.iter().map(|q| q.normalize()).collect(),
                },
                ..rotation
            });
        }
        Property::MorphTargetWeights => {}
    }
    Ok(())
}

fn curve<const N: usize, T>(
    sampler: &gltf::animation::Sampler<'_>,
    buffers: &Buffers<'_>,
    make: impl Fn([f32; N]) -> T,
) -> Result<Curve<T>, Refusal> {
    let interpolation = match sampler.interpolation() {
        Source::Step => Interpolation::Step,
        Source::Linear => Interpolation::Linear,
        Source::CubicSpline => Interpolation::Cubic,
    };
    let times: Vec<f32> = read_vectors::<1>(&sampler.input(), buffers, Integers::Refused)?
        .into_iter()
        .map(|[time]| time)
        .collect();
    // Keys at one time are a jump; those of an accessor without a buffer, which is valid, are all at 0.
    let falls = |pair: &&[f32]| {
        pair[0]
            .partial_cmp(&pair[1])
            .is_none_or(|order| order.is_gt())
    };
    if let Some(pair) = times.windows(2).find(falls) {
        return Err(broken(
            "input",
            format!("times must not fall, found {} after {}", pair[1], pair[0]),
        ));
    }
    let values = read_vectors::<N>(&sampler.output(), buffers, Integers::Normalized)?;
    let expected = match interpolation {
        Interpolation::Cubic => 3 * times.len(),
        _ => times.len(),
    };
    if values.len() != expected {
        let (found, keys) = (values.len(), times.len());
        return Err(broken(
            "output",
            format!("must have {expected} elements for {keys} keys, found {found}"),
        ));
    }
    Ok(Curve {
        times,
        values: values.into_iter().map(make).collect(),
        interpolation,
    })
}
