//! The tables of measurements in `results/`.

use crate::checks::NO_DEVICE_SELECT;
use anyhow::{Context, ensure};
use std::path::Path;
use std::process::Command;

/// Suites of `tyndall bench` whose tables are kept.
const SUITES: [&str; 6] = ["chen", "yusov", "billeter", "wyman-dai", "lin", "scaling"];

/// Runs each suite and writes what it prints to `results/SUITE.txt`, which is left as it is where the suite fails.
pub(crate) fn measure() -> anyhow::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results");
    std::fs::create_dir_all(&folder).context("results/ cannot be made")?;
    for suite in SUITES {
        let text = bench(suite)?;
        let file = folder.join(format!("{suite}.txt"));
        std::fs::write(&file, text)
            .with_context(|| format!("{} cannot be written", file.display()))?;
        println!("wrote results/{suite}.txt");
    }
    Ok(())
}

/// What a suite prints. Its progress is shown.
fn bench(suite: &str) -> anyhow::Result<Vec<u8>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let (name, value) = NO_DEVICE_SELECT;
    let arguments = ["run", "--release", "--bin", "tyndall", "--", "bench", suite];
    let output = Command::new(cargo)
        .args(arguments)
        .env(name, value)
        .stderr(std::process::Stdio::inherit())
        .output()
        .context("cargo cannot be started")?;
    ensure!(
        output.status.success(),
        "`tyndall bench {suite}` failed ({})",
        output.status
    );
    Ok(output.stdout)
}
