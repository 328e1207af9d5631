//! The suite's scenes, sizes and frames, and a shot as a film.

use tyndall::temporal::{Reuse, ReuseMask};

use crate::{
    backend::Backend,
    bench::{
        report::Bench,
        subject::{self, Subject},
    },
    failure::Failure,
    load::LoadedShot,
    measure::Film,
    progress::Progress,
    shot::FrameRange,
};

/// Scenes, sizes and numbers of frames.
pub(in crate::bench) struct Films {
    pub(in crate::bench) scenes: &'static [(Subject, &'static str)],
    /// Width and height of the picture \[pixels], and the side of the shadow map \[texels].
    pub(in crate::bench) size: [u32; 2],
    pub(in crate::bench) map: u32,
    /// Frames that are timed.
    pub(in crate::bench) timed: u32,
    /// Width and height of pictures that are compared pixel by pixel \[pixels], and how many.
    pub(in crate::bench) compared_size: [u32; 2],
    pub(in crate::bench) compared: u32,
}

/// The thesis's scenes, and its frames a second with reuse over those without.
pub(in crate::bench) const SCENES: &[(Subject, &str)] = &[
    (subject::DRAGON, "1.31"),
    (subject::BUNNY, "1.34"),
    (subject::BUDDHA, "1.41"),
    (subject::DONUTS, "0.95"),
    (subject::BIG_SCENE, "1.10"),
    (subject::YEAH_RIGHT, "1.10"),
];

/// The shots' frames.
pub(super) const FRAMES: FrameRange = FrameRange { first: 0, last: 59 };
/// Frames in a row that the thesis keeps.
pub(super) const KEPT: u32 = 3;
/// Reuse with this mask and limit.
pub(super) fn reuse(mask: ReuseMask, frames: Option<u32>) -> Option<Reuse> {
    Some(Reuse {
        mask,
        frames,
        ..Reuse::default()
    })
}

/// The shot of a scene as a film, with these values set, and what it is of. A scene that is missing doesn't move: another one
/// stands in.
pub(super) fn film<'a>(
    scene: &Subject,
    values: &[&str],
    size: [u32; 2],
    map: u32,
    takes: &[Option<Reuse>],
    bench: &'a Bench,
) -> Result<Option<(Film<'a>, String)>, Failure> {
    let Backend::Gpu(gpu) = &bench.backend else {
        return Ok(None);
    };
    let assets = bench.assets.as_deref();
    let (mut shot, mut what) = scene.shot_with(values, assets, size, map)?;
    if shot.animation.is_none() {
        (shot, what) = subject::YEAH_RIGHT.shot_with(values, assets, size, map)?;
        what += " in its place";
    }
    let loaded = LoadedShot::moving(&shot, FRAMES, &mut Progress::quiet())?;
    Ok(Some((Film::new(loaded, takes, gpu)?, what)))
}
