//! `[[light]]`: an emitter, the size of its shadow map, the texture it shines through, and its own technique.

use std::{
    f32::consts::FRAC_PI_2,
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

use glam::{DVec3, Vec3};
use tyndall::{
    frame::{Emitter, LightKind, TexturePlacement},
    techniques::Technique,
};

use super::{
    error::{Location, Problem, ShotError},
    reader::{Field, Section},
    technique,
    tree::{Entry, Value},
};

/// A light of a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSpec {
    /// Kind, place and strength.
    pub emitter: Emitter,
    /// The position of the emitter, or of a directional light's texture, before it is rounded \[m].
    pub position: DVec3,
    /// Texels of a side of its shadow map, of a face of its cube map, or of a map of each of a rectangle's samples.
    pub shadow_map: u32,
    /// The texture it shines through.
    pub texture: Option<TextureSpec>,
    /// Its own technique; `None`: the shot's.
    pub technique: Option<Technique>,
}

/// The texture a light shines through.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSpec {
    /// The picture file, or the pattern of one a frame (`####` or `%04d`).
    pub file: PathBuf,
    /// The place where the shot names it.
    pub location: Location,
    /// Its position in space.
    pub placement: TexturePlacement,
}

/// Texels of a side of a shadow map that a shot leaves to us: directional and spot lights.
const DEFAULT_MAP: u32 = 2048;
/// Default texels of a side of a point light's cube face, and of the map of each sample of a rectangular light.
const DEFAULT_FACE: u32 = 1024;
const DEFAULT_RECT: u32 = 128;
/// The most texels a shadow map's side may have.
const MAX_MAP: u32 = 16_384;
const MAX_SAMPLES: u32 = 1024;
const DEFAULT_SAMPLES: u32 = 256;

const KINDS: [&str; 4] = ["directional", "point", "spot", "rect"];
const COMMON: [&str; 4] = ["type", "shadow_map", "texture", "technique"];
/// Sine of the smallest angle between a texture's `up` and the axis it turns about, or between a parallelogram's edges.
const LEAST_SINE: f32 = 1e-4;

/// Reads every `[[light]]`; picture files are relative to `folder`.
pub(super) fn read_all(field: &Field<'_>, folder: &Path) -> Result<Vec<LightSpec>, ShotError> {
    field
        .list("a list of tables: [[light]]")?
        .iter()
        .map(|light| read(light, folder))
        .collect()
}

fn read(field: &Field<'_>, folder: &Path) -> Result<LightSpec, ShotError> {
    let section = field.section()?;
    let expected = super::error::one_of(&KINDS);
    let kind = section.require("type", &expected)?;
    let (emitter, default_map) = match kind.text(&expected)? {
        "directional" => (directional(&section)?, DEFAULT_MAP),
        "point" => (point(&section)?, DEFAULT_FACE),
        "spot" => (spot(&section)?, DEFAULT_MAP),
        "rect" => (rect(&section)?, DEFAULT_RECT),
        other => {
            return Err(kind.error(Problem::unknown_name("type of light", other, &KINDS)));
        }
    };
    Ok(LightSpec {
        emitter,
        position: precise_position(&section)?,
        shadow_map: section.whole_or("shadow_map", default_map, map_range(&emitter))?,
        texture: section
            .get("texture")
            .map(|field| texture(&field, &emitter, folder))
            .transpose()?,
        technique: section
            .get("technique")
            .map(|field| technique::read_own(&field, LightKind::of(&emitter)))
            .transpose()?,
    })
}

/// The one position that a light of any kind has.
fn precise_position(section: &Section<'_>) -> Result<DVec3, ShotError> {
    for key in ["position", "center"] {
        if section.get(key).is_some() {
            return section.point(key);
        }
    }
    match section.get("texture") {
        Some(texture) if texture.section()?.get("center").is_some() => {
            texture.section()?.point("center")
        }
        _ => Ok(DVec3::ZERO),
    }
}

