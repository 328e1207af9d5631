//! Subjects of the papers: their scenes where those are at hand, else a built-in scene of the same kind.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::Vec3;
use tyndall::{
    cpu::LightTexture,
    frame::{Emitter, TexturePlacement},
};
use tyndall_scene::{geometry::Bounds, shadow_fit};

use crate::{
    failure::Failure,
    light_texture,
    load::{LoadedShot, ShotFrame},
    progress::Progress,
    shot::{Override, Shot},
};

/// A scene of a paper.
#[derive(Clone, Copy, Debug)]
pub(super) struct Subject {
    /// The paper's name for it.
    pub(super) name: &'static str,
    /// Its file among the assets, and how it is seen and lit.
    asset: Option<Asset>,
    /// The scene that is rendered in its place where the file is missing.
    stand_in: &'static str,
    /// Whether its light shines through a texture.
    textured: bool,
}

#[derive(Clone, Copy, Debug)]
struct Asset {
    file: &'static str,
    shot: &'static str,
}

macro_rules! asset {
    ($file:literal, $shot:literal) => {
        Some(Asset {
            file: $file,
            shot: include_str!(concat!("shots/", $shot, ".toml")),
        })
    };
}

const fn subject(name: &'static str, asset: Option<Asset>, stand_in: &'static str) -> Subject {
    Subject {
        name,
        asset,
        stand_in,
        textured: false,
    }
}

pub(super) const SIBENIK: Subject = subject(
    "SIBENIK",
    asset!("sibenik.glb", "sibenik"),
    "builtin:church",
);
pub(super) const SIBENIKTEX: Subject = Subject {
    name: "SIBENIKTEX",
    textured: true,
    ..SIBENIK
};
pub(super) const CHURCH: Subject = subject("church", None, "builtin:church");
pub(super) const BLIND: Subject = subject("room", None, "builtin:slats");
pub(super) const MOUNTAINS: Subject = subject("mountains", None, "builtin:terrain");
pub(super) const BOX_WALL: Subject = subject(
    "box before a wall",
    asset!("box-wall.glb", "box-wall"),
    "builtin:slats",
);
pub(super) const TREES: Subject = subject("TREES", None, "builtin:forest");
pub(super) const TERRAIN: Subject = subject(
    "TERRAIN",
    asset!("terrain.glb", "terrain"),
    "builtin:terrain",
);
pub(super) const DRAGON: Subject =
    subject("dragon", asset!("dragon.glb", "dragon"), "builtin:slats");
pub(super) const BUNNY: Subject = subject("bunny", asset!("bunny.glb", "bunny"), "builtin:slats");
pub(super) const BUDDHA: Subject =
    subject("buddha", asset!("buddha.glb", "buddha"), "builtin:slats");
pub(super) const DONUTS: Subject = subject(
    "donuts & dragon",
    asset!("donuts-dragon.glb", "donuts-dragon"),
    "builtin:slats",
);
pub(super) const BIG_SCENE: Subject = subject(
    "bigScene",
    asset!("builtin:crowd", "crowd"),
    "builtin:crowd",
);
pub(super) const YEAH_RIGHT: Subject = subject(
    "yeahRight",
    asset!("builtin:sponge", "sponge"),
    "builtin:sponge",
);
pub(super) const DONUTS_RECT: Subject = subject(
    "donuts, area light",
    asset!("donuts-dragon.glb", "donuts-rect"),
    "builtin:slats",
);

/// Beginning of the file names of scenes that are made by code.
const BUILTIN: &str = "builtin:";

pub(super) const HAIRBALL: Subject = subject(
    "hairball",
    asset!("builtin:hairball", "hairball-rect"),
    "builtin:hairball",
);
pub(super) const ANGEL_RECT: Subject =
    subject("angel", asset!("angel.glb", "angel-rect"), "builtin:slats");
pub(super) const CITY_RECT: Subject =
    subject("city", asset!("city.glb", "city-rect"), "builtin:city");

/// The texture that SIBENIKTEX's light shines through, among the assets.
const TEXTURE: &str = "rose-window.png";

impl Subject {
    /// Loads it, and says what was loaded. `map` is the side of the shadow map \[texels].
    pub(super) fn load(
        &self,
        assets: Option<&Path>,
        size: [u32; 2],
        map: u32,
        progress: &mut Progress,
    ) -> Result<(ShotFrame, String), Failure> {
        let (shot, mut what) = self.shot(assets, size, map)?;
        let mut shot_frame = LoadedShot::at_rest(&shot, progress)?.frame(0)?;
        if self.textured {
            let file = assets
                .map(|folder| folder.join(TEXTURE))
                .filter(|file| file.is_file());
            what += if file.is_some() {
                ", light through a rose window"
            } else {
                ", light through coloured rings"
            };
            shot_frame = with_texture(&shot_frame, load_texture(file)?);
        }
        Ok((shot_frame, what))
    }

