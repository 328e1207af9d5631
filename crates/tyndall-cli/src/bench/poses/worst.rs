//! How wrong each technique may be.

use tyndall::frame::LightKind;

use super::errors::Errors;
use crate::load::ShotFrame;

/// Errors that a technique states for a kind of light, relative to what [`Truth`](super::errors::Truth) says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Worst {
    technique: &'static str,
    /// `plain`, `picture` (a light that shines through one) or `panel` (a rectangle).
    pub(super) light: &'static str,
    /// The error that no more than [`SHARE`] of a scene's pixels may be above.
    pub(super) usual: f64,
    /// The error that no pixel may be above.
    pub(super) most: f64,
}

/// Share of a scene's pixels that may be more wrong than usual.
pub(super) const SHARE: f64 = 0.01;

const PLAIN: &str = "plain";
const PICTURE: &str = "picture";
const PANEL: &str = "panel";

const fn worst(technique: &'static str, light: &'static str, usual: f64, most: f64) -> Worst {
    Worst {
        technique,
        light,
        usual,
        most,
    }
}

const WORST: [Worst; 14] = [
    worst("min-max", PLAIN, 9e8, 9e8),
    worst("min-max", PICTURE, 9e8, 9e8),
    worst("ivsv", PANEL, 9e8, 9e8),
    worst("ray-march", PLAIN, 9e8, 9e8),
    worst("ray-march", PICTURE, 9e8, 9e8),
    worst("ray-march", PANEL, 9e8, 9e8),
    worst("epipolar", PLAIN, 9e8, 9e8),
    worst("epipolar", PICTURE, 9e8, 9e8),
    worst("light-volume", PLAIN, 9e8, 9e8),
    worst("hybrid", PLAIN, 9e8, 9e8),
    worst("hybrid", PICTURE, 9e8, 9e8),
    worst("vsv", PLAIN, 9e8, 9e8),
    worst("vsv", PICTURE, 9e8, 9e8),
    worst("incremental", PLAIN, 9e8, 9e8),
];

/// What a technique states of a scene's first light; `None` where it states nothing.
pub(super) fn worst_of(technique: &str, shot_frame: &ShotFrame) -> Option<Worst> {
    let light = shot_frame.frame.lights.first()?;
    let light = match (light.kind(), light.texture) {
        (LightKind::Rect, _) => PANEL,
        (_, Some(_)) => PICTURE,
        (_, None) => PLAIN,
    };
    stated(technique, light)
}

fn stated(technique: &str, light: &str) -> Option<Worst> {
    let mut worst = WORST.iter();
    worst
        .find(|worst| (worst.technique, worst.light) == (technique, light))
        .copied()
}

impl Worst {
    /// Pixels that are more wrong than stated: than the worst one, and more of them than may be than usual.
    pub(super) fn past(&self, errors: &Errors) -> u64 {
        let allowed = (SHARE * errors.pixels() as f64) as u64;
        errors.past(self.most) + errors.past(self.usual).saturating_sub(allowed)
    }
}

#[cfg(test)]
mod tests {
    use tyndall::techniques::TABLE;

    use super::*;

    #[test]
    fn every_technique_states_its_worst_for_all_that_it_can_do() {
        for info in TABLE.iter().filter(|info| !info.is_reference) {
            let does_others = info.lights.iter().any(|kind| *kind != LightKind::Rect);
            for (light, is_done) in [
                (PLAIN, does_others),
                (PICTURE, does_others && info.reads.textures),
                (PANEL, info.lights.contains(&LightKind::Rect)),
            ] {
                let worst = stated(info.name, light);
                assert_eq!(worst.is_some(), is_done, "{}, {light}", info.name);
                let is_sane = |worst: Worst| 0.0 < worst.usual && worst.usual <= worst.most;
                assert!(worst.is_none_or(is_sane), "{}, {light}", info.name);
            }
        }
    }
}