impl LightSpec {
    /// The light with its position relative to `origin` [m], rounded once.
    pub(crate) fn relative_to(mut self, origin: DVec3) -> Self {
        let place = (self.position - origin).as_vec3().into();
        match &mut self.emitter {
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => *position = place,
            Emitter::Rect { center, .. } => *center = place,
            Emitter::Directional { .. } => {}
        }
        let texture = self.texture.as_mut().map(|texture| &mut texture.placement);
        if let Some(TexturePlacement::Parallelogram { center, .. }) = texture {
            *center = place;
        }
        self
    }
}

/// Texels that a side of the light's shadow map, or of each of a rectangle's samples, may have.
fn map_range(emitter: &Emitter) -> RangeInclusive<u32> {
    match emitter {
        Emitter::Rect { .. } => 16..=1024,
        _ => 1..=MAX_MAP,
    }
}

/// Refuses keys that are neither common to all lights nor in `own`.
fn only(section: &Section<'_>, own: &[&str]) -> Result<(), ShotError> {
    let known: Vec<&str> = COMMON.iter().chain(own).copied().collect();
    section.only(&known)
}

fn directional(section: &Section<'_>) -> Result<Emitter, ShotError> {
    only(section, &["direction", "illuminance"])?;
    Ok(Emitter::Directional {
        direction: section.direction("direction")?,
        illuminance: section.color("illuminance")?,
    })
}

fn point(section: &Section<'_>) -> Result<Emitter, ShotError> {
    only(section, &["position", "intensity", "radius"])?;
    Ok(Emitter::Point {
        position: section.point("position")?.as_vec3().into(),
        intensity: section.color("intensity")?,
        radius: lamp_radius(section)?,
    })
}

fn spot(section: &Section<'_>) -> Result<Emitter, ShotError> {
    let own = [
        "position",
        "direction",
        "intensity",
        "inner",
        "outer",
        "radius",
    ];
    only(section, &own)?;
    let expected = "an angle above 0 and up to pi/2 radians";
    let outer = section
        .require("outer", expected)?
        .real(expected, |x| x > 0.0 && x <= FRAC_PI_2)?;
    let expected = format!("an angle from 0 to outer = {outer} radians");
    let inner = section
        .require("inner", &expected)?
        .real(&expected, |x| x >= 0.0 && x <= outer)?;
    Ok(Emitter::Spot {
        position: section.point("position")?.as_vec3().into(),
        direction: section.direction("direction")?,
        intensity: section.color("intensity")?,
        inner,
        outer,
        radius: lamp_radius(section)?,
    })
}

/// The radius of a point or spot light \[m].
fn lamp_radius(section: &Section<'_>) -> Result<f32, ShotError> {
    section.get("radius").map_or(Ok(0.0), |field| {
        field.real("a radius of at least 0 metres", |x| x >= 0.0)
    })
}

fn rect(section: &Section<'_>) -> Result<Emitter, ShotError> {
    only(section, &["center", "edge_x", "edge_y", "radiance", "vpls"])?;
    let (edge_x, edge_y) = edges(section)?;
    Ok(Emitter::Rect {
        center: section.point("center")?.as_vec3().into(),
        edge_x,
        edge_y,
        radiance: section.color("radiance")?,
        samples: section.whole_or("vpls", DEFAULT_SAMPLES, 1..=MAX_SAMPLES)?,
    })
}

/// The edges of a parallelogram that has an area.
fn edges(section: &Section<'_>) -> Result<([f32; 3], [f32; 3]), ShotError> {
    let edge_x = section.direction("edge_x")?;
    let edge_y = section.direction("edge_y")?;
    if is_parallel(edge_x, edge_y) {
        let field = section.require("edge_y", "")?;
        return Err(field.unexpected("an edge that is not parallel to edge_x"));
    }
    Ok((edge_x, edge_y))
}

fn is_parallel(a: [f32; 3], b: [f32; 3]) -> bool {
    let normal = Vec3::from(a)
        .normalize_or_zero()
        .cross(Vec3::from(b).normalize_or_zero());
    normal.length() <= LEAST_SINE
}