    /// Its shot, and what it is of.
    pub(super) fn shot(
        &self,
        assets: Option<&Path>,
        size: [u32; 2],
        map: u32,
    ) -> Result<(Shot, String), Failure> {
        self.shot_with(&[], assets, size, map)
    }

    /// Its shot with other values, each as `KEY=VALUE`, and what it is of.
    pub(super) fn shot_with(
        &self,
        values: &[&str],
        assets: Option<&Path>,
        [width, height]: [u32; 2],
        map: u32,
    ) -> Result<(Shot, String), Failure> {
        let overrides = [
            format!("size=[{width},{height}]"),
            format!("light.0.shadow_map={map}"),
        ];
        let overrides = overrides
            .iter()
            .map(String::as_str)
            .chain(values.iter().copied())
            .map(str::parse)
            .collect::<Result<Vec<Override>, _>>()
            .map_err(Failure::input)?;
        let (shot, what) = match self.asset_in(assets) {
            Some((folder, asset)) => {
                let file = folder.join(format!("{}.toml", self.name));
                (
                    Shot::of_text(&file, asset.shot, &overrides),
                    asset.file.to_owned(),
                )
            }
            None => {
                let shot = Shot::load(Path::new(self.stand_in), None, &overrides);
                (shot, format!("{} in its place", self.stand_in))
            }
        };
        Ok((shot.map_err(Failure::input)?, what))
    }

    /// Whether it has a file that is not there.
    pub(super) fn is_stood_in_for(&self, assets: Option<&Path>) -> bool {
        self.asset.is_some() && self.asset_in(assets).is_none()
    }

    fn asset_in<'a>(&self, assets: Option<&'a Path>) -> Option<(&'a Path, Asset)> {
        let asset = self.asset?;
        if asset.file.starts_with(BUILTIN) {
            return Some((Path::new(""), asset));
        }
        let folder = assets?;
        folder.join(asset.file).is_file().then_some((folder, asset))
    }
}

/// The folder of the scenes that can't be part of the repository: `shared/assets` of a folder above the current one or
/// above this program.
pub(super) fn find_assets() -> Option<PathBuf> {
    let starts = [std::env::current_dir(), std::env::current_exe()];
    let starts: Vec<PathBuf> = starts.into_iter().flatten().collect();
    starts
        .iter()
        .flat_map(|start| start.ancestors())
        .map(|folder| folder.join("shared/assets"))
        .find(|folder| folder.is_dir())
}

fn load_texture(file: Option<PathBuf>) -> Result<LightTexture, Failure> {
    file.map_or_else(
        || Ok(coloured_rings()),
        |file| light_texture::load(&file).map_err(Failure::input),
    )
}

/// Rings of saturated colours.
pub(super) fn coloured_rings() -> LightTexture {
    const SIDE: u32 = 256;
    const RINGS: f32 = 6.0;
    const COLOURS: [[f32; 3]; 4] = [
        [0.9, 0.1, 0.1],
        [0.1, 0.2, 0.9],
        [0.9, 0.7, 0.1],
        [0.1, 0.7, 0.2],
    ];
    let texel = |index: u32| {
        let place = glam::vec2((index % SIDE) as f32 + 0.5, (index / SIDE) as f32 + 0.5);
        let radius = (place * (2.0 / SIDE as f32) - 1.0).length();
        COLOURS[(radius * RINGS) as usize % COLOURS.len()]
    };
    LightTexture {
        size: [SIDE; 2],
        texels: (0..SIDE * SIDE).map(texel).collect(),
    }
}

/// The scene's middle and the radius of the sphere round it \[m].
pub(super) fn sphere(shot_frame: &ShotFrame) -> (Vec3, f32) {
    let bounds = bounds(shot_frame);
    (bounds.center(), 0.5 * bounds.extent().length())
}

/// The box round the scene; one about the origin where it is empty \[m].
pub(super) fn bounds(shot_frame: &ShotFrame) -> Bounds {
    let bounds = shot_frame.tracer.geometry().bounds();
    bounds.unwrap_or(Bounds {
        min: Vec3::NEG_ONE,
        max: Vec3::ONE,
    })
}

