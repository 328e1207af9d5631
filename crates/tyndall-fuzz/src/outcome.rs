//! Ends of an input.

/// The end of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// With an error that says what is wrong.
    Refused,
    /// With values, all of them finite.
    Computed,
}