fn texture(field: &Field<'_>, emitter: &Emitter, folder: &Path) -> Result<TextureSpec, ShotError> {
    let section = field.section()?;
    let placement = match emitter {
        Emitter::Directional { direction, .. } => parallelogram(&section, *direction)?,
        Emitter::Spot { direction, .. } => {
            section.only(&["file", "up"])?;
            let up = turned_about(&section, "up", *direction, "the spot's direction")?;
            TexturePlacement::Cone { up }
        }
        Emitter::Point { .. } => sphere(&section)?,
        Emitter::Rect { .. } => {
            section.only(&["file"])?;
            TexturePlacement::Rectangle
        }
    };
    let file = section.require("file", TEXTURE_FILE)?;
    Ok(TextureSpec {
        file: folder.join(file.text(TEXTURE_FILE)?),
        location: file.location(),
        placement,
    })
}

const TEXTURE_FILE: &str = "the path of a .png, .jpg or .exr picture";

fn parallelogram(section: &Section<'_>, light: [f32; 3]) -> Result<TexturePlacement, ShotError> {
    section.only(&["file", "center", "edge_x", "edge_y"])?;
    let (edge_x, edge_y) = edges(section)?;
    let normal = Vec3::from(edge_x)
        .normalize_or_zero()
        .cross(Vec3::from(edge_y).normalize_or_zero())
        .normalize_or_zero();
    if normal.dot(Vec3::from(light).normalize_or_zero()).abs() <= LEAST_SINE {
        let field = section.require("edge_y", "")?;
        return Err(field.unexpected("a parallelogram that the light doesn't graze"));
    }
    Ok(TexturePlacement::Parallelogram {
        center: section.point("center")?.as_vec3().into(),
        edge_x,
        edge_y,
    })
}

fn sphere(section: &Section<'_>) -> Result<TexturePlacement, ShotError> {
    section.only(&["file", "up", "forward"])?;
    let up = section.direction("up")?;
    let forward = turned_about(section, "forward", up, "light.texture.up")?;
    Ok(TexturePlacement::Sphere { up, forward })
}

/// A direction that is not parallel to `axis`.
fn turned_about(
    section: &Section<'_>,
    key: &str,
    axis: [f32; 3],
    axis_name: &str,
) -> Result<[f32; 3], ShotError> {
    let direction = section.direction(key)?;
    if is_parallel(direction, axis) {
        let field = section.require(key, "")?;
        return Err(field.unexpected(format!("a direction that is not parallel to {axis_name}")));
    }
    Ok(direction)
}

/// Lights of a scene as a shot would write them, for `--set` to change; their positions are relative to `origin`.
pub(super) fn to_tree(emitters: &[Emitter], origin: DVec3) -> Entry {
    Entry::of_scene(Value::List(
        emitters
            .iter()
            .map(|emitter| Entry::of_scene(emitter_value(emitter, origin)))
            .collect(),
    ))
}

fn emitter_value(emitter: &Emitter, origin: DVec3) -> Value {
    let point = |p: [f32; 3]| Value::from(origin + Vec3::from(p).as_dvec3());
    match *emitter {
        Emitter::Directional {
            direction,
            illuminance,
        } => Value::scene_table([
            ("type", "directional".into()),
            ("direction", direction.into()),
            ("illuminance", illuminance.into()),
        ]),
        Emitter::Point {
            position,
            intensity,
            radius,
        } => Value::scene_table([
            ("type", "point".into()),
            ("position", point(position)),
            ("intensity", intensity.into()),
            ("radius", radius.into()),
        ]),
        Emitter::Spot {
            position,
            direction,
            intensity,
            inner,
            outer,
            radius,
        } => Value::scene_table([
            ("type", "spot".into()),
            ("position", point(position)),
            ("direction", direction.into()),
            ("intensity", intensity.into()),
            ("inner", inner.into()),
            ("outer", outer.into()),
            ("radius", radius.into()),
        ]),
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            samples,
        } => Value::scene_table([
            ("type", "rect".into()),
            ("center", point(center)),
            ("edge_x", edge_x.into()),
            ("edge_y", edge_y.into()),
            ("radiance", radiance.into()),
            ("vpls", Value::Integer(samples.into())),
        ]),
    }
}
