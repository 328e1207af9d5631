//! A shot that is loaded, and its frames.

use std::sync::{Arc, LazyLock};

use glam::{DVec3, Vec3};
use tyndall::{
    cpu::LightTexture,
    frame::{Camera, Emitter, Frame, Light, Medium, ShadowProjection},
    techniques::{Technique, TechniqueChoice},
};
use tyndall_scene::{
    framing::{self, Framing},
    geometry::Bounds,
    scene::Scene,
    shadow_fit::{self, Seen},
    trace::Tracer,
};

use super::{
    frame::{LazyTracer, LightExtras, ShotFrame, built},
    motion::Motion,
    origin::place_origin,
    scene::{at_scene, load_scene},
    textures::ShotTextures,
};
use crate::{
    failure::Failure,
    progress::Progress,
    shot::{CameraBase, FrameRange, LightSpec, SceneCameras, Shot, ShotError},
};

/// A shot with everything it names loaded. Its frames share the scene.
pub struct LoadedShot {
    shot: Shot,
    /// The scene at rest, and its tracer.
    scene: Arc<Scene>,
    tracer: Arc<LazyTracer>,
    framing: Option<Framing>,
    /// One entry a light.
    textures: Vec<Option<ShotTextures>>,
    /// `None` where everything stays at rest.
    motion: Option<Motion>,
}

/// Camera, lights and medium of a frame, as the shot says them.
struct Parts {
    camera: Camera,
    lights: Vec<LightSpec>,
    medium: Medium,
}

impl LoadedShot {
    /// Loads a shot whose frames differ in the lights' textures alone: everything stays at rest.
    ///
    /// # Errors
    /// [`Failure::Input`] where the scene or a texture can't be loaded, or the shot doesn't fit the scene.
    pub fn at_rest(shot: &Shot, progress: &mut Progress) -> Result<Self, Failure> {
        let mut scene = progress
            .run(&format!("load {}", shot.scene), |_| load_scene(&shot.scene))
            .map_err(|failure| at_scene(shot, failure))?;
        place_origin(shot, &mut scene);
        let tracer = progress.run("build BVH", |_| built(Tracer::new(&scene)));
        let framing = needs_framing(shot).then(|| {
            progress.run("frame", |_| {
                framing::frame_scene(&scene, &tracer, aspect(shot))
            })
        });
        let lights = lights(shot, framing.as_ref(), scene.origin).map_err(Failure::input)?;
        Ok(Self {
            shot: shot.clone(),
            scene: Arc::new(scene),
            tracer: Arc::new(tracer),
            framing,
            textures: lights
                .iter()
                .map(ShotTextures::open)
                .collect::<Result<_, _>>()?,
            motion: None,
        })
    }

    /// Loads a shot whose frames show what moves. Keyframes are spread over the shot's own range of frames, or over
    /// `rendered`.
    ///
    /// # Errors
    /// As for [`LoadedShot::at_rest`], and where the shot moves what isn't there.
    pub fn moving(
        shot: &Shot,
        rendered: FrameRange,
        progress: &mut Progress,
    ) -> Result<Self, Failure> {
        let mut loaded = Self::at_rest(shot, progress)?;
        let animation = shot.animation.clone().unwrap_or_default();
        let range = animation.frames.unwrap_or(rendered);
        // A texture that is missing is said before a move of what isn't there.
        loaded.textures_at(range.first)?;
        let lights = loaded.parts(&loaded.scene).map_err(Failure::input)?.lights;
        let motion = Motion::new(animation, range, &loaded.scene, &lights);
        loaded.motion = Some(motion.map_err(Failure::input)?);
        Ok(loaded)
    }

    /// The frames that keyframes are spread over; frame 0 where everything stays at rest.
    pub fn range(&self) -> FrameRange {
        let still = FrameRange { first: 0, last: 0 };
        self.motion.as_ref().map_or(still, Motion::range)
    }

    /// Everything as it is in this frame. It depends on its number alone, so that any frame can be rendered anywhere; but
    /// where the shot doesn't say over which frames its keyframes are spread, it depends on the range that is rendered, too.
    ///
    /// # Errors
    /// [`Failure::Input`] where a light's texture of this frame cannot be read.
    pub fn frame(&mut self, number: u32) -> Result<ShotFrame, Failure> {
        let scene = match &mut self.motion {
            None => Arc::clone(&self.scene),
            Some(motion) => motion.pose(&self.scene, number),
        };
        let textures = self.textures_at(number)?;
        let mut parts = self.parts(&scene).map_err(Failure::input)?;
        if let Some(motion) = &self.motion {
            motion.place(
                number,
                &mut parts.camera,
                &mut parts.lights,
                &mut parts.medium,
            );
        }
        let tracer = self.tracer_of(&scene);
        let lights = parts.lights.iter().map(|spec| Light {
            emitter: spec.emitter,
            shadow: self.shadow(&spec.emitter, &parts, &tracer),
            texture: spec.texture.as_ref().map(|texture| texture.placement),
        });
        let lights = lights.collect();
        let extras = parts.lights.iter().zip(textures);
        Ok(ShotFrame {
            lights: extras
                .map(|(light, texture)| LightExtras {
                    map_size: [light.shadow_map; 2],
                    texture,
                })
                .collect(),
            frame: Frame {
                camera: parts.camera,
                lights,
                medium: parts.medium,
            },
            techniques: techniques(self.shot.technique.clone(), &parts.lights),
            tracer,
            scene,
            size: self.shot.size,
        })
    }

