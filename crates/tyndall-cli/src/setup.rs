//! From a shot to what the backends render: the scene, its acceleration structure, the frame and the lights' pictures.

use std::sync::Arc;

use glam::Vec3;
use tyndall::{
    cpu::LightTexture,
    frame::{Camera, Frame, Light, Medium},
};
use tyndall_scene::{
    builtin,
    framing::{self, Framing},
    geometry::Bounds,
    load,
    scene::Scene,
    shadow_fit,
    trace::Tracer,
};

use crate::{
    failure::Failure,
    light_texture,
    progress::Stages,
    shot::{CameraBase, LightSpec, Origin, Problem, SceneCameras, SceneSource, Shot, ShotError},
};

/// A shot with everything it names loaded, and everything it leaves out filled in. Clones share the scene.
#[derive(Clone)]
pub struct Setup {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The scene, ready to be hit by rays.
    pub tracer: Arc<Tracer>,
    /// The frame. Its lights have shadow projections wherever maps of them can be made.
    pub frame: Frame,
    /// What belongs to each of the frame's lights.
    pub lights: Vec<LightSetup>,
    /// Width and height [pixels].
    pub size: [u32; 2],
}

/// What belongs to a light besides its part of the frame.
#[derive(Clone)]
pub struct LightSetup {
    /// Width and height of a face of its shadow map [texels].
    pub map_size: [u32; 2],
    /// The picture it shines through.
    pub texture: Option<LightTexture>,
}

/// Loads a scene.
///
/// # Errors
/// [`Failure::Input`] where it is missing, broken, or no scene at all.
pub fn load_scene(source: &SceneSource) -> Result<Scene, Failure> {
    match source {
        SceneSource::Builtin(name) => builtin::builtin(name).ok_or_else(|| {
            let names: Vec<&str> = builtin::BUILTINS.iter().map(|scene| scene.name).collect();
            Failure::input(Problem::unknown_name("built-in scene", name, &names))
        }),
        SceneSource::File(path) => {
            let ending = path.extension().unwrap_or_default();
            if ending.eq_ignore_ascii_case("gltf") || ending.eq_ignore_ascii_case("glb") {
                load::load(path).map_err(Failure::input)
            } else {
                Err(Failure::Input(anyhow::anyhow!(
                    "expected a shot (.toml) or a scene (.gltf, .glb or builtin:NAME), found {}",
                    path.display()
                )))
            }
        }
    }
}

impl Setup {
    /// Loads what the shot names and fills in what it leaves out.
    ///
    /// # Errors
    /// [`Failure::Input`] where the scene or a picture can't be loaded, or the shot doesn't fit the scene.
    pub fn new(shot: &Shot, stages: &mut Stages) -> Result<Self, Failure> {
        let scene = stages
            .run(&format!("load {}", shot.scene), |_| load_scene(&shot.scene))
            .map_err(|failure| at_scene(shot, failure))?;
        let tracer = stages.run("build BVH", |_| Tracer::new(&scene));
        let aspect = shot.size[0] as f32 / shot.size[1] as f32;
        let framing = needs_framing(shot)
            .then(|| stages.run("frame", |_| framing::frame_scene(&scene, &tracer, aspect)));
        let specs = lights(shot, framing.as_ref()).map_err(Failure::input)?;
        let frame = Frame {
            camera: camera(shot, &scene, &tracer, framing.as_ref(), aspect)
                .map_err(Failure::input)?,
            lights: specs.iter().map(|spec| light(spec, &tracer)).collect(),
            medium: medium(shot, framing.as_ref()).map_err(Failure::input)?,
            technique: shot.technique.clone(),
        };
        let lights = specs.iter().map(load_light).collect::<Result<_, _>>()?;
        Ok(Self {
            scene: Arc::new(scene),
            tracer: Arc::new(tracer),
            frame,
            lights,
            size: shot.size,
        })
    }
}

/// Says where the shot names the scene, unless the scene itself was given.
fn at_scene(shot: &Shot, failure: Failure) -> Failure {
    match (failure, shot.scene_location.origin) {
        (Failure::Input(error), Origin::Line(_) | Origin::Override) => {
            Failure::Input(error.context(shot.scene_location.clone()))
        }
        (failure, _) => failure,
    }
}

fn needs_framing(shot: &Shot) -> bool {
    shot.camera.base == CameraBase::Scene || shot.lights.is_none() || shot.medium.is_none()
}

fn lights(shot: &Shot, framing: Option<&Framing>) -> Result<Vec<LightSpec>, ShotError> {
    match (&shot.lights, framing) {
        (Some(lights), _) => Ok(lights.clone()),
        (None, Some(framing)) => shot.scene_lights(&framing.lights),
        (None, None) => Ok(Vec::new()),
    }
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

fn camera(
    shot: &Shot,
    scene: &Scene,
    tracer: &Tracer,
    framing: Option<&Framing>,
    aspect: f32,
) -> Result<Camera, ShotError> {
    let bounds = tracer.geometry().bounds();
    let cameras = SceneCameras {
        named: &framing::cameras(scene, aspect),
        framed: framing.map(|framing| framing.camera),
        farthest: &|eye| bounds.map_or(0.0, |bounds| farthest(&bounds, eye.into())),
    };
    shot.camera.resolve(&cameras, aspect)
}

fn farthest(bounds: &Bounds, eye: Vec3) -> f32 {
    (bounds.min - eye)
        .abs()
        .max((bounds.max - eye).abs())
        .length()
}

fn light(spec: &LightSpec, tracer: &Tracer) -> Light {
    Light {
        emitter: spec.emitter,
        shadow: shadow_fit::fit(tracer.geometry(), &spec.emitter),
        texture: spec.texture.as_ref().map(|texture| texture.placement),
    }
}

fn load_light(spec: &LightSpec) -> Result<LightSetup, Failure> {
    let load = |texture: &crate::shot::TextureSpec| {
        light_texture::load(&texture.file).map_err(|cause| {
            Failure::Input(anyhow::Error::new(cause).context(texture.location.clone()))
        })
    };
    Ok(LightSetup {
        map_size: [spec.shadow_map; 2],
        texture: spec.texture.as_ref().map(load).transpose()?,
    })
}
