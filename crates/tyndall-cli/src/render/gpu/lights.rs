//! What belongs to each light on the GPU.

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
    failure::Failure,
    render::{Gpu, Needs},
    setup::{LazyTracer, Setup},
};

/// Points of the scene's surfaces that maps of a rectangular light are made of.
const CLOUD: u32 = 1 << 19;

/// What belongs to one light.
pub(super) struct LightTargets {
    pub(super) shadow_map: Option<ShadowMapTarget>,
    pub(super) glass: Option<GlassMapTarget>,
    /// The picture the light shines through, and what it is of.
    texture: Option<(TextureView, Arc<LightTexture>)>,
    /// Of a rectangular light: the scene's surfaces, and the texels a side of a sample's map.
    points: Option<(Buffer, u32)>,
    /// The scene that the points are of.
    drawn: Arc<LazyTracer>,
}

impl LightTargets {
    pub(super) fn new(
        setup: &Setup,
        index: usize,
        gpu: &Gpu,
        renderer: &SceneRenderer,
        needs: Needs,
    ) -> Result<Self, Failure> {
        let device = &gpu.device;
        let (light, extra) = (&setup.frame.lights[index], &setup.lights[index]);
        let projection = light.shadow.as_ref().filter(|_| needs.light_maps);
        let shadow_map = projection
            .map(|projection| ShadowMapTarget::new(device, projection, extra.map_size))
            .transpose()
            .map_err(Failure::device)?;
        let glass = shadow_map
            .as_ref()
            .filter(|_| renderer.has_tinted_glass())
            .map(|shadow_map| GlassMapTarget::new(device, shadow_map))
            .transpose()
            .map_err(Failure::device)?;
        Ok(Self {
            points: points(setup, index, gpu, needs),
            drawn: Arc::clone(&setup.tracer),
            shadow_map,
            glass,
            texture: texture(setup, index, gpu)?,
        })
    }

    /// Takes new points where the scene has moved, and another picture where there is one.
    pub(super) fn follow(
        &mut self,
        setup: &Setup,
        index: usize,
        gpu: &Gpu,
        needs: Needs,
    ) -> Result<(), Failure> {
        let held = self.texture.as_ref().map(|(_, of)| Arc::as_ptr(of));
        if held != setup.lights[index].texture.as_ref().map(Arc::as_ptr) {
            self.texture = texture(setup, index, gpu)?;
        }
        if !Arc::ptr_eq(&self.drawn, &setup.tracer) {
            self.points = points(setup, index, gpu, needs);
            self.drawn = Arc::clone(&setup.tracer);
        }
        Ok(())
    }

    /// Whether there is a shadow map where the light needs one.
    pub(super) fn suits(&self, light: &Light, needs: Needs) -> bool {
        self.shadow_map.is_some() == (light.shadow.is_some() && needs.light_maps)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.shadow_map.as_ref().map_or(0, ShadowMapTarget::bytes)
            + self.glass.as_ref().map_or(0, GlassMapTarget::bytes)
            + self.points.as_ref().map_or(0, |(buffer, _)| buffer.size())
    }
}

/// The picture that the light shines through in this frame, uploaded.
fn texture(
    setup: &Setup,
    index: usize,
    gpu: &Gpu,
) -> Result<Option<(TextureView, Arc<LightTexture>)>, Failure> {
    let Some(texture) = &setup.lights[index].texture else {
        return Ok(None);
    };
    let uploaded = upload_light_texture(&gpu.device, &gpu.queue, texture);
    let view = uploaded
        .map_err(Failure::device)?
        .create_view(&Default::default());
    Ok(Some((view, Arc::clone(texture))))
}

/// The scene's surfaces, where the light is a rectangle.
fn points(setup: &Setup, index: usize, gpu: &Gpu, needs: Needs) -> Option<(Buffer, u32)> {
    let is_area = matches!(setup.frame.lights[index].emitter, Emitter::Rect { .. });
    let cloud = (is_area && needs.light_maps).then(|| setup.tracer.point_cloud(CLOUD))?;
    let side = setup.lights[index].map_size[0];
    (!cloud.is_empty()).then(|| (upload_point_cloud(&gpu.device, &cloud), side))
}

/// The lights' pictures; `occluders` are the same for all of them.
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
