//! Ends of an input.

/// How an input ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// With an error that says what is wrong.
    Refused,
    /// With values, all of them finite.
    Computed,
}
