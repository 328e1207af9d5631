//! The checks that cargo does. All of them build in the release profile, so that each shares what another built.

use crate::command::runs_quietly;
use anyhow::{Context, bail, ensure};
use std::process::Command;

/// Turns off a Vulkan layer of Mesa's that looks for a Wayland display and, where there is none, prints an error that is none.
pub(crate) const NO_DEVICE_SELECT: (&str, &str) = ("NODEVICE_SELECT", "1");

pub(crate) fn fmt() -> anyhow::Result<()> {
    ensure_component("fmt", "rustfmt")?;
    cargo(&["fmt", "--all", "--check"], &[])
}

pub(crate) fn clippy() -> anyhow::Result<()> {
    ensure_component("clippy", "clippy")?;
    let deny = ["--", "-D", "warnings"];
    let everything = ["clippy", "--release", "--workspace", "--all-targets"];
    cargo(&[&everything[..], &deny].concat(), &[])?;
    for package in ["tyndall", "tyndall-scene"] {
        let without_gpu = [
            "clippy",
            "--release",
            "--all-targets",
            "--no-default-features",
        ];
        cargo(&[&without_gpu[..], &["-p", package], &deny].concat(), &[])?;
    }
    Ok(())
}

pub(crate) fn doc() -> anyhow::Result<()> {
    doc_of(&[])
}

/// Documents the workspace, or what the arguments name.
fn doc_of(arguments: &[&str]) -> anyhow::Result<()> {
    let doc = ["doc", "--release", "--workspace", "--no-deps"];
    let deny = [("RUSTDOCFLAGS", "-D warnings")];
    cargo(&[&doc[..], arguments].concat(), &deny)
}

/// Packs the crates that are published as they would be uploaded: fails where one needs what is not published, or its manifest
/// lacks something. It builds nothing, because all of it was built by the other checks.
pub(crate) fn package() -> anyhow::Result<()> {
    package_of(&[])
}

/// Packs the workspace, or the one that the arguments name.
fn package_of(arguments: &[&str]) -> anyhow::Result<()> {
    let crates = [
        "--workspace",
        "--exclude=tyndall-testkit",
        "--exclude=tyndall-fuzz",
        "--exclude=xtask",
    ];
    // A change is checked before it is committed.
    let flags = ["--no-verify", "--allow-dirty", "--offline", "--quiet"];
    cargo(
        &[&["package"], &crates[..], &flags, arguments].concat(),
        &[],
    )
}

pub(crate) fn unit() -> anyhow::Result<()> {
    cargo(&["test", "--release", "--workspace"], &[NO_DEVICE_SELECT])
}

pub(crate) fn examples() -> anyhow::Result<()> {
    let example = |arguments: &[&str]| {
        let run = ["run", "--release", "-p", "tyndall", "--example"];
        cargo(&[&run[..], arguments].concat(), &[NO_DEVICE_SELECT])
    };
    example(&["minimal"])?;
    example(&["in_your_renderer", "--", "target/in_your_renderer.png"])
}

pub(crate) fn truth() -> anyhow::Result<()> {
    cargo(
        &["test", "--release", "-p", "tyndall-cli", "--test", "truth"],
        &[NO_DEVICE_SELECT],
    )
}

fn cargo(arguments: &[&str], variables: &[(&str, &str)]) -> anyhow::Result<()> {
    let line = format!("cargo {}", arguments.join(" "));
    println!("{line}");
    // Cargo tells what it started which cargo it is.
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(arguments)
        .envs(variables.iter().copied())
        .status()
        .with_context(|| format!("`{line}` cannot be started"))?;
    ensure!(status.success(), "`{line}` failed ({status})");
    Ok(())
}

/// Adds a component that a minimal installation of Rust lacks.
fn ensure_component(subcommand: &str, component: &str) -> anyhow::Result<()> {
    if runs_quietly("cargo", &[subcommand, "--version"]) {
        return Ok(());
    }
    println!("rustup component add {component}");
    if runs_quietly("rustup", &["component", "add", component]) {
        return Ok(());
    }
    bail!("`cargo {subcommand}` is missing, and rustup cannot add it: install {component}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Packs a crate whose manifest ends so, beside an empty one that is not published.
    fn package_with(end: &str) -> anyhow::Result<()> {
        let folder = tempfile::tempdir().unwrap();
        let head = "[workspace]\nmembers = [\"xtask\"]\n";
        write_crate(folder.path(), "a", &format!("{head}{end}"));
        write_crate(&folder.path().join("xtask"), "xtask", "publish = false\n");
        let target = folder.path().join("target");
        let paths = [folder.path().join("Cargo.toml"), target].map(|p| p.display().to_string());
        package_of(&["--manifest-path", &paths[0], "--target-dir", &paths[1]])
    }

    fn write_crate(folder: &Path, name: &str, end: &str) {
        std::fs::create_dir_all(folder.join("src")).unwrap();
        std::fs::write(folder.join("src/lib.rs"), "").unwrap();
        let package =
            format!("[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n{end}");
        std::fs::write(folder.join("Cargo.toml"), package).unwrap();
    }

    #[test]
    fn a_package_that_needs_what_is_not_published_fails() {
        package_with("[dev-dependencies]\nxtask = { path = \"xtask\" }\n").unwrap();
        let needs = "[dependencies]\nxtask = { path = \"xtask\" }\n";
        let message = package_with(needs).expect_err("it passed").to_string();
        assert!(message.contains("cargo package"), "{message}");
    }

    /// Documents a crate of one line under the lints of this workspace.
    fn doc_of_line(line: &str) -> anyhow::Result<()> {
        let folder = tempfile::tempdir().unwrap();
        let workspace = include_str!("../../Cargo.toml");
        let start = workspace.find("[workspace.lints").unwrap();
        let end = workspace.find("[profile").unwrap();
        let package = "[package]\nname = \"a\"\nedition = \"2024\"\n[lints]\nworkspace = true\n";
        let manifest = folder.path().join("Cargo.toml");
        let text = format!("{package}[workspace]\n{}", &workspace[start..end]);
        std::fs::write(&manifest, text).unwrap();
        std::fs::create_dir(folder.path().join("src")).unwrap();
        std::fs::write(folder.path().join("src/lib.rs"), line).unwrap();
        let target = folder.path().join("target");
        let paths = [&manifest, &target].map(|path| path.display().to_string());
        doc_of(&["--manifest-path", &paths[0], "--target-dir", &paths[1]])
    }

    #[test]
    fn links_that_lead_nowhere_fail() {
        doc_of_line("//! A [unit](u8), a length \\[m].\n").unwrap();
        for line in ["//! A [`Nothing`].\n", "//! A length [m].\n"] {
            let message = doc_of_line(line).expect_err(line).to_string();
            assert!(message.contains("cargo doc"), "{message}");
        }
    }
}
