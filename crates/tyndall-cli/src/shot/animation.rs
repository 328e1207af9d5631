//! `[temporal]` and `[animation]`: what only sequences use.

use std::{fmt, str::FromStr};

use super::{
    error::{Location, ShotError, one_of},
    reader::{Field, Section},
    tree::Value,
};

/// Reuse of earlier frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temporal {
    /// Frames that a value is reused for (>= 1); `None`: any number.
    pub reuse: Option<u32>,
    /// The search for pixels that have to be computed again.
    pub mask: TemporalMask,
    /// Relative error that pixels may be kept with while the camera moves (0 < x <= 1); `None`: none are kept then.
    pub reproject: Option<f32>,
    /// Content of the picture's in-scattered light.
    pub show: TemporalShow,
}

/// The search for pixels that have to be computed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TemporalMask {
    /// From what changed in depth buffer and shadow maps.
    Change,
    /// From the shadow volumes of what moves.
    Geometry,
}

/// Content of the picture's in-scattered light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TemporalShow {
    /// The light.
    Light,
    /// The pixels that were computed.
    Mask,
    /// Frames since each pixel was computed.
    Age,
}

/// Movement, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Frames a second (> 0).
    pub fps: f32,
    /// The frames that keyframes are spread over; `None`: those that are rendered.
    pub frames: Option<FrameRange>,
    /// The movements.
    pub moves: Vec<Move>,
}

impl Default for Animation {
    /// Nothing but what the scene's own animations move.
    fn default() -> Self {
        Self {
            fps: DEFAULT_FPS,
            frames: None,
            moves: Vec::new(),
        }
    }
}

/// A movement; keyframes are spread evenly over the frame range, with straight lines between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// The thing that moves.
    pub target: MoveTarget,
    /// The place where the shot names the thing.
    pub location: Location,
    /// Offsets from where it stands \[m].
    pub translate: Vec<[f32; 3]>,
    /// Rotations about x, then y, then z, through where it stands \[degrees].
    pub rotate_deg: Vec<[f32; 3]>,
    /// Factors of the medium's coefficients (>= 0).
    pub density: Vec<f32>,
}

/// The target of a [`Move`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MoveTarget {
    /// Every node of this name, along its parent's axes.
    Node(String),
    /// The camera, along the world's axes.
    Camera,
    /// The light of this index, with its texture, along the world's axes.
    Light(usize),
    /// The medium, which fills all space and can only change its density.
    Medium,
}

/// Frames from the first to the last, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// The first frame.
    pub first: u32,
    /// The last frame (>= `first`).
    pub last: u32,
}

impl FrameRange {
    /// Its frames in order.
    pub fn frames(self) -> std::ops::RangeInclusive<u32> {
        self.first..=self.last
    }

    /// Position of a frame in the range, from 0 at the first to 1 at the last; frames outside are taken to its ends.
    pub fn progress(self, frame: u32) -> f32 {
        let done = f64::from(frame.clamp(self.first, self.last) - self.first);
        (done / f64::from((self.last - self.first).max(1))) as f32
    }
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once("..").and_then(|(first, last)| {
            let (first, last) = (first.parse().ok()?, last.parse().ok()?);
            (first <= last).then_some(Self { first, last })
        });
        numbers.ok_or_else(|| format!("expected {FRAMES}, found {text:?}"))
    }
}

impl fmt::Display for FrameRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.first, self.last)
    }
}

/// The most frames that `temporal.reuse` may span.
const MAX_REUSE: u32 = 64;
const DEFAULT_REUSE: u32 = 3;
const UNLIMITED: &str = "unlimited";
const MASKS: [(&str, TemporalMask); 2] = [
    ("change", TemporalMask::Change),
    ("geometry", TemporalMask::Geometry),
];
const SHOWS: [(&str, TemporalShow); 3] = [
    ("light", TemporalShow::Light),
    ("mask", TemporalShow::Mask),
    ("age", TemporalShow::Age),
];
const DEFAULT_FPS: f32 = 30.0;
const FRAMES: &str = "the first and the last frame as A..B, two whole numbers with A <= B";
const TARGET: &str = "a node's name, camera, medium, or a light such as light.0";

/// Reads `[temporal]`.
pub(super) fn read_temporal(field: &Field<'_>) -> Result<Temporal, ShotError> {
    let section = field.section()?;
    section.only(&["reuse", "mask", "reproject", "show"])?;
    let share = |field: Field<'_>| field.real("a number in (0, 1]", |x| x > 0.0 && x <= 1.0);
    Ok(Temporal {
        reuse: match section.get("reuse") {
            Some(field) => read_reuse(&field)?,
            None => Some(DEFAULT_REUSE),
        },
        mask: choice(&section, "mask", &MASKS)?,
        reproject: section.get("reproject").map(share).transpose()?,
        show: choice(&section, "show", &SHOWS)?,
    })
}

