//! Scene files and built-in scenes.

use tyndall_scene::{builtin, load, scene::Scene};

use crate::{
    failure::Failure,
    shot::{Origin, Problem, SceneSource, Shot},
};

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

/// Says where the shot names the scene, unless the scene itself was given.
pub(super) fn at_scene(shot: &Shot, failure: Failure) -> Failure {
    match (failure, shot.scene_location.origin) {
        (Failure::Input(error), Origin::Line(_) | Origin::Override) => {
            Failure::Input(error.context(shot.scene_location.clone()))
        }
        (failure, _) => failure,
    }
}
