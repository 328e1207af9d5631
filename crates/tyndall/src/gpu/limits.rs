//! Refusing what the device cannot bind, before anything is made.

use crate::error::PrepareError;

/// Refuses storage buffers larger than the device binds, given by content and bytes. `of` names their owner.
pub(crate) fn check_storage(
    limits: &wgpu::Limits,
    of: &str,
    buffers: &[(&str, u64)],
) -> Result<(), PrepareError> {
    let limit = limits.max_storage_buffer_binding_size;
    let too_large = buffers.iter().find(|(_, needed)| *needed > limit);
    too_large.map_or(Ok(()), |(what, needed)| {
        Err(PrepareError::Limit {
            what: format!("{what} of {of}"),
            needed: *needed,
            limit,
            name: "max_storage_buffer_binding_size",
        })
    })
}
