//! The uploaded scene with its pipelines.

use tyndall::{
    frame::{Camera, Emitter, Frame, ShadowProjection},
    gpu::PassTimer,
};
use wgpu::{CommandEncoder, Device, Queue, TextureFormat, TextureView};

use super::{
    error::GpuSceneError,
    g_buffer::GBufferPipelines,
    glass::GlassPipelines,
    material::has_tinted_glass,
    mesh::DrawClass,
    shade::{ShadePipelines, SurfaceLights},
    shadow_map::ShadowMapPipelines,
    targets::{GBufferTargets, GlassMapTarget, ShadowMapTarget},
    uploaded::UploadedScene,
};
use crate::{scene::Scene, trace::GLASS_LAYERS};

/// A scene on a device, with everything that draws it.
pub struct SceneRenderer {
    scene: UploadedScene,
    has_tinted_glass: bool,
    g_buffer: GBufferPipelines,
    shadow_map: ShadowMapPipelines,
    glass: GlassPipelines,
    shade: ShadePipelines,
}

impl SceneRenderer {
    /// Uploads the scene and builds every pipeline; `target_format` is that of the colour target of [`SceneRenderer::shade`].
    ///
    /// # Errors
    /// [`GpuSceneError`] if a texture or a primitive is beyond the device's limits, or the device cannot blend on the
    /// target's format.
    pub fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        target_format: TextureFormat,
    ) -> Result<Self, GpuSceneError> {
        let uploaded = UploadedScene::new(device, queue, scene)?;
        let layouts = &uploaded.layouts;
        Ok(Self {
            has_tinted_glass: uploaded.meshes.has(DrawClass::Translucent)
                && has_tinted_glass(scene),
            g_buffer: GBufferPipelines::new(device, layouts),
            shadow_map: ShadowMapPipelines::new(device, layouts),
            glass: GlassPipelines::new(device, layouts),
            shade: ShadePipelines::new(device, target_format)?,
            scene: uploaded,
        })
    }

    /// Moves the nodes to where they are in `scene`, which differs from the uploaded one in the nodes' places alone.
    /// Command buffers submitted from now on draw them there.
    pub fn place(&self, queue: &Queue, scene: &Scene) {
        self.scene.meshes.place(queue, scene);
    }

    /// True if light through the scene's glass and blended surfaces changes its colour, so that lights need glass maps.
    pub fn has_tinted_glass(&self) -> bool {
        self.has_tinted_glass
    }

    /// Layers of glass that a light's map needs, 2 to [`GLASS_LAYERS`]: light passes a triangle once, and one layer alone
    /// could not be peeled off another.
    pub fn glass_layers(&self) -> u32 {
        let triangles = self.scene.meshes.triangles(DrawClass::Translucent);
        triangles.clamp(2, GLASS_LAYERS as usize) as u32
    }

    /// Records the G-buffer of `camera`. Its depth is in the camera's convention, its pixels are those of `targets`.
    pub fn g_buffer(
        &self,
        encoder: &mut CommandEncoder,
        targets: &GBufferTargets,
        camera: &Camera,
        timer: Option<&mut PassTimer>,
    ) {
        self.g_buffer
            .record(&self.scene, encoder, targets, camera, timer);
    }

    /// Records the light's shadow map: alpha-tested where surfaces are masked, both sides of all of them.
    ///
    /// # Panics
    /// If `target` was made for another kind of projection.
    pub fn shadow_map(
        &self,
        encoder: &mut CommandEncoder,
        target: &ShadowMapTarget,
        emitter: &Emitter,
        projection: &ShadowProjection,
        timer: Option<&mut PassTimer>,
    ) {
        self.shadow_map
            .record(&self.scene, encoder, target, (emitter, projection), timer);
    }

    /// Records the coloured glass before the first opaque surface, seen from the light;
    /// `shadow_map` was recorded before with the same emitter and projection.
    ///
    /// # Panics
    /// If a target was made for another kind of projection.
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
            &self.scene,
            encoder,
            (target, shadow_map),
            (emitter, projection),
            timer,
        );
    }

    /// Records the radiance of the camera's image [W/(m^2 sr)] on `target`, which has the format given to
    /// [`SceneRenderer::new`] and the size of `g_buffer`, and is cleared first. It is [`crate::shading::shade`] on the GPU:
    /// Lambert surfaces under the frame's lights, or the sky, without the medium between them and the eye.
    ///
    /// `g_buffer` was recorded with the frame's camera.
    pub fn shade(
        &self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        g_buffer: &GBufferTargets,
        frame: &Frame,
        lights: SurfaceLights<'_>,
        timer: Option<&mut PassTimer>,
    ) {
        self.shade.record(
            (&self.scene.device, &self.scene.queue),
            encoder,
            target,
            g_buffer,
            (frame, lights),
            timer,
        );
    }
}
