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

/// Error of a dark pixel that is taken for lit, and a little: the most that visibility between 0 and 1 can be wrong.
const LIT: f64 = 110.0;

/// Beside each stand p99 of the scene where it is largest and the largest error that were seen in three runs of 16 to 20 cameras a scene
/// (llvmpipe of Mesa 22.3.6, 2026-12-01), many of them the same; bounds are about twice as large. They were set once these cameras had been
/// seen; 20 others a scene have tried them since, and kept to them.
const WORST: [Worst; 14] = [
    // Exact but for f32 and the airlight's tables, which show where the eye is millimetres from a lamp: 0.0133, 0.0205.
    worst("min-max", PLAIN, 0.025, 0.04),
    // Rows of sums over 512 columns a slice, in which a picture's edges and its rim are blurred: 0.032, 0.36.
    worst("min-max", PICTURE, 0.07, 1.0),
    // Points so far apart that light leaks through walls, seen from the dark behind them: 100, 100.
    worst("ivsv", PANEL, LIT, LIT),
    // Borders of shadows within steps, of which there are 512: 0.032, 0.81.
    worst("ray-march", PLAIN, 0.06, 1.7),
    // A picture's edges within steps as well: 0.22, 0.85.
    worst("ray-march", PICTURE, 0.4, 1.8),
    // As ivsv, with four times as many points: 30, 33.
    worst("ray-march", PANEL, LIT, LIT),
    // Shafts between two slices or two marched samples, which depths do not tell: 0.94.
    worst("epipolar", PLAIN, 2.0, LIT),
    worst("epipolar", PICTURE, 2.0, LIT),
    // Walls that slant between texels where features are a texel wide, as leaves; from outside a church, before a lamp: 1.5, 7.7.
    worst("light-volume", PLAIN, 3.0, 20.0),
    // Marches where there may be a shadow: as ray-march.
    worst("hybrid", PLAIN, 0.06, 1.7),
    worst("hybrid", PICTURE, 0.4, 1.8),
    // Voxels of 1/512 of the image's range, in slices as wide, are dark or lit; most seen from below the ground: 1.4, 1.0.
    worst("vsv", PLAIN, 3.0, LIT),
    worst("vsv", PICTURE, 2.0, LIT),
    // A ray takes its slice's shadow, up to half a pixel beside its own: 0.10, 2.0.
    worst("incremental", PLAIN, 0.2, 4.0),
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
