//! The view of one camera, kept from frame to frame.

use crate::{
    gpu::{pass::Pass, pool::Pool},
    inputs::{Count, SurfaceShadows},
    temporal::{History, Reuse},
};

/// The view of one camera: textures of its size, buffers, and the frame that was prepared last.
pub struct EffectView {
    pub(super) size: [u32; 2],
    pub(super) pool: Pool,
    pub(super) passes: Vec<Pass>,
    pub(super) counts: Vec<Count>,
    pub(super) reuse: Option<Reuse>,
    pub(super) history: History,
    pub(super) surface_shadows: Option<SurfaceShadows>,
    /// One entry a light of the frame prepared last.
    pub(super) visibilities: Vec<Option<wgpu::TextureView>>,
    /// True once the frame prepared last was recorded.
    pub(super) is_recorded: bool,
    pub(super) output: wgpu::TextureView,
    pub(super) composite: Option<wgpu::BindGroup>,
}

impl EffectView {
    pub(super) fn new(size: [u32; 2], pool: Pool, output: wgpu::TextureView) -> Self {
        Self {
            size,
            pool,
            passes: Vec::new(),
            counts: Vec::new(),
            reuse: None,
            history: History::default(),
            surface_shadows: None,
            visibilities: Vec::new(),
            is_recorded: false,
            output,
            composite: None,
        }
    }

    /// In-scattered radiance [W/(m^2 sr)] in rgb, mean transmittance to the surface in a; of the frame recorded last.
    /// The view may be another one after `prepare` with another number of lights.
    pub fn output(&self) -> &wgpu::TextureView {
        &self.output
    }

    /// Sets what is kept of earlier frames from now on; `None`, as at first: nothing.
    pub fn set_reuse(&mut self, reuse: Option<Reuse>) {
        self.reuse = reuse;
    }

    /// Asks for shadows of rectangular lights on surfaces, from the next frame prepared on; `None`, as at first: nobody wants
    /// them, and they cost nothing.
    pub fn set_surface_shadows(&mut self, shadows: Option<SurfaceShadows>) {
        self.surface_shadows = shadows;
    }

    /// Visibility of a light (by its index in the frame) from the surface that each pixel sees, of the frame recorded last:
    /// `Rgba16Float`, of the view's size, 0 to 1 in each of rgb, 1 in a; 1 where no light would arrive. It is the mean over
    /// the light's samples, weighted by what each would send there: its share of the light's texture, the emitter's cosine,
    /// 1 / d^2, extinction in between, and the surface's cosine where [`SurfaceShadows::normals`] are given. The irradiance
    /// of a shadowed surface is that of the unshadowed one, times this. Pixels without a surface hold the visibility from
    /// the end of their ray on the far plane.
    ///
    /// `None` where [`EffectView::set_surface_shadows`] did not ask for it, where there is no such light, and with any
    /// technique but `ivsv`, whose voxels it is read from. The view may be another one after each `prepare`.
    pub fn surface_light_visibility(&self, light: usize) -> Option<&wgpu::TextureView> {
        self.visibilities.get(light)?.as_ref()
    }

    /// The passes of the frame prepared last.
    #[cfg(test)]
    pub(crate) fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// Width and height \[pixels].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The counts of the frame prepared last, light by light.
    pub fn counts(&self) -> &[Count] {
        &self.counts
    }

    /// Bytes of the textures and buffers this view holds.
    pub fn bytes(&self) -> u64 {
        self.pool.bytes()
    }
}