    /// The projection of a light's shadow map: round the scene in all frames, or round what is seen in this one, which
    /// alone needs the tracer.
    fn shadow(
        &self,
        emitter: &Emitter,
        parts: &Parts,
        tracer: &LazyTracer,
    ) -> Option<ShadowProjection> {
        let extent = self.motion.as_ref().map(Motion::extent);
        let extent = extent.unwrap_or_else(|| self.tracer.geometry());
        if !matches!(emitter, Emitter::Directional { .. }) {
            return shadow_fit::fit(extent, emitter);
        }
        let seen = Seen {
            tracer,
            camera: &parts.camera,
            medium: &parts.medium,
            size: self.shot.size,
        };
        shadow_fit::fit_seen(extent, emitter, &seen)
    }

    /// The tracer of a scene whose nodes may have moved.
    fn tracer_of(&self, scene: &Arc<Scene>) -> Arc<LazyTracer> {
        if self.motion.is_none() || is_still(scene, &self.scene) {
            return Arc::clone(&self.tracer);
        }
        let scene = Arc::clone(scene);
        let lazy: LazyTracer = LazyLock::new(Box::new(move || Tracer::new(&scene)));
        Arc::new(lazy)
    }

    fn textures_at(&self, frame: u32) -> Result<Vec<Option<Arc<LightTexture>>>, Failure> {
        let textures = self.textures.iter();
        textures
            .map(|textures| textures.as_ref().map(|t| t.at(frame)).transpose())
            .collect()
    }

    /// Camera, lights and medium; those that the scene gives are where its nodes are now.
    fn parts(&self, scene: &Scene) -> Result<Parts, ShotError> {
        let (shot, aspect) = (&self.shot, aspect(&self.shot));
        let cameras = framing::cameras(scene, aspect);
        let framing = self.framing.as_ref();
        let framing = framing.map(|framing| current(framing, scene, &cameras));
        let bounds = self.tracer.geometry().bounds();
        let cameras = SceneCameras {
            named: &cameras,
            framed: framing.as_ref().map(|framing| framing.camera),
            origin: scene.origin,
            farthest: &|eye| bounds.map_or(0.0, |bounds| farthest(&bounds, eye.into())),
        };
        Ok(Parts {
            camera: shot.camera.resolve(&cameras, aspect)?,
            lights: lights(shot, framing.as_ref(), scene.origin)?,
            medium: medium(shot, framing.as_ref())?,
        })
    }
}

/// The framing of a scene with its own camera and lights, where it has any, as they are now.
fn current(framing: &Framing, scene: &Scene, cameras: &[(String, Camera)]) -> Framing {
    let lights: Vec<Emitter> = framing::lights(scene)
        .into_iter()
        .map(|(_, light)| light)
        .collect();
    Framing {
        camera: cameras
            .first()
            .map_or(framing.camera, |(_, camera)| *camera),
        lights: if lights.is_empty() {
            framing.lights.clone()
        } else {
            lights
        },
        medium: framing.medium.clone(),
    }
}

/// The shot's technique, and the lights' own.
fn techniques(all: Option<Technique>, lights: &[LightSpec]) -> TechniqueChoice {
    let mut lights: Vec<_> = lights.iter().map(|light| light.technique.clone()).collect();
    // A list without any leaves whoever changes the lights free to remove some.
    let own = lights.iter().rposition(Option::is_some);
    lights.truncate(own.map_or(0, |last| last + 1));
    TechniqueChoice { all, lights }
}

fn aspect(shot: &Shot) -> f32 {
    shot.size[0] as f32 / shot.size[1] as f32
}

fn needs_framing(shot: &Shot) -> bool {
    shot.camera.base == CameraBase::Scene || shot.lights.is_none() || shot.medium.is_none()
}

/// The lights, relative to `origin`.
fn lights(
    shot: &Shot,
    framing: Option<&Framing>,
    origin: DVec3,
) -> Result<Vec<LightSpec>, ShotError> {
    let lights = match (&shot.lights, framing) {
        (Some(lights), _) => lights.clone(),
        (None, Some(framing)) => shot.scene_lights(&framing.lights, origin)?,
        (None, None) => Vec::new(),
    };
    let lights = lights.into_iter();
    Ok(lights.map(|light| light.relative_to(origin)).collect())
}

fn medium(shot: &Shot, framing: Option<&Framing>) -> Result<Medium, ShotError> {
    match (&shot.medium, framing) {
        (Some(medium), _) => Ok(medium.clone()),
        (None, Some(framing)) => shot.scene_medium(&framing.medium),
        (None, None) => Ok(Medium {
            components: Vec::new(),
        }),
    }
}

fn farthest(bounds: &Bounds, eye: Vec3) -> f32 {
    (bounds.min - eye)
        .abs()
        .max((bounds.max - eye).abs())
        .length()
}

fn is_still(scene: &Scene, rest: &Scene) -> bool {
    let nodes = scene.nodes.iter().map(|node| node.parent_from_local);
    nodes.eq(rest.nodes.iter().map(|node| node.parent_from_local))
}
