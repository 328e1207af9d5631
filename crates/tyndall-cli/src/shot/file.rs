//! Shot files: their sections, read and checked, and the changes of the command line.

use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
};

use glam::DVec3;
use tyndall::{
    frame::{Emitter, LightKind, Medium},
    techniques::{TABLE, Technique, TechniqueInfo},
};

use super::{
    animation::{self, Animation, Temporal},
    camera::CameraSpec,
    error::{Location, Origin, Problem, ShotError},
    light::{self, LightSpec},
    medium,
    overrides::Override,
    reader::Section,
    source::{SceneSource, stem},
    technique,
    tree::{self, Entry, Place, Table},
};

/// Everything one picture needs, checked as far as it can be without the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The shot or scene file, as it was given.
    pub file: PathBuf,
    /// The scene of the picture.
    pub scene: SceneSource,
    /// The place where the shot names the scene.
    pub scene_location: Location,
    /// Width and height \[pixels].
    pub size: [u32; 2],
    /// The camera of the picture.
    pub camera: CameraSpec,
    /// The lights; `None`: the scene's, or a default sun.
    pub lights: Option<Vec<LightSpec>>,
    /// The medium; `None`: one that suits the scene's size.
    pub medium: Option<Medium>,
    /// The technique that computes every light without one of its own; `None`: the first of the table that can do it.
    pub technique: Option<Technique>,
    /// Reuse of earlier frames, in sequences.
    pub temporal: Option<Temporal>,
    /// Movements, in sequences.
    pub animation: Option<Animation>,
    /// Changes to lights and media that only the scene knows.
    deferred: Vec<Override>,
}

/// Size of a picture whose shot doesn't say \[pixels].
const DEFAULT_SIZE: [u32; 2] = [960, 540];
/// The longest side of a picture \[pixels].
const MAX_SIDE: u32 = 16_384;
/// The most pixels of a picture: an `Rgba32Float` texture of 1 GiB.
const MAX_PIXELS: u64 = 1 << 26;

const KEYS: [&str; 8] = [
    "scene",
    "size",
    "camera",
    "light",
    "medium",
    "technique",
    "temporal",
    "animation",
];

impl Shot {
    /// Reads a shot file (`.toml`), or makes a shot of a scene (`.gltf`, `.glb`, `builtin:NAME`).
    /// `technique` takes the place of the shot's; `overrides` are applied last, in order.
    ///
    /// # Errors
    /// [`ShotError`] where the file can't be read, is not TOML, or holds a key or value that doesn't belong.
    pub fn load(
        file: &Path,
        technique: Option<&str>,
        overrides: &[Override],
    ) -> Result<Self, ShotError> {
        let root = if file.extension() == Some(OsStr::new("toml")) {
            let source = std::fs::read_to_string(file).map_err(|cause| {
                error_in(file, Origin::File, Problem::Unreadable(cause.to_string()))
            })?;
            parse(file, &source)?
        } else {
            of_scene(file)
        };
        Self::of_tree(file, root, technique, overrides)
    }

    /// Reads the text of a shot file. `file` is what errors name and what its paths are relative to; it need not exist.
    ///
    /// # Errors
    /// [`ShotError`], as for [`Shot::load`].
    pub fn of_text(file: &Path, text: &str, overrides: &[Override]) -> Result<Self, ShotError> {
        Self::of_tree(file, parse(file, text)?, None, overrides)
    }

    fn of_tree(
        file: &Path,
        mut root: Table,
        technique: Option<&str>,
        overrides: &[Override],
    ) -> Result<Self, ShotError> {
        let in_file = |key: &str| root.contains_key(key);
        let (camera_in_file, lights_in_file, medium_in_file) =
            (in_file("camera"), in_file("light"), in_file("medium"));
        if let Some(name) = technique {
            technique::replace(&mut root, name);
        }
        let (deferred, immediate): (Vec<_>, Vec<_>) =
            overrides.iter().cloned().partition(|change| {
                (!lights_in_file && change.is_within("light"))
                    || (!medium_in_file && change.is_within("medium"))
            });
        for change in &immediate {
            change.apply(file, &mut root)?;
        }
        Self::read(file, &root, camera_in_file, deferred)
    }

