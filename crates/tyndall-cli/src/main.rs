//! The `tyndall` command.

use std::process::ExitCode;

use clap::Parser;
use tyndall_cli::{args::Cli, commands::run};

fn main() -> ExitCode {
    match run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}
