//! A folder of this process, with what inputs may refer to and nothing else.

use std::{
    fs,
    path::{Component, Path},
    sync::OnceLock,
};

use tempfile::TempDir;
use tyndall_cli::{
    layer::Layer,
    load::LoadedShot,
    progress::Progress,
    render::render,
    shot::{FrameRange, Shot},
};

use crate::outcome::Outcome;

/// A triangle's floor and a lamp, that shots name `floor.gltf`.
const FLOOR: &str = include_str!("floor.gltf");

/// The most pixels a side that are rendered, and texels of a shadow map.
const SIDE: u32 = 8;

/// The folder, which holds `floor.gltf` and `window.png`.
pub(crate) fn folder() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER
        .get_or_init(|| {
            let folder = tempfile::tempdir().expect("a folder for temporary files");
            let window = image::RgbImage::from_fn(4, 2, |x, y| {
                image::Rgb([60 * x as u8, 90, 255 * y as u8])
            });
            window
                .save(folder.path().join("window.png"))
                .expect("a picture can be written");
            fs::write(folder.path().join("floor.gltf"), FLOOR).expect("a file can be written");
            folder
        })
        .path()
}

/// True for files of the folder itself: no input may read what else there is.
pub(crate) fn is_inside(file: &Path) -> bool {
    file.strip_prefix(folder()).is_ok_and(|rest| {
        rest.components()
            .all(|part| matches!(part, Component::Normal(_)))
    })
}

/// Writes a file of the folder, loads the input from it, and leaves no trace.
pub(crate) fn with_file<T>(name: &str, bytes: &[u8], load: impl FnOnce(&Path) -> T) -> T {
    let file = folder().join(name);
    fs::write(&file, bytes).expect("a file can be written");
    load(&file)
}

/// A shot's first frame on the CPU, small, with everything that is loaded for it.
pub(crate) fn render_small(mut shot: Shot) -> Outcome {
    shot.size = shot.size.map(|side| side.min(SIDE));
    let mut progress = Progress::quiet();
    let loaded = match shot.animation.as_ref().and_then(|a| a.frames) {
        None if shot.animation.is_none() => LoadedShot::at_rest(&shot, &mut progress),
        frames => {
            let range = frames.unwrap_or(FrameRange { first: 0, last: 9 });
            LoadedShot::moving(&shot, range, &mut progress)
        }
    };
    let Ok(mut loaded) = loaded else {
        return Outcome::Refused;
    };
    let Ok(mut frame) = loaded.frame(loaded.range().last) else {
        return Outcome::Refused;
    };
    for light in &mut frame.lights {
        light.map_size = light.map_size.map(|side| side.min(SIDE));
    }
    let layers = [
        Layer::Final,
        Layer::Inscatter,
        Layer::Transmittance,
        Layer::Surface,
        Layer::Depth,
    ];
    let backend = tyndall_cli::backend::Backend::Cpu;
    let Ok(rendered) = render(&frame, &backend, &layers, &mut progress) else {
        return Outcome::Refused;
    };
    for (layer, picture) in &rendered.layers {
        for value in picture.pixels.as_flattened() {
            assert!(
                value.is_finite(),
                "{} must be finite, found {value}",
                layer.name()
            );
        }
    }
    Outcome::Computed
}