fn read_reuse(field: &Field<'_>) -> Result<Option<u32>, ShotError> {
    if matches!(field.value(), Value::Text(word) if word == UNLIMITED) {
        return Ok(None);
    }
    let expected = format!("a whole number from 1 to {MAX_REUSE}, or \"{UNLIMITED}\"");
    let number = field.whole(1..=MAX_REUSE);
    number.map(Some).map_err(|_| field.unexpected(expected))
}

/// The value of a word; the first where the key is left out.
fn choice<T: Copy>(
    section: &Section<'_>,
    key: &str,
    choices: &[(&'static str, T)],
) -> Result<T, ShotError> {
    let Some(field) = section.get(key) else {
        return Ok(choices[0].1);
    };
    let words: Vec<&str> = choices.iter().map(|(word, _)| *word).collect();
    let expected = one_of(&words);
    let found = field.text(&expected)?;
    let choice = choices.iter().find(|(word, _)| *word == found);
    choice
        .map(|(_, value)| *value)
        .ok_or_else(|| field.unexpected(expected))
}

/// Reads `[animation]`.
pub(super) fn read_animation(field: &Field<'_>) -> Result<Animation, ShotError> {
    let section = field.section()?;
    section.only(&["fps", "frames", "move"])?;
    let expected = "a number > 0";
    let fps = section
        .require("fps", expected)?
        .real(expected, |x| x > 0.0)?;
    let moves = match section.get("move") {
        None => Vec::new(),
        Some(list) => list
            .list("a list of tables: [[animation.move]]")?
            .iter()
            .map(read_move)
            .collect::<Result<_, _>>()?,
    };
    let frames = section.get("frames").map(|field| read_frames(&field));
    Ok(Animation {
        fps,
        frames: frames.transpose()?,
        moves,
    })
}

fn read_frames(field: &Field<'_>) -> Result<FrameRange, ShotError> {
    let expected = format!("{FRAMES}, in quotes");
    let text = field.text(&expected)?;
    text.parse().map_err(|_| field.unexpected(expected))
}

fn read_move(field: &Field<'_>) -> Result<Move, ShotError> {
    let section = field.section()?;
    let node = section.require("node", TARGET)?;
    let target = target(&node)?;
    if target == MoveTarget::Medium {
        section.only(&["node", "density"])?;
    } else {
        section.only(&["node", "translate", "rotate_deg"])?;
    }
    let parsed = Move {
        location: node.location(),
        translate: keyframes(&section, "translate")?,
        rotate_deg: keyframes(&section, "rotate_deg")?,
        density: densities(&section)?,
        target,
    };
    if parsed.target == MoveTarget::Medium {
        section.require("density", DENSITY)?;
    } else if parsed.translate.is_empty() && parsed.rotate_deg.is_empty() {
        section.require("translate", "translate or rotate_deg, a list of keyframes")?;
    }
    Ok(parsed)
}

fn target(field: &Field<'_>) -> Result<MoveTarget, ShotError> {
    Ok(match field.text(TARGET)? {
        "camera" => MoveTarget::Camera,
        "medium" => MoveTarget::Medium,
        name => {
            let index = name.strip_prefix("light.").map(str::parse);
            match index {
                Some(Ok(index)) => MoveTarget::Light(index),
                Some(Err(_)) | None => MoveTarget::Node(name.to_owned()),
            }
        }
    })
}

const DENSITY: &str = "a list of keyframes, a number >= 0 each";

fn densities(section: &Section<'_>) -> Result<Vec<f32>, ShotError> {
    let Some(field) = section.get("density") else {
        return Ok(Vec::new());
    };
    let items = field.list(DENSITY)?;
    if items.is_empty() {
        return Err(field.unexpected(DENSITY));
    }
    let density = |item: &Field<'_>| item.real("a number >= 0", |x| x >= 0.0);
    items.iter().map(density).collect()
}

fn keyframes(section: &Section<'_>, key: &str) -> Result<Vec<[f32; 3]>, ShotError> {
    let Some(field) = section.get(key) else {
        return Ok(Vec::new());
    };
    let expected = "a list of keyframes, three finite numbers each";
    let items = field.list(expected)?;
    if items.is_empty() {
        return Err(field.unexpected(expected));
    }
    items
        .iter()
        .map(|item| item.vec3("three finite numbers", |_| true))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_ranges_hold_both_ends() {
        let range: FrameRange = "3..7".parse().unwrap();
        assert_eq!(range.frames().collect::<Vec<_>>(), [3, 4, 5, 6, 7]);
        for (frame, progress) in [(0, 0.0), (3, 0.0), (5, 0.5), (7, 1.0), (9, 1.0)] {
            assert_eq!(range.progress(frame), progress, "{frame}");
        }
        assert_eq!("4..4".parse::<FrameRange>().unwrap().progress(4), 0.0);
        for text in ["", "3", "7..3", "a..b", "-1..3", "1..2..3"] {
            let error = text.parse::<FrameRange>().unwrap_err();
            assert!(error.contains(&format!("found {text:?}")), "{error}");
        }
    }
}
