//! Stub.
/// Parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Largest relative error of a lit segment's integral.
    pub tolerance: f64,
    /// Where visibility comes from.
    pub visibility: Visibility,
}
/// Where the reference takes visibility from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// From the scene's triangles, exactly.
    Traced,
    /// From the shadow map, texel by texel.
    ShadowMap,
}
