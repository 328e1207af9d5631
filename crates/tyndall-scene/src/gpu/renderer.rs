//! The uploaded scene with its pipelines.

use tyndall::{
    frame::{Camera, Emitter, ShadowProjection},
    gpu::PassTimer,
};
use wgpu::{CommandEncoder, Device, Queue, TextureFormat};

use super::{
    error::GpuSceneError,
    g_buffer::GBufferPipelines,
    glass::GlassPipelines,
    material::{Materials, has_tinted_glass},
    mesh::{DrawClass, Meshes},
    pipeline::Layouts,
    shadow_map::ShadowMapPipelines,
    targets::{GBufferTargets, GlassMapTarget, ShadowMapTarget},
};
use crate::scene::Scene;

/// A scene on a device, with everything that draws it.
pub struct SceneRenderer {
    device: Device,
    meshes: Meshes,
    materials: Materials,
    has_tinted_glass: bool,
    layouts: Layouts,
    g_buffer: GBufferPipelines,
    shadow_map: ShadowMapPipelines,
    glass: GlassPipelines,
}

impl SceneRenderer {
    /// Uploads the scene and builds every pipeline; `target_format` is that of the colour target of [`SceneRenderer::shade`].
    ///
    /// # Errors
    /// Where a texture or a primitive is larger than the device's limits, or the device cannot blend on the target's format.
    pub fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        target_format: TextureFormat,
    ) -> Result<Self, GpuSceneError> {
        let layouts = Layouts::new(device);
        Ok(Self {
            meshes: Meshes::new(device, scene)?,
            materials: Materials::new(device, queue, scene, &layouts.material)?,
            has_tinted_glass: has_tinted_glass(scene),
            g_buffer: GBufferPipelines::new(device, &layouts),
            shadow_map: ShadowMapPipelines::new(device, &layouts),
            glass: GlassPipelines::new(device, &layouts),
            layouts,
            device: device.clone(),
        })
    }

    /// Moves the nodes to where they are in `scene`, which differs from the uploaded one in the nodes' places alone.
    /// Holds for what is submitted from now on.
    pub fn place(&self, queue: &Queue, scene: &Scene) {
        self.meshes.place(queue, scene);
    }

    /// Whether light through the scene's glass and blended surfaces changes its colour, so that lights need glass maps.
    pub fn has_tinted_glass(&self) -> bool {
        self.has_tinted_glass && self.meshes.has(DrawClass::Translucent)
    }

    /// Records what `camera` sees. Its depth is in the camera's convention, its pixels are those of `targets`.
    pub fn g_buffer(
        &self,
        encoder: &mut CommandEncoder,
        targets: &GBufferTargets,
        camera: &Camera,
        timer: Option<&mut PassTimer>,
    ) {
        self.g_buffer.record(
            &self.device,
            encoder,
            &self.layouts,
            (&self.meshes, &self.materials),
            targets,
            camera,
            timer,
        );
    }

    /// Records the light's shadow map: alpha-tested where surfaces are masked, both sides of all of them, without bias.
    ///
    /// # Panics
    /// Where `target` was made for another kind of projection.
    pub fn shadow_map(
        &self,
        encoder: &mut CommandEncoder,
        target: &ShadowMapTarget,
        emitter: &Emitter,
        projection: &ShadowProjection,
        timer: Option<&mut PassTimer>,
    ) {
        self.shadow_map.record(
            &self.device,
            encoder,
            &self.layouts,
            (&self.meshes, &self.materials),
            target,
            (emitter, projection),
            timer,
        );
    }

    /// Records the coloured glass before the first opaque surface, seen from the light;
    /// `shadow_map` was recorded before with the same emitter and projection.
    ///
    /// # Panics
    /// Where a target was made for another kind of projection.
    pub fn glass_map(
        &self,
        encoder: &mut CommandEncoder,
        target: &GlassMapTarget,
        shadow_map: &ShadowMapTarget,
        emitter: &Emitter,
        projection: &ShadowProjection,
        timer: Option<&mut PassTimer>,
    ) {
        self.glass.record(
            &self.device,
            encoder,
            &self.layouts,
            (&self.meshes, &self.materials),
            (target, shadow_map),
            (emitter, projection),
            timer,
        );
    }
}
