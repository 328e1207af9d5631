//! A light's textures on the CPU.

/// The textures that belong to one light.
#[derive(Clone, Copy, Default)]
pub struct CpuLightInputs<'a> {
    /// The shadow map; needed iff the light has a [`ShadowProjection`](crate::frame::ShadowProjection).
    pub shadow_map: Option<&'a ShadowMap>,
    /// Coloured glass between the light and what it shines on; `None`: no coloured glass.
    pub glass: Option<&'a GlassMap>,
    /// The light's texture; needed iff the light has a [`TexturePlacement`](crate::frame::TexturePlacement).
    pub texture: Option<&'a LightTexture>,
}

/// A shadow map on the CPU: depth in the convention of its [`ShadowProjection`](crate::frame::ShadowProjection).
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowMap {
    /// Width and height of a face \[texels].
    pub size: [u32; 2],
    /// Face by face (1, or 6 for a cube), row by row from the top left.
    pub depth: Vec<f32>,
}

/// Coloured glass seen from the light: some layers, nearest to the light first and empty ones last, on the texels of the
/// shadow map's faces.
///
/// A point is tinted by every layer that lies between it and the light. Clear glass (tint 1) needs no layer.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassMap {
    /// Width and height of a face \[texels].
    pub size: [u32; 2],
    /// Number of layers a face.
    pub layers: u32,
    /// `[face][layer][row][column]`: linear RGB tint and, last, the layer's depth in the shadow map's convention.
    /// A layer with nothing in it has tint 1.
    pub texels: Vec<[f32; 4]>,
}

/// A light's texture on the CPU.
#[derive(Clone, Debug, PartialEq)]
pub struct LightTexture {
    /// Width and height \[texels].
    pub size: [u32; 2],
    /// Linear RGB, row by row from the top left.
    pub texels: Vec<[f32; 3]>,
}