/// The first light through a texture: one that covers all of the scene, the cone, all directions or the rectangle.
pub(super) fn with_texture(shot_frame: &ShotFrame, texture: LightTexture) -> ShotFrame {
    let mut shot_frame = shot_frame.clone();
    let (center, radius) = sphere(&shot_frame);
    if let (Some(light), Some(extra)) = (
        shot_frame.frame.lights.first_mut(),
        shot_frame.lights.first_mut(),
    ) {
        light.texture = Some(placement(&light.emitter, center, radius));
        extra.texture = Some(Arc::new(texture));
    }
    shot_frame
}

fn placement(emitter: &Emitter, center: Vec3, radius: f32) -> TexturePlacement {
    let across = |direction: [f32; 3]| Vec3::from(direction).normalize().any_orthonormal_pair();
    match *emitter {
        Emitter::Directional { direction, .. } => {
            let (x, y) = across(direction);
            TexturePlacement::Parallelogram {
                center: center.to_array(),
                edge_x: (2.0 * radius * x).to_array(),
                edge_y: (2.0 * radius * y).to_array(),
            }
        }
        Emitter::Spot { direction, .. } => TexturePlacement::Cone {
            up: across(direction).0.to_array(),
        },
        Emitter::Point { .. } => TexturePlacement::Sphere {
            up: Vec3::Y.to_array(),
            forward: Vec3::Z.to_array(),
        },
        Emitter::Rect { .. } => TexturePlacement::Rectangle,
    }
}

/// The sun replaced by a spot light, far away in the same direction, whose cone holds all of the scene.
pub(super) fn with_far_spot(shot_frame: &ShotFrame) -> ShotFrame {
    /// Distance in radii of the scene.
    const DISTANCE: f32 = 4.0;
    let mut shot_frame = shot_frame.clone();
    let (center, radius) = sphere(&shot_frame);
    let distance = DISTANCE * radius;
    let outer = (1.0 / DISTANCE).asin();
    if let Some(light) = shot_frame.frame.lights.first_mut()
        && let Emitter::Directional {
            direction,
            illuminance,
        } = light.emitter
    {
        light.emitter = Emitter::Spot {
            position: (center - distance * Vec3::from(direction).normalize()).to_array(),
            direction,
            intensity: illuminance.map(|x| x * distance * distance),
            inner: 0.9 * outer,
            outer,
            radius: 0.0,
        };
        light.shadow = shadow_fit::fit(shot_frame.tracer.geometry(), &light.emitter);
        light.texture = None;
        shot_frame.lights[0].texture = None;
    }
    shot_frame
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Subject; 11] = [
        SIBENIK,
        SIBENIKTEX,
        TREES,
        TERRAIN,
        DRAGON,
        BUNNY,
        BUDDHA,
        DONUTS,
        BIG_SCENE,
        YEAH_RIGHT,
        DONUTS_RECT,
    ];

    #[test]
    fn every_shot_is_read_and_takes_its_size_and_map() {
        let overrides = ["size=[64,48]", "light.0.shadow_map=64"].map(|text| text.parse().unwrap());
        for subject in ALL {
            let Some(asset) = subject.asset else { continue };
            let shot = Shot::of_text(Path::new("bench.toml"), asset.shot, &overrides);
            let shot = shot.unwrap_or_else(|error| panic!("{}: {error}", subject.name));
            assert_eq!(shot.size, [64, 48]);
            assert_eq!(shot.lights.unwrap()[0].shadow_map, 64);
            assert!(shot.scene.to_string().ends_with(asset.file));
        }
    }

    #[test]
    fn without_assets_a_built_in_scene_stands_in_and_is_named() {
        let (shot_frame, what) = Subject {
            stand_in: "builtin:slats",
            ..SIBENIKTEX
        }
        .load(None, [32, 24], 64, &mut Progress::default())
        .unwrap();
        assert_eq!(
            what,
            "builtin:slats in its place, light through coloured rings"
        );
        assert_eq!(
            (shot_frame.size, shot_frame.lights[0].map_size),
            ([32, 24], [64, 64])
        );
        assert!(
            shot_frame.lights[0].texture.is_some() && shot_frame.frame.lights[0].texture.is_some()
        );
        let spot = with_far_spot(&shot_frame);
        assert!(spot.lights[0].texture.is_none() && spot.frame.lights[0].texture.is_none());
        assert!(matches!(spot.frame.lights[0].emitter, Emitter::Spot { .. }));
        assert!(spot.frame.lights[0].shadow.is_some());
    }
}
