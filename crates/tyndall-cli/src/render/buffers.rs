//! Depth buffer and light maps in main memory: traced, or read back from a device.

use tyndall::cpu::{GlassMap, ShadowMap};
use tyndall_scene::trace::GLASS_LAYERS;

use super::needs::Needs;
use crate::{load::ShotFrame, progress::Progress};

/// Depth buffer and light maps, from which in-scattered light is computed on the CPU.
pub(crate) struct Buffers {
    /// Depths of the pixels, in the camera's convention.
    pub(crate) depth: Vec<f32>,
    /// One a light.
    pub(crate) lights: Vec<LightMaps>,
}

impl Buffers {
    /// Casts the rays of the camera and of every light.
    pub(crate) fn trace(shot_frame: &ShotFrame, progress: &mut Progress) -> Self {
        Self {
            depth: progress.run("trace depth", |report| depth(shot_frame, report)),
            lights: LightMaps::trace_all(shot_frame, Needs::IN_SCATTER, |_| true, progress),
        }
    }
}

/// The depth buffer, traced by the camera's rays.
pub(crate) fn depth(shot_frame: &ShotFrame, report: tyndall::cpu::Progress<'_>) -> Vec<f32> {
    let g_buffer = shot_frame
        .tracer
        .g_buffer(&shot_frame.frame.camera, shot_frame.size, report);
    g_buffer.depth
}

/// Shadow map and coloured glass of a light; empty where they aren't needed.
#[derive(Default)]
pub(crate) struct LightMaps {
    pub(crate) shadow_map: Option<ShadowMap>,
    pub(crate) glass: Option<GlassMap>,
}

impl LightMaps {
    /// The maps of the lights whose map is read.
    pub(super) fn trace_all(
        shot_frame: &ShotFrame,
        needs: Needs,
        is_read: impl Fn(usize) -> bool,
        progress: &mut Progress,
    ) -> Vec<Self> {
        let lights = 0..shot_frame.lights.len();
        lights
            .map(|index| {
                if needs.shadow_maps && is_read(index) {
                    Self::trace(shot_frame, index, needs, progress)
                } else {
                    Self::default()
                }
            })
            .collect()
    }

    fn trace(shot_frame: &ShotFrame, index: usize, needs: Needs, progress: &mut Progress) -> Self {
        let light = &shot_frame.frame.lights[index];
        let size = shot_frame.lights[index].map_size;
        let Some(projection) = &light.shadow else {
            return Self::default();
        };
        let (tracer, emitter) = (&shot_frame.tracer, &light.emitter);
        let shadow_map = progress.run(&format!("trace shadow map {index}"), |report| {
            tracer.shadow_map(emitter, projection, size, report)
        });
        let glass = (needs.glass && tracer.has_tinted_glass()).then(|| {
            progress.run(&format!("trace glass map {index}"), |report| {
                tracer.glass_map(emitter, projection, size, GLASS_LAYERS, report)
            })
        });
        Self {
            shadow_map: Some(shadow_map),
            glass: glass.flatten(),
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        let depth = self.shadow_map.as_ref().map(|map| map.depth.as_slice());
        let glass = self.glass.as_ref().map(|map| map.texels.as_slice());
        (depth.map_or(0, size_of_val) + glass.map_or(0, size_of_val)) as u64
    }
}
