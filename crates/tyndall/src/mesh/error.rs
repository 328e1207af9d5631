//! The errors of making an occluder mesh.

/// An occluder mesh could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OccluderError {
    /// A position is infinite or not a number.
    #[error("positions[{index}] must be finite, found {found:?}")]
    Position {
        /// Its index in the list.
        index: usize,
        /// The value given.
        found: [f32; 3],
    },
    /// An index is of no position.
    #[error("indices[{index}] must be below {positions}, the number of positions, found {found}")]
    Index {
        /// Its index in the list.
        index: usize,
        /// The number of positions.
        positions: usize,
        /// The value given.
        found: u32,
    },
    /// Indices come three a triangle.
    #[error("indices must be three a triangle, found {found}")]
    Indices {
        /// The number given.
        found: usize,
    },
    /// A buffer would be larger than the device binds.
    #[error(
        "{what} of an occluder mesh: {needed} bytes are more than the device's max_storage_buffer_binding_size, {limit}"
    )]
    Limit {
        /// The buffer's content.
        what: &'static str,
        /// Bytes it needs.
        needed: u64,
        /// The device's limit \[bytes].
        limit: u64,
    },
}
