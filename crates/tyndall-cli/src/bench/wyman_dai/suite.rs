//! The suite's scenes and sizes, its lights, and the paper's stages.

use std::time::Duration;

use glam::Vec3;
use tyndall::{
    frame::{Emitter, Light},
    techniques::{Technique, Value},
};

use crate::{
    bench::subject::{Subject, sphere},
    failure::Failure,
    load::ShotFrame,
    measure::{Budget, Timing},
};

/// Scenes, sizes and numbers of samples.
pub(in crate::bench) struct AreaLights {
    /// The scene of table 1 comes first.
    pub(in crate::bench) scenes: &'static [Subject],
    /// Width and height of the pictures \[pixels].
    pub(in crate::bench) size: [u32; 2],
    /// Samples of the light, table by table row; the last is that of the other tables.
    pub(in crate::bench) samples: &'static [u32],
}

/// Texels a side of a sample's map, and voxels of its grid.
pub(super) const RESOLUTION: u32 = 128;

pub(super) const BUDGET: Budget = Budget {
    frames: 5,
    warm_up: 1,
    time: Duration::from_secs(15),
};

/// The paper's stages, and the passes of each.
pub(super) const STAGES: [(&str, &[&str]); 4] = [
    ("maps", &["splat points", "pull-push"]),
    ("voxels", &["voxelize"]),
    ("scan", &["scan"]),
    ("gather", &["gather", "resolve"]),
];

/// `ivsv` by its gather, all samples at once or one by one.
pub(super) fn ivsv(gather: &str, batched: bool) -> Result<Technique, Failure> {
    let params = [
        ("gather", Value::Word(gather.to_owned())),
        ("batched", Value::Bool(batched)),
    ];
    technique("ivsv", &params)
}

/// A technique with parameters.
pub(super) fn technique(name: &str, params: &[(&str, Value)]) -> Result<Technique, Failure> {
    let missing = || Failure::Input(anyhow::anyhow!("there is no technique {name}"));
    let mut technique = Technique::from_name(name).ok_or_else(missing)?;
    for (key, value) in params {
        technique.set(key, value).map_err(Failure::input)?;
    }
    Ok(technique)
}

/// The scene with its first light a rectangle of so many samples: its own, or a panel above it.
pub(super) fn with_samples(mut shot_frame: ShotFrame, count: u32) -> ShotFrame {
    let (center, radius) = sphere(&shot_frame);
    let above = center + 1.1 * radius * Vec3::Y;
    let Some(Light {
        emitter, shadow, ..
    }) = shot_frame.frame.lights.first_mut()
    else {
        return shot_frame;
    };
    if let Emitter::Rect { samples, .. } = emitter {
        *samples = count;
        return shot_frame;
    }
    *shadow = None;
    *emitter = Emitter::Rect {
        center: above.to_array(),
        edge_x: [0.6 * radius, 0.0, 0.0],
        edge_y: [0.0, 0.0, 0.4 * radius],
        radiance: [12.0, 11.0, 9.0],
        samples: count,
    };
    shot_frame.frame.lights.truncate(1);
    shot_frame.lights.truncate(1);
    for light in &mut shot_frame.lights {
        light.map_size = [RESOLUTION; 2];
    }
    shot_frame
}

/// Median of the passes of a stage \[ms].
pub(super) fn of_stage(timing: &Timing, passes: &[&str]) -> f64 {
    let is_of = |name: &str| passes.iter().any(|pass| name.starts_with(pass));
    let of_stage = timing.passes.iter().filter(|(name, _)| is_of(name));
    of_stage.map(|(_, spread)| spread.median).sum()
}
