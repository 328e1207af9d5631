//! Droplets of fog and clouds: a fit to Mie's theory.

use std::ops::RangeInclusive;

use super::table::Phase;

/// Diameters that the fit is made for \[um].
pub const DIAMETERS: RangeInclusive<f32> = 5.0..=50.0;

/// The phase function of water droplets of this diameter \[um] as two phase functions and their shares, which add up to 1: a
/// wide [`Draine`](Phase::Draine) lobe and a narrow [`HenyeyGreenstein`](Phase::HenyeyGreenstein) peak. `None` outside of
/// [`DIAMETERS`].
///
/// Jendersie & d'Eon, An Approximate Mie Scattering Function for Fog and Cloud Rendering, SIGGRAPH 2023 Talks (equations 4
/// to 7). The fit is for a distribution of sizes about the diameter and for visible light; bows and glories are smoothed out.
pub fn droplets(diameter: f32) -> Option<[(f64, Phase); 2]> {
    if !DIAMETERS.contains(&diameter) {
        return None;
    }
    let d = f64::from(diameter);
    let g_hg = (-0.0990567 / (d - 1.67154)).exp();
    let g_draine = (-2.20679 / (d + 3.91029) - 0.428934).exp();
    let alpha = (3.62489 - 8.29288 / (d + 5.52825)).exp();
    let share = (-0.599085 / (d - 0.641583) - 0.665888).exp();
    let lobe = Phase::Draine {
        g: g_draine as f32,
        alpha: alpha as f32,
    };
    let peak = Phase::HenyeyGreenstein { g: g_hg as f32 };
    Some([(share, lobe), (1.0 - share, peak)])
}
