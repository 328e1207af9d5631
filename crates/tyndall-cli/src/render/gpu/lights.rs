//! Textures and buffers of each light on the GPU.

use std::sync::Arc;

use tyndall::{
    LightInputs, Occluder, PointCloud,
    cpu::LightTexture,
    frame::{Emitter, Light},
};
use tyndall_scene::gpu::{
    GlassMapTarget, SceneRenderer, ShadowMapTarget, upload_light_texture, upload_point_cloud,
};
use wgpu::{Buffer, TextureView};

use crate::{
    backend::Gpu,
    failure::Failure,
    load::{LazyTracer, ShotFrame},
    render::needs::Needs,
};

/// Points of the scene's surfaces that maps of a rectangular light are made of.
const CLOUD: u32 = 1 << 19;

/// Textures and buffers of one light.
pub(super) struct LightTargets {
    pub(super) shadow_map: Option<ShadowMapTarget>,
    pub(super) glass: Option<GlassMapTarget>,
    /// The texture the light shines through, and the texels that were uploaded to it.
    texture: Option<(TextureView, Arc<LightTexture>)>,
    /// Points of the scene's surfaces, and the texels a side of a sample's map; rectangular lights only.
    points: Option<(Buffer, u32)>,
    /// The scene that the points are of.
    drawn: Arc<LazyTracer>,
}

impl LightTargets {
    pub(super) fn new(
        shot_frame: &ShotFrame,
        index: usize,
        gpu: &Gpu,
        renderer: &SceneRenderer,
        needs: Needs,
    ) -> Result<Self, Failure> {
        let device = &gpu.device;
        let (light, extra) = (&shot_frame.frame.lights[index], &shot_frame.lights[index]);
        let projection = light.shadow.as_ref().filter(|_| needs.shadow_maps);
        let shadow_map = projection
            .map(|projection| ShadowMapTarget::new(device, projection, extra.map_size))
            .transpose()
            .map_err(Failure::device)?;
        let glass = shadow_map
            .as_ref()
            .filter(|_| needs.glass && renderer.has_tinted_glass())
            .map(|shadow_map| GlassMapTarget::new(device, shadow_map, renderer.glass_layers()))
            .transpose()
            .map_err(Failure::device)?;
        Ok(Self {
            points: points(shot_frame, index, gpu, needs),
            drawn: Arc::clone(&shot_frame.tracer),
            shadow_map,
            glass,
            texture: texture(shot_frame, index, gpu)?,
        })
    }

    /// Takes new points where the scene has moved, and another texture where there is one.
    pub(super) fn follow(
        &mut self,
        shot_frame: &ShotFrame,
        index: usize,
        gpu: &Gpu,
        needs: Needs,
    ) -> Result<(), Failure> {
        let held = self.texture.as_ref().map(|(_, of)| Arc::as_ptr(of));
        if held != shot_frame.lights[index].texture.as_ref().map(Arc::as_ptr) {
            self.texture = texture(shot_frame, index, gpu)?;
        }
        if !Arc::ptr_eq(&self.drawn, &shot_frame.tracer) {
            self.points = points(shot_frame, index, gpu, needs);
            self.drawn = Arc::clone(&shot_frame.tracer);
        }
        Ok(())
    }

    /// Whether there is a shadow map where the light needs one.
    pub(super) fn suits(&self, light: &Light, needs: Needs) -> bool {
        self.shadow_map.is_some() == (light.shadow.is_some() && needs.shadow_maps)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.shadow_map.as_ref().map_or(0, ShadowMapTarget::bytes)
            + self.glass.as_ref().map_or(0, GlassMapTarget::bytes)
            + self.points.as_ref().map_or(0, |(buffer, _)| buffer.size())
    }
}

/// The texture that the light shines through in this frame, uploaded.
fn texture(
    shot_frame: &ShotFrame,
    index: usize,
    gpu: &Gpu,
) -> Result<Option<(TextureView, Arc<LightTexture>)>, Failure> {
    let Some(texture) = &shot_frame.lights[index].texture else {
        return Ok(None);
    };
    let uploaded = upload_light_texture(&gpu.device, &gpu.queue, texture);
    let view = uploaded
        .map_err(Failure::device)?
        .create_view(&Default::default());
    Ok(Some((view, Arc::clone(texture))))
}

/// Points of the scene's surfaces, where the light is a rectangle and a technique reads them.
fn points(shot_frame: &ShotFrame, index: usize, gpu: &Gpu, needs: Needs) -> Option<(Buffer, u32)> {
    let is_area = matches!(shot_frame.frame.lights[index].emitter, Emitter::Rect { .. });
    let cloud = (is_area && needs.points).then(|| shot_frame.tracer.point_cloud(CLOUD))?;
    let side = shot_frame.lights[index].map_size[0];
    (!cloud.is_empty()).then(|| (upload_point_cloud(&gpu.device, &cloud), side))
}

/// The lights' inputs; `occluders` are the same for all of them.
pub(super) fn light_inputs<'a>(
    lights: &'a [LightTargets],
    occluders: Option<&'a [Occluder<'a>]>,
    revision: u64,
) -> Vec<LightInputs<'a>> {
    lights
        .iter()
        .map(|light| LightInputs {
            shadow_map: light.shadow_map.as_ref().map(ShadowMapTarget::view),
            glass: light.glass.as_ref().map(GlassMapTarget::view),
            texture: light.texture.as_ref().map(|(view, _)| view),
            occluders,
            points: light.points.as_ref().map(|(points, map_side)| PointCloud {
                points,
                map_side: *map_side,
            }),
            shadow_revision: Some(revision),
        })
        .collect()
}
