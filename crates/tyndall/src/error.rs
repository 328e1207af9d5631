//! The errors of preparing a frame, with what was expected and what was found.

/// A frame cannot be rendered as it was given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// A value of the frame is out of range.
    #[error("`{field}` must be {expected}, found {found}")]
    OutOfRange {
        /// The field, e.g. `lights[0].emitter.outer`.
        field: String,
        /// The values that it may have.
        expected: &'static str,
        /// The value given.
        found: String,
    },
    /// An input that the frame needs was not given.
    #[error("`{field}` is missing: {reason}")]
    Missing {
        /// The input, e.g. `lights[0].shadow_map`.
        field: String,
        /// Why it is needed.
        reason: &'static str,
    },
    /// An input has another size than it must have.
    #[error("`{field}` must have {expected} values, found {found}")]
    WrongSize {
        /// The input.
        field: String,
        /// Number of values it must have.
        expected: usize,
        /// Number of values it has.
        found: usize,
    },
    /// The technique cannot do what the frame asks.
    #[error("technique `{technique}` cannot do {what}")]
    Unsupported {
        /// The technique.
        technique: &'static str,
        /// The thing it cannot do.
        what: String,
    },
    /// The frame needs more than the device has.
    #[error("{what}: {needed} bytes are more than the device's {name}, {limit}")]
    Limit {
        /// The data that needs them.
        what: String,
        /// Bytes it needs.
        needed: u64,
        /// Bytes there may be.
        limit: u64,
        /// The device's limit, by its name in WebGPU.
        name: &'static str,
    },
}
