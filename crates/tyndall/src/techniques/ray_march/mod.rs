//! Stub.
/// Parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Samples a ray.
    pub steps: u32,
    /// How they are spaced.
    pub spacing: Spacing,
}
/// How samples are spaced along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Equal steps.
    Equal,
    /// Equal angles at a local light.
    Equiangular,
}
