//! The commands, one a file.

mod compare;
mod info;
mod render;

use crate::{
    args::{Cli, Command},
    bench,
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
        Command::Compare(args) => compare::run(&args),
        Command::Bench(args) => bench::run(
            args.suite.as_deref(),
            args.json.as_deref(),
            args.assets.as_deref(),
        ),
        Command::View(_) => Err(Failure::not_there_yet("view")),
    }
}
