//! A Vulkan driver for the tests: finds one, installs Mesa's software driver, or says how to.

use crate::command::{runs, runs_quietly};
use anyhow::{Context, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What each system calls Mesa's software Vulkan driver.
const PACKAGES: &str = "\
  Debian, Ubuntu   apt-get install mesa-vulkan-drivers
  Fedora           dnf install mesa-vulkan-drivers
  Arch             pacman -S vulkan-swrast vulkan-icd-loader
  Alpine           apk add mesa-vulkan-swrast vulkan-loader";

/// What Vulkan's loader reads instead of the installed manifests.
const LOADER_VARIABLES: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

const ATTEMPTS: u32 = 3;

/// macOS has Metal and Windows has Direct3D 12 with a software adapter; elsewhere a Vulkan driver must be there.
/// Where it is not and cannot be installed, the tests decide: they skip aloud, and fail in continuous integration.
pub(crate) fn ensure() -> anyhow::Result<()> {
    if cfg!(any(target_os = "macos", target_os = "windows")) {
        println!("the system brings a driver");
        return Ok(());
    }
    if let Some(files) = LOADER_VARIABLES.iter().find_map(std::env::var_os) {
        println!("the environment chooses {}", files.display());
        return Ok(());
    }
    if let Some(manifest) = installed_manifest() {
        println!("found {}", manifest.display());
        return Ok(());
    }
    if !is_root() || !runs_quietly("apt-get", &["--version"]) {
        println!(
            "no Vulkan driver found. Tests on the GPU need one; install it as root:\n{PACKAGES}"
        );
        return Ok(());
    }
    install()?;
    let manifest = installed_manifest().context("mesa-vulkan-drivers brought no Vulkan driver")?;
    println!("installed {}", manifest.display());
    Ok(())
}

/// The manifest of a driver, where Vulkan's loader looks for it.
fn installed_manifest() -> Option<PathBuf> {
    let home = std::env::var_os("HOME").map(|home| Path::new(&home).join(".local/share"));
    let folders = ["/etc", "/usr/local/share", "/usr/share"].map(PathBuf::from);
    folders
        .into_iter()
        .chain(home)
        .find_map(|folder| first_manifest(&folder.join("vulkan/icd.d")))
}

fn first_manifest(folder: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .min()
}

fn is_root() -> bool {
    Command::new("id")
        .arg("-u")
        .output()
        .is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Package mirrors fail now and then; asking again helps.
fn install() -> anyhow::Result<()> {
    let install = [
        "install",
        "-y",
        "--no-install-recommends",
        "mesa-vulkan-drivers",
    ];
    let done = (0..ATTEMPTS).any(|_| runs("apt-get", &["update"]) && runs("apt-get", &install));
    ensure!(
        done,
        "`apt-get {}` failed {ATTEMPTS} times",
        install.join(" ")
    );
    Ok(())
}
