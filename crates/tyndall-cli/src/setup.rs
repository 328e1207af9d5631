//! From a shot to what the backends render: the scene, its acceleration structure, the frame and the lights' pictures.

use std::sync::{Arc, LazyLock};

use glam::Vec3;
use tyndall::{
    cpu::LightTexture,
    frame::{Camera, Emitter, Frame, Light, Medium},
    techniques::TechniqueChoice,
};
use tyndall_scene::{
    builtin,
    framing::{self, Framing},
    geometry::{Bounds, Geometry},
    load,
    scene::Scene,
    shadow_fit,
    trace::Tracer,
};

use crate::{
    failure::Failure,
    light_texture::{Pictures, TextureError},
    progress::Stages,
    shot::{
        CameraBase, LightSpec, Location, Origin, Problem, SceneCameras, SceneSource, Shot,
        ShotError,
    },
};

/// A shot with everything it names loaded, and everything it leaves out filled in. Clones share the scene.
#[derive(Clone)]
pub struct Setup {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The scene, ready to be hit by rays.
    pub tracer: Arc<LazyTracer>,
    /// The frame. Its lights have shadow projections wherever maps of them can be made.
    pub frame: Frame,
    /// What computes each of its lights.
    pub techniques: TechniqueChoice,
    /// What belongs to each of the frame's lights.
    pub lights: Vec<LightSetup>,
    /// Width and height [pixels].
    pub size: [u32; 2],
}

/// A tracer that is built when the first ray is cast: frames that the GPU draws cast none.
pub type LazyTracer = LazyLock<Tracer, Box<dyn FnOnce() -> Tracer + Send>>;

/// What belongs to a light besides its part of the frame.
#[derive(Clone)]
pub struct LightSetup {
    /// Width and height of a face of its shadow map [texels].
    pub map_size: [u32; 2],
    /// The picture it shines through; another one where it changes.
    pub texture: Option<Arc<LightTexture>>,
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
    /// Loads what the shot names and fills in what it leaves out; everything is at rest.
    ///
    /// # Errors
    /// [`Failure::Input`] where the scene or a picture can't be loaded, or the shot doesn't fit the scene.
    pub fn new(shot: &Shot, stages: &mut Stages) -> Result<Self, Failure> {
        let source = Source::new(shot, stages)?;
        let moment = source.moment(&source.scene, 0)?;
        let (scene, tracer) = (Arc::clone(&source.scene), Arc::clone(&source.tracer));
        Ok(source.setup(scene, tracer, moment, source.tracer.geometry()))
    }
}

/// What all frames of a shot share.
pub(crate) struct Source {
    shot: Shot,
    /// The scene at rest.
    pub(crate) scene: Arc<Scene>,
    /// The same.
    pub(crate) tracer: Arc<LazyTracer>,
    framing: Option<Framing>,
    /// One entry a light.
    pictures: Vec<Option<(Pictures, Location)>>,
}

/// What may be another in each frame, besides the scene's nodes.
pub(crate) struct Moment {
    pub(crate) camera: Camera,
    pub(crate) lights: Vec<LightSpec>,
    /// The pictures of the lights.
    textures: Vec<Option<Arc<LightTexture>>>,
    pub(crate) medium: Medium,
}

impl Source {
    /// Loads what the shot names.
    ///
    /// # Errors
    /// As for [`Setup::new`].
    pub(crate) fn new(shot: &Shot, stages: &mut Stages) -> Result<Self, Failure> {
        let scene = stages
            .run(&format!("load {}", shot.scene), |_| load_scene(&shot.scene))
            .map_err(|failure| at_scene(shot, failure))?;
        let tracer = stages.run("build BVH", |_| built(Tracer::new(&scene)));
        let framing = needs_framing(shot).then(|| {
            stages.run("frame", |_| {
                framing::frame_scene(&scene, &tracer, aspect(shot))
            })
        });
        let specs = lights(shot, framing.as_ref()).map_err(Failure::input)?;
        Ok(Self {
            shot: shot.clone(),
            scene: Arc::new(scene),
            tracer: Arc::new(tracer),
            framing,
            pictures: specs.iter().map(open_pictures).collect::<Result<_, _>>()?,
        })
    }

