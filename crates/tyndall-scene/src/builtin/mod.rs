//! Scenes made by code: nothing to download, the same triangles everywhere.
//!
//! Each has a camera and a sun among its nodes, placed so that shafts of light are plain to see.

mod builder;
mod church;
mod city;
mod forest;
mod glass;
mod hairball;
mod moving;
mod noise;
mod slats;
mod terrain;
mod triangles;

use glam::{Vec3, vec3};

use crate::scene::Scene;
use builder::SceneBuilder;

/// A scene made by code.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name; files and the command line write `builtin:` before it.
    pub name: &'static str,
    /// A description of one line.
    pub about: &'static str,
    make: fn() -> Scene,
}

impl Builtin {
    /// Makes the scene, named `builtin:...`; the same one each time.
    pub fn make(&self) -> Scene {
        Scene {
            name: format!("builtin:{}", self.name),
            ..(self.make)()
        }
    }
}

/// All of them, in the order they are listed to people.
pub const BUILTINS: &[Builtin] = &[
    Builtin {
        name: "church",
        about: "a nave with columns and aisles; the sun through clear and stained glass",
        make: church::make,
    },
    Builtin {
        name: "forest",
        about: "a path under trees with half a million leaf triangles; a low sun through the crowns",
        make: forest::make,
    },
    Builtin {
        name: "terrain",
        about: "10 km of mountains; ridges throw shadows into the haze of the valleys",
        make: terrain::make,
    },
    Builtin {
        name: "slats",
        about: "a room behind a window blind: many thin shafts",
        make: slats::make,
    },
    Builtin {
        name: "hairball",
        about: "a ball of thousands of thin tubes over a floor",
        make: hairball::make,
    },
    Builtin {
        name: "sponge",
        about: "Menger's sponge on a floor: a thousand tunnels",
        make: moving::sponge,
    },
    Builtin {
        name: "crowd",
        about: "a sponge and two dozen rings: much that can be moved",
        make: moving::crowd,
    },
    Builtin {
        name: "city",
        about: "streets between towers: long shafts, and roofs for a light to hang over",
        make: city::make,
    },
    Builtin {
        name: "empty",
        about: "no surfaces: a sun and a camera in the medium",
        make: empty,
    },
];

/// The built-in scene of this name (without `builtin:`).
pub fn builtin(name: &str) -> Option<Scene> {
    BUILTINS
        .iter()
        .find(|builtin| builtin.name == name)
        .map(Builtin::make)
}

fn empty() -> Scene {
    let mut builder = SceneBuilder::default();
    builder.camera(Vec3::ZERO, vec3(0.0, 0.3, -1.0), 55.0, [0.1, 100.0]);
    builder.sun(vec3(-0.4, -0.7, 0.6), [10.0, 9.5, 9.0]);
    builder.finish()
}
