//! A frame's textures on the GPU, and numbers that come back.

use crate::mesh::Occluder;

/// The caller's pictures of one frame.
#[derive(Clone, Copy)]
pub struct FrameInputs<'a> {
    /// The depth buffer (2-D, one sample, depth aspect), of the view's size, in the camera's convention.
    pub depth: &'a wgpu::TextureView,
    /// One entry a light of the frame, in the same order.
    pub lights: &'a [LightInputs<'a>],
}

/// The caller's pictures of one light.
#[derive(Clone, Copy, Default)]
pub struct LightInputs<'a> {
    /// The shadow map: a depth texture viewed as a 2-D array of 1 layer, or of 6 for a cube.
    pub shadow_map: Option<&'a wgpu::TextureView>,
    /// Coloured glass: an `Rg32Uint` 2-D array, layer `face * layers + layer`; a texel is the layer's depth in the
    /// shadow map's convention as the bits of an f32, and its tint as three 10-bit square roots (red lowest). Layers come
    /// nearest to the light first, empty ones last.
    pub glass: Option<&'a wgpu::TextureView>,
    /// The light's texture: 2-D, filterable, linear when read. Temporal reuse takes its content to stay while the view is
    /// the same.
    pub texture: Option<&'a wgpu::TextureView>,
    /// All that may block this light, as triangles, for techniques that bound shadows by geometry (`hybrid`); `None`: not
    /// known.
    pub occluders: Option<&'a [Occluder<'a>]>,
    /// The surfaces that block a rectangular light; `None`: nothing does.
    pub points: Option<PointCloud<'a>>,
    /// A number that changes whenever the shadow map's content does: what a technique made of the map alone for the
    /// frame before, if that was recorded and submitted, is used again. `None`: the map may change from frame to frame.
    pub shadow_revision: Option<u64>,
}

/// Surfaces as points, of which maps are made for the samples of a rectangular light.
#[derive(Clone, Copy)]
pub struct PointCloud<'a> {
    /// A storage buffer of four floats a point: world-space position and the radius of the disc it stands for [m]. Any
    /// points that follow each other have to be a fair sample of the surfaces: each map takes its own.
    pub points: &'a wgpu::Buffer,
    /// Texels a side of a sample's map (16 to 1024).
    pub map_side: u32,
}

/// What shadows on surfaces are made of besides a frame's inputs.
#[derive(Clone, Debug, Default)]
pub struct SurfaceShadows {
    /// World-space normals of what each pixel sees, unit length in rgb, facing the viewer: 2-D, of floats, of the view's size.
    /// Samples of a light then count by the cosine of their angle to it, and the surface's slope says how far it is kept
    /// from shadowing itself. `None`, or a pixel of zeros: not known; they count as if the surface faced each.
    pub normals: Option<wgpu::TextureView>,
}

/// A number that says what a frame took, beside its time.
#[derive(Clone, Debug)]
pub struct Count {
    /// What it counts, and of which light.
    pub name: String,
    /// Where to find it.
    pub value: CountValue,
}

/// Where a [`Count`] is found.
#[derive(Clone, Debug)]
pub enum CountValue {
    /// Here.
    Known(u64),
    /// On the device, once the frame's passes have run: a u32 in a buffer of usage `COPY_SRC`.
    Written {
        /// The buffer.
        buffer: wgpu::Buffer,
        /// Where the number stands in it [bytes].
        offset: u64,
    },
}