    /// Camera, lights and medium of a frame, of which the scene's own are where its nodes are now.
    ///
    /// # Errors
    /// [`Failure::Input`] where the shot doesn't fit the scene, or a picture of the frame can't be loaded.
    pub(crate) fn moment(&self, scene: &Scene, frame: u32) -> Result<Moment, Failure> {
        let textures = self.pictures.iter();
        let textures = textures.map(|pictures| picture_at(pictures.as_ref(), frame));
        let textures = textures.collect::<Result<_, _>>()?;
        self.moment_with(scene, textures).map_err(Failure::input)
    }

    fn moment_with(
        &self,
        scene: &Scene,
        textures: Vec<Option<Arc<LightTexture>>>,
    ) -> Result<Moment, ShotError> {
        let (shot, aspect) = (&self.shot, aspect(&self.shot));
        let cameras = framing::cameras(scene, aspect);
        let own_lights: Vec<Emitter> = framing::lights(scene)
            .into_iter()
            .map(|(_, light)| light)
            .collect();
        let framing = self.framing.as_ref().map(|framing| Framing {
            camera: cameras
                .first()
                .map_or(framing.camera, |(_, camera)| *camera),
            lights: if own_lights.is_empty() {
                framing.lights.clone()
            } else {
                own_lights
            },
            medium: framing.medium.clone(),
        });
        let bounds = self.tracer.geometry().bounds();
        let cameras = SceneCameras {
            named: &cameras,
            framed: framing.as_ref().map(|framing| framing.camera),
            farthest: &|eye| bounds.map_or(0.0, |bounds| farthest(&bounds, eye.into())),
        };
        Ok(Moment {
            camera: shot.camera.resolve(&cameras, aspect)?,
            lights: lights(shot, framing.as_ref())?,
            textures,
            medium: medium(shot, framing.as_ref())?,
        })
    }

    /// A frame of this moment. Shadow maps enclose `extent`.
    pub(crate) fn setup(
        &self,
        scene: Arc<Scene>,
        tracer: Arc<LazyTracer>,
        moment: Moment,
        extent: &Geometry,
    ) -> Setup {
        let lights = moment.lights.iter();
        let extras = lights.clone().zip(moment.textures);
        Setup {
            scene,
            tracer,
            frame: Frame {
                camera: moment.camera,
                lights: lights.map(|spec| light(spec, extent)).collect(),
                medium: moment.medium,
            },
            techniques: self.shot.technique.clone().into(),
            lights: extras
                .map(|(spec, texture)| LightSetup {
                    map_size: [spec.shadow_map; 2],
                    texture,
                })
                .collect(),
            size: self.shot.size,
        }
    }
}

/// A tracer that is there already.
pub(crate) fn built(tracer: Tracer) -> LazyTracer {
    let lazy: LazyTracer = LazyLock::new(Box::new(|| tracer));
    LazyLock::force(&lazy);
    lazy
}

fn aspect(shot: &Shot) -> f32 {
    shot.size[0] as f32 / shot.size[1] as f32
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

fn farthest(bounds: &Bounds, eye: Vec3) -> f32 {
    (bounds.min - eye)
        .abs()
        .max((bounds.max - eye).abs())
        .length()
}

fn light(spec: &LightSpec, extent: &Geometry) -> Light {
    Light {
        emitter: spec.emitter,
        shadow: shadow_fit::fit(extent, &spec.emitter),
        texture: spec.texture.as_ref().map(|texture| texture.placement),
    }
}

fn open_pictures(spec: &LightSpec) -> Result<Option<(Pictures, Location)>, Failure> {
    let Some(texture) = &spec.texture else {
        return Ok(None);
    };
    let location = texture.location.clone();
    match Pictures::open(&texture.file) {
        Ok(pictures) => Ok(Some((pictures, location))),
        Err(cause) => Err(at_texture(cause, location)),
    }
}

fn picture_at(
    pictures: Option<&(Pictures, Location)>,
    frame: u32,
) -> Result<Option<Arc<LightTexture>>, Failure> {
    let picture = |(pictures, location): &(Pictures, Location)| {
        pictures
            .at(frame)
            .map_err(|cause| at_texture(cause, location.clone()))
    };
    pictures.map(picture).transpose()
}

/// Says where the shot names the picture.
fn at_texture(cause: TextureError, location: Location) -> Failure {
    Failure::Input(anyhow::Error::new(cause).context(location))
}
