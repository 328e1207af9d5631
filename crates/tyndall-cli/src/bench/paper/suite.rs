//! A paper's scenes and techniques.

use std::time::Duration;

use tyndall::techniques::{Technique, Value};

use crate::{
    bench::{subject::Subject, table::Table},
    load::ShotFrame,
    measure::{Budget, DrawnFrame},
};

/// A paper's scenes, techniques and sizes.
pub(in crate::bench) struct Paper {
    /// The techniques it compares, whether they are there or not: a name, then any parameters as `key=value`.
    pub(in crate::bench) techniques: &'static [&'static str],
    pub(in crate::bench) scenes: &'static [Subject],
    /// Width and height of the pictures \[pixels].
    pub(in crate::bench) size: [u32; 2],
    /// Errors are measured on pictures this many times smaller on each side; 1 where quality depends on the size.
    pub(in crate::bench) reduction: u32,
    /// Side of the shadow map \[texels].
    pub(in crate::bench) map: u32,
    /// Sides of shadow maps of a second table \[texels], with a far spot light in the sun's place; none: no such table.
    pub(in crate::bench) spot_maps: &'static [u32],
}

/// Value of [`Paper::reduction`] in most suites: the search for equal quality needs many pictures.
pub(in crate::bench) const REDUCTION: u32 = 4;

/// Budget of each technique's frames in one run.
pub(super) const BUDGET: Budget = Budget {
    frames: 10,
    warm_up: 1,
    time: Duration::from_secs(8),
};

/// A technique by its name and parameters, `name key=value ...`; `None` where it is not there.
pub(in crate::bench) fn contender(text: &'static str) -> Option<Technique> {
    let mut words = text.split_whitespace();
    let mut technique = Technique::from_name(words.next()?)?;
    for word in words {
        let (key, value) = word.split_once('=')?;
        let integer = value.parse().map(Value::Integer);
        let real = || value.parse().map(Value::Real);
        let value = integer
            .or_else(|_| real())
            .unwrap_or_else(|_| Value::Word(value.to_owned()));
        technique.set(key, &value).ok()?;
    }
    Some(technique)
}

/// The paper's techniques that are there, with their texts; brute force by itself where none is.
pub(super) fn techniques(paper: &Paper, drawn: &DrawnFrame<'_>) -> Vec<(&'static str, Technique)> {
    let contenders = paper.techniques.iter();
    let own: Vec<_> = contenders
        .filter_map(|text| Some((*text, contender(text)?)))
        .filter(|(_, technique)| drawn.place(technique.info()).is_some())
        .collect();
    if !own.is_empty() {
        return own;
    }
    let marches = drawn.techniques().into_iter().filter(is_march);
    marches.map(|t| (t.info().name, t)).collect()
}

pub(super) fn is_march(technique: &Technique) -> bool {
    matches!(technique, Technique::RayMarch(_))
}

/// A frame that is so many times smaller on each side.
pub(in crate::bench) fn reduced(shot_frame: &ShotFrame, reduction: u32) -> ShotFrame {
    ShotFrame {
        size: shot_frame.size.map(|side| (side / reduction).max(1)),
        ..shot_frame.clone()
    }
}

/// A table that says that there is nothing to measure.
pub(in crate::bench) fn nothing(title: &str) -> Table {
    Table {
        title: title.to_owned(),
        notes: vec!["no technique that is there can do its lights".to_owned()],
        columns: Vec::new(),
        rows: Vec::new(),
    }
}
