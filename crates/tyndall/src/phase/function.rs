//! The common shape of phase functions.

/// The most parameters of a phase function; the shaders' uniform block has room for so many.
pub const MAX_PARAMS: usize = 2;

/// A phase function's entry in the table, as plain data.
#[derive(Clone, Copy, Debug)]
pub struct PhaseInfo {
    /// Its name in shot files; the WGSL function is `phase_` and this, with underscores.
    pub name: &'static str,
    /// One line: which particles it is for.
    pub about: &'static str,
    /// Who published it.
    pub citation: &'static str,
    /// Its parameters, at most [`MAX_PARAMS`], in the order of the variant's fields.
    pub params: &'static [PhaseParam],
}

/// A parameter of a phase function.
#[derive(Clone, Copy, Debug)]
pub struct PhaseParam {
    /// Its key in shot files.
    pub key: &'static str,
    /// One line: what it does.
    pub about: &'static str,
    /// What it may be, in words.
    pub range: &'static str,
    /// Whether it may be this.
    pub allows: fn(f32) -> bool,
}

/// A phase function with its parameters.
pub trait PhaseFunction: Copy {
    /// Its entry in the table.
    const INFO: PhaseInfo;

    /// The value at cos(theta) [1/sr].
    fn evaluate(self, cos_theta: f64) -> f64;

    /// The mean of cos(theta) over the sphere, in closed form.
    fn mean_cosine(self) -> f64;
}
