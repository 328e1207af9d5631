//! Refuses what the mesh cannot hold, before a frame is prepared.

use glam::Mat4;

use super::{
    params::{INFO, Params},
    tessellation::Square,
};
use crate::{
    error::PrepareError, frame::ShadowProjection, shader::constant,
    techniques::method::LightRequest,
};

/// The most texels a side: vertices are named by their column and row in bits of this number.
fn max_side() -> u32 {
    1 << (constant("LIGHT_VOLUME_PLACE_BITS") - 1)
}

/// Refuses what the mesh cannot hold.
pub(super) fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        index,
        light,
        inputs,
        ..
    } = *request;
    let refuse = |what: String| {
        Err(PrepareError::Unsupported {
            technique: INFO.name,
            what: format!("{what} (lights[{index}])"),
        })
    };
    if light.texture.is_some() {
        return refuse("light textures".into());
    }
    let (Some(map), Some(projection)) = (inputs.shadow_map, &light.shadow) else {
        return Ok(());
    };
    let size = [map.texture().width(), map.texture().height()];
    let max_side = max_side();
    if size.iter().any(|n| *n > max_side) {
        return refuse(format!(
            "shadow maps of more than {max_side} texels a side, found {size:?}"
        ));
    }
    if let ShadowProjection::Single {
        clip_from_world, ..
    } = *projection
        && Mat4::from_cols_array_2d(&clip_from_world)
            .as_dmat4()
            .determinant()
            == 0.0
    {
        return refuse("a shadow projection without an inverse".into());
    }
    let bytes = Square::of_map(size).splits_bytes(light.faces());
    if params.tolerance > 0.0 && bytes > limits.max_storage_buffer_binding_size {
        return refuse(format!(
            "merging within `max_storage_buffer_binding_size` {}, for the map takes {bytes} bytes",
            limits.max_storage_buffer_binding_size
        ));
    }
    Ok(())
}
