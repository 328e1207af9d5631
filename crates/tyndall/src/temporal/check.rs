//! Refuses what cannot be kept, before a frame is prepared.

use super::options::{Reuse, ReuseMask};
use crate::{
    error::PrepareError, gpu::limits, passes::occluder::check_list, techniques::LightRequest,
};

/// Refuses what cannot be kept.
pub(crate) fn check(reuse: &Reuse, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        size: [width, height],
        index,
        light,
        inputs,
    } = *request;
    if let Some(tolerance) = reuse.reproject.filter(|t| !(t.is_finite() && *t > 0.0)) {
        return Err(PrepareError::OutOfRange {
            field: "reuse.reproject".to_owned(),
            expected: "a finite number > 0",
            found: tolerance.to_string(),
        });
    }
    if reuse.mask == ReuseMask::Geometry && inputs.occluders.is_none() {
        return Err(PrepareError::Missing {
            field: format!("inputs.lights[{index}].occluders"),
            reason: "the mask is drawn from what moves",
        });
    }
    if reuse.mask == ReuseMask::Geometry {
        // Occluders that moved stand there twice.
        let occluders = inputs.occluders.unwrap_or_default();
        check_list(limits, index, &occluders.repeat(2))?;
    }
    let texels = inputs.shadow_map.map_or(0, |map| {
        let size = map.texture().size();
        u64::from(size.width) * u64::from(size.height) * u64::from(light.faces())
    });
    // The map takes a word a texel, depth and age one a pixel each, pixels found in another camera's image four.
    let pixel = if reuse.reproject.is_some() { 16 } else { 4 };
    let needed = (4 * texels).max(pixel * u64::from(width) * u64::from(height));
    let of = format!("temporal reuse (lights[{index}])");
    limits::check_storage(limits, &of, &[("memory", needed)])
}
