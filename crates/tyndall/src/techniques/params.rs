//! Parameters that files and command lines set by name.

use std::{marker::PhantomData, ops::RangeInclusive};

use super::info::TechniqueInfo;
use crate::epipolar::Resolution;

/// A parameter's value, as a file or a command line gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A whole number.
    Integer(i64),
    /// A real number; whole numbers are taken for reals too.
    Real(f64),
    /// A word.
    Word(String),
    /// Yes or no.
    Bool(bool),
}

impl Value {
    /// The whole number, if it is one within the range.
    pub(crate) fn integer(&self, range: RangeInclusive<u32>) -> Option<u32> {
        match self {
            Self::Integer(n) => u32::try_from(*n).ok().filter(|n| range.contains(n)),
            _ => None,
        }
    }

    /// The number, if it is one within the range.
    pub(crate) fn real(&self, range: RangeInclusive<f64>) -> Option<f64> {
        match self {
            Self::Integer(n) => Some(*n as f64),
            Self::Real(x) => Some(*x),
            _ => None,
        }
        .filter(|x| range.contains(x))
    }

    /// Yes or no, if it is that.
    pub(crate) fn bool(&self) -> Option<bool> {
        match self {
            Self::Bool(b) => Some(*b),
            _ => None,
        }
    }

    /// What stands beside the word in the list.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        match self {
            Self::Word(word) => choices.iter().find(|(name, _)| name == word).map(|c| c.1),
            _ => None,
        }
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Integer(n) => write!(f, "{n}"),
            Self::Real(x) => write!(f, "{x}"),
            Self::Word(word) => write!(f, "\"{word}\""),
            Self::Bool(b) => write!(f, "{b}"),
        }
    }
}

/// The word that stands beside a value in the list.
pub(crate) fn word<T: PartialEq>(value: &T, choices: &[(&str, T)]) -> Value {
    let name = choices
        .iter()
        .find(|(_, v)| v == value)
        .map_or("", |(name, _)| name);
    Value::Word(name.to_owned())
}

/// What a parameter is called, means and may be.
#[derive(Clone, Debug, PartialEq)]
pub struct ParamInfo {
    /// Its key in `[technique]`.
    pub key: &'static str,
    /// One line: what it does, with its unit.
    pub about: &'static str,
    /// What it may be, in words.
    pub range: &'static str,
    /// Its default.
    pub default: Value,
    /// What it is now.
    pub value: Value,
}

/// Why a parameter was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ParamError {
    /// The technique has no such parameter.
    #[error("technique `{technique}` has no parameter `{key}`; it has {known}")]
    Unknown {
        /// The technique.
        technique: &'static str,
        /// The key that was given.
        key: String,
        /// The keys there are, joined by commas.
        known: String,
    },
    /// The value is not of the range.
    #[error("`{key}` must be {expected}, found {found}")]
    OutOfRange {
        /// The parameter.
        key: String,
        /// What it may be.
        expected: &'static str,
        /// What was given.
        found: String,
    },
}

/// One parameter of the parameters `P`.
pub(crate) struct Param<P> {
    pub(crate) key: &'static str,
    pub(crate) about: &'static str,
    pub(crate) range: &'static str,
    pub(crate) get: fn(&P) -> Value,
    /// Takes a value, or leaves the parameters as they are and says `None`.
    pub(crate) set: fn(&mut P, &Value) -> Option<()>,
}

