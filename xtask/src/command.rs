//! Running other programs.

use std::process::{Command, Stdio};

/// True where the program is there, ran and succeeded. Its output is shown.
pub(crate) fn runs(program: &str, arguments: &[&str]) -> bool {
    succeeds(Command::new(program).args(arguments))
}

/// As [`runs`], with the output thrown away.
pub(crate) fn runs_quietly(program: &str, arguments: &[&str]) -> bool {
    succeeds(
        Command::new(program)
            .args(arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null()),
    )
}

fn succeeds(command: &mut Command) -> bool {
    command.status().is_ok_and(|status| status.success())
}
