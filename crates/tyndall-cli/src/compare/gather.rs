//! Measuring what a report tells.

use std::time::SystemTime;

use super::{
    report::{Comparison, Report, Row, Subject},
    settings::{Candidate, candidate, steps},
};
use crate::{
    failure::Failure,
    measure::{Budget, DrawnFrame, PictureError, Visibility, converged, error_of},
    picture::{Picture, automatic_exposure},
    progress::Progress,
};

impl Comparison {
    /// Renders the reference and every candidate, and times the candidates in turn. Those that can't do the shot are
    /// left out, and say why.
    ///
    /// # Errors
    /// [`Failure::Input`] where no candidate can do the shot, [`Failure::Device`] where the GPU fails.
    pub fn measure(
        mut subject: Subject,
        drawn: &DrawnFrame<'_>,
        candidates: &[Candidate],
        visibility: Visibility,
        progress: &mut Progress,
    ) -> Result<Self, Failure> {
        let reference = progress.run("reference", |_| drawn.reference(visibility))?;
        let floor = match visibility {
            Visibility::Traced => floor(drawn, &reference, progress)?,
            Visibility::ShadowMap => None,
        };
        let mut candidates = candidates.to_vec();
        let pictures = pictures(drawn, &mut candidates, &mut subject.left_out, progress)?;
        let techniques: Vec<_> = candidates.iter().map(|c| c.technique.clone()).collect();
        let timings = progress.run("time all, a frame of each in turn", |_| {
            drawn.time(&techniques, &Budget::default())
        })?;
        let rows = candidates
            .iter()
            .zip(&timings.techniques)
            .zip(&pictures)
            .map(|((candidate, (technique, timing)), picture)| {
                Ok(Row {
                    setting: candidate.setting.clone(),
                    timing: timing.clone(),
                    over_limit: timings.over_limit(timing),
                    errors: error_of(picture, &reference)?,
                    steps: steps(technique, drawn.shot_frame().frame.lights.len()),
                })
            })
            .collect::<Result<_, Failure>>()?;
        let report = Report {
            subject,
            size: reference.size,
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            reference: candidate(converged(visibility), None).setting,
            floor,
            limit: timings.limit,
            exposure: exposure(&reference),
            rows,
        };
        Ok(Self {
            report,
            reference,
            pictures,
        })
    }
}

/// In-scatter of each candidate; those that refuse the shot are taken from the candidates and say why.
fn pictures(
    drawn: &DrawnFrame<'_>,
    candidates: &mut Vec<Candidate>,
    left_out: &mut Vec<String>,
    progress: &mut Progress,
) -> Result<Vec<Picture>, Failure> {
    let mut pictures = Vec::new();
    let mut able = Vec::new();
    let mut refusal = None;
    for candidate in candidates.drain(..) {
        let label = candidate.setting.label();
        match progress.run(&label, |_| drawn.in_scatter(&candidate.technique)) {
            Ok(picture) => {
                pictures.push(picture);
                able.push(candidate);
            }
            Err(Failure::Input(reason)) => {
                left_out.push(format!("{label}: {reason:#}"));
                refusal = Some(Failure::Input(reason));
            }
            Err(failure) => return Err(failure),
        }
    }
    *candidates = able;
    match refusal {
        Some(failure) if pictures.is_empty() => Err(failure),
        _ => Ok(pictures),
    }
}

/// An exposure that burns out nothing but the brightest hundredth \[EV]: differences in white can't be seen.
fn exposure(picture: &Picture) -> f32 {
    /// From here on the tone mapper compresses.
    const KNEE: f32 = 0.8;
    let mut peaks: Vec<f32> = picture
        .pixels
        .iter()
        .map(|pixel| pixel.iter().copied().fold(0.0, f32::max))
        .collect();
    peaks.sort_unstable_by(f32::total_cmp);
    let highlight = peaks[(peaks.len() - 1) * 99 / 100];
    let automatic = automatic_exposure(picture);
    if highlight > 0.0 && highlight.is_finite() {
        automatic.min((KNEE / highlight).log2())
    } else {
        automatic
    }
}

/// Errors of the picture that the shadow maps converge to; `None` where a light has no map.
fn floor(
    drawn: &DrawnFrame<'_>,
    reference: &Picture,
    progress: &mut Progress,
) -> Result<Option<PictureError>, Failure> {
    let mut lights = drawn.shot_frame().frame.lights.iter();
    if !lights.all(|light| light.shadow.is_some()) {
        return Ok(None);
    }
    let picture = progress.run("converged shadow map", |_| {
        drawn.reference(Visibility::ShadowMap)
    })?;
    error_of(&picture, reference).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shafts_in_the_dark_are_not_white() {
        let picture = |values: &[f32]| Picture {
            size: [values.len() as u32, 1],
            pixels: values.iter().map(|x| [*x, 0.5 * x, 0.0]).collect(),
        };
        let shafts: Vec<f32> = (0..100).map(|i| if i < 70 { 0.0 } else { 3.0 }).collect();
        assert!((3.0 * exposure(&picture(&shafts)).exp2() - 0.8).abs() < 1e-5);
        // An even picture needs no such care.
        let even = picture(&[0.2; 100]);
        assert_eq!(exposure(&even), automatic_exposure(&even));
        let black = picture(&[0.0; 4]);
        assert_eq!(exposure(&black), 0.0);
    }
}