/// The [`Param`] of the field of its name, by what kind of value it takes, which values, and one line about it.
macro_rules! param {
    (whole $field:ident, $low:literal..=$high:literal, $about:literal) => {
        $crate::techniques::params::param!(
            whole $field,
            $low..=$high,
            $about,
            concat!("a whole number from ", $low, " to ", $high),
            |_| true
        )
    };
    // Some whole numbers of a range, in words.
    (whole $field:ident, $low:literal..=$high:literal, $about:literal, $range:expr, $allowed:expr) => {
        $crate::techniques::params::Param {
            key: stringify!($field),
            about: $about,
            range: $range,
            get: |p| $crate::techniques::params::Value::Integer(p.$field.into()),
            set: |p, v| {
                p.$field = v.integer($low..=$high).filter($allowed)?;
                Some(())
            },
        }
    };
    (real $field:ident, $low:literal..=$high:literal, $about:literal) => {
        $crate::techniques::params::Param {
            key: stringify!($field),
            about: $about,
            range: concat!("a number from ", $low, " to ", $high),
            get: |p| $crate::techniques::params::Value::Real(p.$field),
            set: |p, v| {
                p.$field = v.real($low as f64..=$high as f64)?;
                Some(())
            },
        }
    };
    (flag $field:ident, $about:literal) => {
        $crate::techniques::params::Param {
            key: stringify!($field),
            about: $about,
            range: "true or false",
            get: |p| $crate::techniques::params::Value::Bool(p.$field),
            set: |p, v| {
                p.$field = v.bool()?;
                Some(())
            },
        }
    };
    // One of a list of words, which are named again.
    (choice $field:ident, $choices:ident, $about:literal, $range:literal) => {
        $crate::techniques::params::Param {
            key: stringify!($field),
            about: $about,
            range: $range,
            get: |p| $crate::techniques::params::word(&p.$field, $choices),
            set: |p, v| {
                p.$field = v.choice($choices)?;
                Some(())
            },
        }
    };
}
pub(crate) use param;

/// The parameters of a technique.
pub(crate) trait Parameters: Default + Sized + 'static {
    /// The technique's entry in the table.
    const INFO: TechniqueInfo;
    /// All of them, in groups that techniques may share.
    const PARAMS: &'static [&'static [Param<Self>]];

    fn all() -> impl Iterator<Item = &'static Param<Self>> {
        Self::PARAMS.iter().copied().flatten()
    }

    fn list(&self) -> Vec<ParamInfo> {
        let default = Self::default();
        let info = |p: &Param<Self>| ParamInfo {
            key: p.key,
            about: p.about,
            range: p.range,
            default: (p.get)(&default),
            value: (p.get)(self),
        };
        Self::all().map(info).collect()
    }

    fn set(&mut self, key: &str, value: &Value) -> Result<(), ParamError> {
        let Some(param) = Self::all().find(|p| p.key == key) else {
            let keys: Vec<_> = Self::all().map(|p| p.key).collect();
            return Err(ParamError::Unknown {
                technique: Self::INFO.name,
                key: key.to_owned(),
                known: keys.join(", "),
            });
        };
        (param.set)(self, value).ok_or_else(|| ParamError::OutOfRange {
            key: key.to_owned(),
            expected: param.range,
            found: value.to_string(),
        })
    }
}

/// Parameters of techniques that work in epipolar slices.
pub(crate) struct Slicing<P>(PhantomData<P>);

/// Parameters that hold a [`Resolution`].
pub(crate) trait Sliced {
    /// What `slices` and `samples` mean.
    const SLICES: &'static str;
    const SAMPLES: &'static str;

    fn resolution(&self) -> &Resolution;
    fn resolution_mut(&mut self) -> &mut Resolution;
}

impl<P: Sliced + 'static> Slicing<P> {
    pub(crate) const PARAMS: &'static [Param<P>] = &[
        Param {
            key: "slices",
            about: P::SLICES,
            range: "a whole number from 0 to 16384",
            get: |p| Value::Integer(p.resolution().slices.into()),
            set: |p, v| {
                p.resolution_mut().slices = v.integer(0..=16384)?;
                Some(())
            },
        },
        Param {
            key: "samples",
            about: P::SAMPLES,
            range: "a whole number from 0 to 16384",
            get: |p| Value::Integer(p.resolution().samples.into()),
            set: |p, v| {
                p.resolution_mut().samples = v.integer(0..=16384)?;
                Some(())
            },
        },
        Param {
            key: "epipole_radius",
            about: "rays this near to the axis are walked through the shadow map [pixels]",
            range: "a number from 0 to 100",
            get: |p| Value::Real(p.resolution().epipole_radius),
            set: |p, v| {
                p.resolution_mut().epipole_radius = v.real(0.0..=100.0)?;
                Some(())
            },
        },
    ];
}
