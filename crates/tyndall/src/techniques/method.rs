//! What a technique does: one trait for all, and one for each side, implemented in the technique's folder.

use crate::{
    error::PrepareError,
    frame::Camera,
    integrate::{CpuScene, RayIntegrator},
};
#[cfg(feature = "gpu")]
use crate::{
    frame::Light,
    gpu::{pass::LightPasses, scope::LightScope},
    inputs::LightInputs,
    techniques::info::Reach,
};

/// A technique, by its parameters. It has the sides that the table says it runs on.
pub(crate) trait Method {
    /// Refuses cameras that these parameters cannot do, on any backend.
    fn check(&self, _camera: &Camera) -> Result<(), PrepareError> {
        Ok(())
    }

    /// Its work on the CPU.
    fn cpu(&self) -> Option<&dyn CpuMethod> {
        None
    }

    /// Its work on the GPU.
    #[cfg(feature = "gpu")]
    fn gpu(&self) -> Option<&dyn GpuMethod> {
        None
    }
}

/// A technique's work on the CPU.
pub(crate) trait CpuMethod {
    /// Creates what integrates single rays through a scene; work that rays share is done here.
    ///
    /// # Errors
    /// Where the technique cannot do one of the scene's lights.
    fn integrator<'a>(
        &'a self,
        scene: &'a CpuScene<'a>,
    ) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError>;
}

/// A light that is about to be prepared, and the device's limits, before anything is made.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy)]
pub(crate) struct LightRequest<'a> {
    pub(crate) limits: &'a wgpu::Limits,
    /// Width and height of the view \[pixels].
    pub(crate) size: [u32; 2],
    /// The light's index in the frame.
    pub(crate) index: usize,
    pub(crate) light: &'a Light,
    pub(crate) inputs: &'a LightInputs<'a>,
}

/// A technique's work on the GPU.
#[cfg(feature = "gpu")]
pub(crate) trait GpuMethod {
    /// Refuses lights whose buffers and textures the device cannot hold.
    ///
    /// # Errors
    /// [`PrepareError::Limit`] or [`PrepareError::Unsupported`].
    fn check_light(&self, _request: &LightRequest<'_>) -> Result<(), PrepareError> {
        Ok(())
    }

    /// Says how far from its own ray a pixel's last pass looks.
    fn reach(&self) -> Reach {
        Reach::Image
    }

    /// Creates the passes of one light.
    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses;
}
