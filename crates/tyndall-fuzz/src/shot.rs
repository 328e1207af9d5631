//! Any text as a shot file, up to a rendered picture where everything it names is in the folder.

use tyndall_cli::shot::{SceneSource, Shot};

use crate::{
    folder::{folder, is_inside, render_small},
    outcome::Outcome,
};

/// Reads a shot, and renders it where that is cheap: built-in scenes take seconds to make, but for the empty one.
pub fn run(bytes: &[u8]) -> Outcome {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return Outcome::Refused;
    };
    let Ok(shot) = Shot::of_text(&folder().join("shot.toml"), text, &[]) else {
        return Outcome::Refused;
    };
    let is_cheap = match &shot.scene {
        SceneSource::File(file) => is_inside(file),
        SceneSource::Builtin(name) => name == "empty",
    };
    let mut textures = shot
        .lights
        .iter()
        .flatten()
        .filter_map(|light| light.texture.as_ref());
    if is_cheap && textures.all(|texture| is_inside(&texture.file)) {
        render_small(shot)
    } else {
        Outcome::Refused
    }
}
