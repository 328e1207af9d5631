//! A frame's textures on the GPU, and numbers that come back.

use crate::{frame::Light, mesh::Occluder};

/// The caller's textures of one frame.
#[derive(Clone, Copy)]
pub struct FrameInputs<'a> {
    /// The depth buffer (2-D, one sample, depth aspect), of the view's size, in the camera's convention.
    pub depth: &'a wgpu::TextureView,
    /// One entry a light of the frame, in the same order.
    pub lights: &'a [LightInputs<'a>],
}

/// The caller's textures of one light, and the geometry that blocks it.
#[derive(Clone, Copy, Default)]
pub struct LightInputs<'a> {
    /// The shadow map: a depth texture viewed as a 2-D array of 1 layer, or of 6 for a cube.
    pub shadow_map: Option<&'a wgpu::TextureView>,
    /// Coloured glass: an `Rg32Uint` 2-D array, layer `face * layers + layer`; a texel is the layer's depth in the
    /// shadow map's convention as the bits of an f32, and its tint as three 10-bit square roots (red lowest). Layers come
    /// nearest to the light first, empty ones last.
    pub glass: Option<&'a wgpu::TextureView>,
    /// The light's texture: 2-D, filterable, linear when read. Temporal reuse assumes that its content stays while the view
    /// is the same.
    pub texture: Option<&'a wgpu::TextureView>,
    /// All that may block this light, as triangles, for techniques that bound shadows by geometry (`hybrid`); `None`: not
    /// known.
    pub occluders: Option<&'a [Occluder<'a>]>,
    /// The surfaces that block a rectangular light; `None`: nothing does.
    pub points: Option<PointCloud<'a>>,
    /// A number of the shadow map's content. Change it whenever the map's content changes; while it is equal, data derived
    /// from the map is reused, provided that the frame before was recorded and submitted. `None`: nothing is reused, for the
    /// map may change from frame to frame.
    pub shadow_revision: Option<u64>,
}

impl LightInputs<'_> {
    /// Layers of coloured glass a face; 0 where there is none, or the light casts no shadows.
    pub(crate) fn glass_layers(&self, light: &Light) -> u32 {
        let glass = self.glass.filter(|_| light.shadow.is_some());
        glass.map_or(0, |glass| {
            glass.texture().depth_or_array_layers() / light.faces()
        })
    }
}

/// Surfaces as points, of which maps are made for the samples of a rectangular light.
#[derive(Clone, Copy)]
pub struct PointCloud<'a> {
    /// A storage buffer of four floats a point: world-space position and the radius of the disc it stands for \[m]. Any
    /// points that follow each other have to be a fair sample of the surfaces: each map takes its own.
    pub points: &'a wgpu::Buffer,
    /// Texels a side of a sample's map (16 to 1024).
    pub map_side: u32,
}

/// Inputs of shadows on surfaces, besides a frame's.
#[derive(Clone, Debug, Default)]
pub struct SurfaceShadows {
    /// World-space normals of what each pixel sees, unit length in rgb, facing the viewer: 2-D, of floats, of the view's size.
    /// Samples of a light then count by the cosine of their angle to it, and the surface's slope says how far it is kept
    /// from shadowing itself. `None`, or a pixel of zeros: not known; they count as if the surface faced each.
    pub normals: Option<wgpu::TextureView>,
}

/// A number that tells a frame's cost, beside its time.
#[derive(Clone, Debug)]
pub struct Count {
    /// The thing counted, and the light's index.
    pub name: String,
    /// The number, or its place.
    pub value: CountValue,
}

/// A [`Count`]'s number, or its place.
#[derive(Clone, Debug)]
pub enum CountValue {
    /// Here.
    Known(u64),
    /// On the device, once the frame's passes have run: a u32 in a buffer of usage `COPY_SRC`.
    Written {
        /// The buffer.
        buffer: wgpu::Buffer,
        /// The number's offset in it \[bytes].
        offset: u64,
    },
}
