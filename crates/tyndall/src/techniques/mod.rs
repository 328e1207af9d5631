//! The techniques, and the one table of them.

pub mod ray_march;
pub mod reference;

/// A technique and its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Technique {
    /// Quadrature in f64 to a stated tolerance.
    Reference(reference::Params),
    /// Brute force.
    RayMarch(ray_march::Params),
}

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
}

/// Why a parameter was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
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

/// Which backends a technique runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backends {
    /// CPU only.
    Cpu,
    /// GPU only.
    Gpu,
    /// Both.
    Both,
}

/// A technique's entry in the table.
pub struct TechniqueInfo {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// One line: what it is.
    pub about: &'static str,
    /// Where it was published.
    pub citation: &'static str,
    /// The kinds of light it can do, by name: directional, point, spot, rect.
    pub lights: &'static [&'static str],
    /// Where it runs.
    pub backends: Backends,
    /// The technique with its default parameters.
    pub default: fn() -> Technique,
}

/// Every technique, in the order they are listed to people.
pub const TABLE: &[TechniqueInfo] = &[];

impl Technique {
    /// The technique of this name with default parameters.
    pub fn from_name(name: &str) -> Option<Self> {
        TABLE.iter().find(|t| t.name == name).map(|t| (t.default)())
    }

    /// Its entry in the [`TABLE`].
    pub fn info(&self) -> &'static TechniqueInfo {
        unimplemented!()
    }

    /// Its parameters as they are now, with what each may be.
    pub fn params(&self) -> Vec<(ParamInfo, Value)> {
        unimplemented!()
    }

    /// Sets one parameter.
    ///
    /// # Errors
    /// Where there is no such key or the value is not of its range.
    pub fn set(&mut self, key: &str, value: &Value) -> Result<(), ParamError> {
        let _ = (key, value);
        unimplemented!()
    }
}