    fn read(
        file: &Path,
        root: &Table,
        camera_in_file: bool,
        deferred: Vec<Override>,
    ) -> Result<Self, ShotError> {
        let section = Section::root(file, root);
        section.only(&KEYS)?;
        let folder = folder(file);
        let expected = "a path or builtin:NAME";
        let scene = section.require("scene", expected)?;
        let lights = section
            .get("light")
            .map(|field| light::read_all(&field, folder))
            .transpose()?;
        Ok(Self {
            file: file.to_owned(),
            scene: SceneSource::within(scene.text(expected)?, folder),
            scene_location: scene.location(),
            size: size(&section)?,
            camera: match section.get("camera") {
                Some(field) => CameraSpec::read(&field, camera_in_file)?,
                None => CameraSpec::of_scene(Location {
                    file: file.to_owned(),
                    origin: Origin::File,
                    path: "camera".to_owned(),
                }),
            },
            technique: section
                .get("technique")
                .map(|field| technique::read(&field, &kinds(lights.as_deref())))
                .transpose()?,
            lights,
            medium: section
                .get("medium")
                .map(|field| medium::read(&field))
                .transpose()?,
            temporal: section
                .get("temporal")
                .map(|field| animation::read_temporal(&field))
                .transpose()?,
            animation: section
                .get("animation")
                .map(|field| animation::read_animation(&field))
                .transpose()?,
            deferred,
        })
    }

    /// Every technique that the shot names, in `[technique]` and of its lights.
    pub fn named_techniques(&self) -> Vec<&'static TechniqueInfo> {
        let lights = self.lights.iter().flatten();
        let own = lights.filter_map(|light| light.technique.as_ref());
        let named = self.technique.iter().chain(own);
        // Lights that are left to the scene get theirs from the command line.
        let deferred = self.deferred.iter().filter_map(Override::light_technique);
        let deferred = deferred.filter_map(|name| TABLE.iter().find(|info| info.name == name));
        named.map(Technique::info).chain(deferred).collect()
    }

    /// Default name of this shot's pictures: the shot's or the scene's name.
    pub fn name(&self) -> String {
        if self.file.extension() == Some(OsStr::new("toml")) {
            stem(&self.file)
        } else {
            self.scene.name()
        }
    }

    /// The lights of a shot that leaves them to the scene, with the changes of `--set`. `emitters` are relative to `origin` \[m].
    pub(crate) fn scene_lights(
        &self,
        emitters: &[Emitter],
        origin: DVec3,
    ) -> Result<Vec<LightSpec>, ShotError> {
        let root = self.changed("light", light::to_tree(emitters, origin))?;
        let field = Section::root(&self.file, &root).require("light", "lights")?;
        light::read_all(&field, folder(&self.file))
    }

    /// The medium of a shot that leaves it to the scene, with the changes of `--set`.
    pub(crate) fn scene_medium(&self, medium: &Medium) -> Result<Medium, ShotError> {
        let root = self.changed("medium", medium::to_tree(medium))?;
        medium::read(&Section::root(&self.file, &root).require("medium", "a medium")?)
    }

    fn changed(&self, section: &str, entry: Entry) -> Result<Table, ShotError> {
        let mut root = Table::from([(section.to_owned(), entry)]);
        for change in self.deferred.iter().filter(|c| c.is_within(section)) {
            change.apply(&self.file, &mut root)?;
        }
        Ok(root)
    }
}

/// Kinds of the lights that have no technique of their own.
fn kinds(lights: Option<&[LightSpec]>) -> Vec<LightKind> {
    let lights = lights.unwrap_or_default().iter();
    lights
        .filter(|light| light.technique.is_none())
        .map(|light| LightKind::of(&light.emitter))
        .collect()
}

fn folder(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

fn parse(file: &Path, source: &str) -> Result<Table, ShotError> {
    tree::parse(source).map_err(|(line, cause)| {
        let message = cause.message().trim().replace('\n', ", ");
        error_in(file, Origin::Line(line), Problem::Syntax(message))
    })
}

fn error_in(file: &Path, origin: Origin, problem: Problem) -> ShotError {
    let location = Location {
        file: file.to_owned(),
        origin,
        path: String::new(),
    };
    ShotError::new(location, problem)
}

/// A shot of a scene file: its path, relative to its own folder, and a size.
fn of_scene(file: &Path) -> Table {
    let name = file.file_name().unwrap_or(file.as_os_str());
    let [width, height] = DEFAULT_SIZE.map(|side| tree::Value::Integer(side.into()));
    [
        ("scene", tree::Value::Text(name.to_string_lossy().into())),
        (
            "size",
            tree::Value::List(vec![Entry::of_scene(width), Entry::of_scene(height)]),
        ),
    ]
    .into_iter()
    .map(|(key, value)| {
        let place = Place::Scene;
        (key.to_owned(), Entry { value, place })
    })
    .collect()
}

fn size(section: &Section<'_>) -> Result<[u32; 2], ShotError> {
    let expected = format!("two whole numbers from 1 to {MAX_SIDE}, width and height");
    let field = section.require("size", &expected)?;
    let mut size = [0; 2];
    for (side, item) in size.iter_mut().zip(field.array::<2>(&expected)?) {
        *side = item
            .whole(1..=MAX_SIDE)
            .map_err(|_| field.unexpected(expected.as_str()))?;
    }
    if u64::from(size[0]) * u64::from(size[1]) > MAX_PIXELS {
        return Err(field.unexpected(format!("at most {MAX_PIXELS} pixels in all")));
    }
    Ok(size)
}
