//! The effect in somebody's renderer: created once a device, prepared and recorded once a frame.

use crate::{PrepareError, frame::Frame, gpu::PassTimer};

/// What is fixed for the life of an [`Effect`].
#[derive(Clone, Copy, Debug)]
pub struct EffectOptions {
    /// Format of the colour target that [`Effect::composite`] draws on; must be blendable.
    pub target_format: wgpu::TextureFormat,
    /// Format of [`EffectView::output`].
    pub output: OutputPrecision,
}

/// Format of the in-scattered light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPrecision {
    /// `Rgba16Float`, for pictures.
    Half,
    /// `Rgba32Float`, for measuring.
    Full,
}

/// Why an effect or a view of it could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CreateError {
    /// The picture is empty or larger than the device's textures.
    #[error("a view must be 1 to {limit} pixels a side, found {} x {}", size[0], size[1])]
    Size {
        /// What was asked for [pixels].
        size: [u32; 2],
        /// The device's limit [pixels].
        limit: u32,
    },
}

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
    /// shadow map's convention as the bits of an f32, and its tint as three 10-bit square roots (red lowest).
    pub glass: Option<&'a wgpu::TextureView>,
    /// The light's texture: 2-D, filterable, linear when read.
    pub texture: Option<&'a wgpu::TextureView>,
}

/// The effect's pipelines and tables. Immutable, one a device.
pub struct Effect {}

/// What one camera needs: textures of its size, buffers, bind groups.
pub struct EffectView {}

impl Effect {
    /// Builds every pipeline and table.
    pub fn new(device: &wgpu::Device, options: &EffectOptions) -> Result<Self, CreateError> {
        let _ = (device, options);
        unimplemented!()
    }

    /// Makes the textures of a camera of this size [pixels].
    pub fn create_view(
        &self,
        device: &wgpu::Device,
        size: [u32; 2],
    ) -> Result<EffectView, CreateError> {
        let _ = (device, size);
        unimplemented!()
    }

    /// All that can fail: checks the frame and its inputs and uploads what the passes read.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        view: &mut EffectView,
        inputs: &FrameInputs<'_>,
        frame: &Frame,
    ) -> Result<(), PrepareError> {
        let _ = (device, queue, view, inputs, frame);
        unimplemented!()
    }

    /// Records the passes of the frame that was prepared last.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &mut EffectView,
        timer: Option<&mut PassTimer>,
    ) {
        let _ = (encoder, view, timer);
        unimplemented!()
    }

    /// Draws target * transmittance + in-scatter in the caller's pass, exactly per channel.
    pub fn composite(&self, pass: &mut wgpu::RenderPass<'_>, view: &EffectView) {
        let _ = (pass, view);
        unimplemented!()
    }
}

impl EffectView {
    /// In-scattered radiance [W/(m^2 sr)] in rgb, mean transmittance to the surface in a.
    pub fn output(&self) -> &wgpu::TextureView {
        unimplemented!()
    }

    /// Bytes of the textures and buffers this view holds.
    pub fn bytes(&self) -> u64 {
        unimplemented!()
    }
}
