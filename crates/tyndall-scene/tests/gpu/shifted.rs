//! Traces maps with the centres of texels shifted.

use glam::{DMat4, DVec3};
use tyndall::{
    cpu::{GlassMap, ShadowMap},
    frame::{Emitter, ShadowProjection},
    shadow,
};
use tyndall_scene::trace::{GLASS_LAYERS, Tracer};

/// The projections of a map's faces, one by one, their texels' centres shifted.
fn shifted_faces(
    emitter: &Emitter,
    projection: &ShadowProjection,
    size: [u32; 2],
    shift: [f64; 2],
) -> Vec<ShadowProjection> {
    let (ShadowProjection::Single { reversed_depth, .. }
    | ShadowProjection::Cube { reversed_depth, .. }) = *projection;
    let [x, y] = [0, 1].map(|axis| 2.0 * shift[axis] / f64::from(size[axis]));
    let shift = DMat4::from_translation(DVec3::new(x, y, 0.0));
    let unreverse =
        DMat4::from_translation(DVec3::Z) * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let turn = if reversed_depth {
        shift
    } else {
        shift * unreverse
    };
    shadow::faces(emitter, projection)
        .unwrap()
        .iter()
        .map(|face| ShadowProjection::Single {
            clip_from_world: (turn * face.clip_from_world).as_mat4().to_cols_array_2d(),
            reversed_depth,
        })
        .collect()
}

/// A light's traced shadow map.
pub(crate) fn shifted_map(
    tracer: &Tracer,
    emitter: &Emitter,
    projection: &ShadowProjection,
    size: [u32; 2],
    shift: [f64; 2],
) -> ShadowMap {
    let faces = shifted_faces(emitter, projection, size, shift);
    let maps = faces
        .iter()
        .map(|face| tracer.shadow_map(emitter, face, size, &|_, _| ()));
    ShadowMap {
        size,
        depth: maps.flat_map(|map| map.depth).collect(),
    }
}

/// A light's traced coloured glass, where there is any, in as many layers as a renderer may have.
pub(crate) fn shifted_glass(
    tracer: &Tracer,
    emitter: &Emitter,
    projection: &ShadowProjection,
    size: [u32; 2],
    shift: [f64; 2],
) -> Option<GlassMap> {
    let (ShadowProjection::Single { reversed_depth, .. }
    | ShadowProjection::Cube { reversed_depth, .. }) = *projection;
    let empty = [1.0, 1.0, 1.0, if reversed_depth { 0.0 } else { 1.0 }];
    let count = (GLASS_LAYERS * size[0] * size[1]) as usize;
    let mut texels = Vec::new();
    for face in shifted_faces(emitter, projection, size, shift) {
        let map = tracer.glass_map(emitter, &face, size, GLASS_LAYERS, &|_, _| ())?;
        let missing = count - map.texels.len();
        texels.extend(map.texels);
        texels.extend(std::iter::repeat_n(empty, missing));
    }
    Some(GlassMap {
        size,
        layers: GLASS_LAYERS,
        texels,
    })
}
