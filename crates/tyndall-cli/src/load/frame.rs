//! One frame of a shot.

use std::sync::{Arc, LazyLock};

use tyndall::{
    cpu::LightTexture,
    frame::Frame,
    techniques::{Backends, Technique, TechniqueChoice},
};
use tyndall_scene::{scene::Scene, shadow_fit, trace::Tracer};

/// One frame of a shot: everything it names is loaded, everything it leaves out filled in. Clones share the scene.
#[derive(Clone)]
pub struct ShotFrame {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The scene, ready to be hit by rays.
    pub tracer: Arc<LazyTracer>,
    /// Camera, lights and medium. Lights have shadow projections wherever maps of them can be made; a sun's may leave out
    /// what this camera does not see.
    pub frame: Frame,
    /// The techniques that compute the lights.
    pub techniques: TechniqueChoice,
    /// Shadow map and texture of each of the frame's lights.
    pub lights: Vec<LightExtras>,
    /// Width and height \[pixels].
    pub size: [u32; 2],
}

impl ShotFrame {
    /// The frame with shadow maps round the whole scene, which suit any camera.
    pub fn with_whole_maps(mut self) -> Self {
        for light in &mut self.frame.lights {
            light.shadow = shadow_fit::fit(self.tracer.geometry(), &light.emitter);
        }
        self
    }

    /// The technique of each light on a backend, [`Backends::Cpu`] or [`Backends::Gpu`].
    pub fn techniques_on(&self, backend: Backends) -> Vec<Technique> {
        let lights = self.frame.lights.iter().enumerate();
        lights
            .map(|(index, light)| self.techniques.of(index, light, backend))
            .collect()
    }
}

/// A tracer that is built when the first ray is cast: frames that the GPU draws cast none, but for a sun's shadow map.
pub type LazyTracer = LazyLock<Tracer, Box<dyn FnOnce() -> Tracer + Send>>;

/// A light's shadow map and texture, which the frame's own light doesn't hold.
#[derive(Clone)]
pub struct LightExtras {
    /// Width and height of a face of its shadow map \[texels].
    pub map_size: [u32; 2],
    /// The texture it shines through; another one where it changes.
    pub texture: Option<Arc<LightTexture>>,
}

/// A tracer that is there already.
pub(crate) fn built(tracer: Tracer) -> LazyTracer {
    let lazy: LazyTracer = LazyLock::new(Box::new(|| tracer));
    LazyLock::force(&lazy);
    lazy
}
