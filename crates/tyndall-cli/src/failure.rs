//! Failures of the command: one message, and an exit code that scripts can tell apart.

use std::fmt;

/// Why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The shot, the scene or an output path is wrong: exit code 1.
    Input(anyhow::Error),
    /// The command line asks for what there isn't: exit code 2.
    Usage(anyhow::Error),
    /// There is no device, or it failed: exit code 3.
    Device(anyhow::Error),
}

impl Failure {
    /// An [`Failure::Input`] from any error.
    pub fn input(error: impl Into<anyhow::Error>) -> Self {
        Self::Input(error.into())
    }

    /// A [`Failure::Usage`] from any error.
    pub fn usage(error: impl Into<anyhow::Error>) -> Self {
        Self::Usage(error.into())
    }

    /// A [`Failure::Device`] from any error.
    pub fn device(error: impl Into<anyhow::Error>) -> Self {
        Self::Device(error.into())
    }

    /// A [`Failure::Usage`] for what is announced but not written.
    pub fn not_there_yet(what: &str) -> Self {
        Self::Usage(anyhow::anyhow!("{what}: not there yet"))
    }

    /// The process's exit code.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 1,
            Self::Usage(_) => 2,
            Self::Device(_) => 3,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Input(error) | Self::Usage(error) | Self::Device(error)) = self;
        write!(f, "{error:#}")
    }
}
