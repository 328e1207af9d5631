//! The commands, one a file.

mod info;
mod render;

use crate::{
    args::{Cli, Command},
    failure::Failure,
};

/// Does what the command line says.
///
/// # Errors
/// [`Failure`], with the process's exit code.
pub fn run(cli: Cli) -> Result<(), Failure> {
    match cli.command {
        Command::Render(args) => render::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Compare(_) => Err(Failure::not_there_yet("compare")),
        Command::Bench(_) => Err(Failure::not_there_yet("bench")),
        Command::View(_) => Err(Failure::not_there_yet("view")),
    }
}
