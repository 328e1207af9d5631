//! The order of modules that ARCHITECTURE.md declares: no import goes up in it, and no files import each other in a circle.
//!
//! Code under `#[cfg(test)]` is excepted, as are `tests/` and `examples/`: tests may look anywhere. There is no list of
//! exceptions besides. What is read is the source as it stands, whatever features are on, down to the arguments of macros.

mod circles;
mod collect;
mod module;
mod order;
mod resolve;
mod upwards;

#[cfg(test)]
mod tests;

use anyhow::{Context, ensure};
use module::Tree;
use order::Order;
use resolve::imports;
use std::path::{Path, PathBuf};

/// Where the order is written.
const DOCUMENT: &str = "ARCHITECTURE.md";

pub(crate) fn check() -> anyhow::Result<()> {
    // Cargo tells at run time: with a shared target folder, another checkout may have built this program.
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR");
    let manifest = manifest.unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let summary = check_workspace(&Path::new(&manifest).join(".."))?;
    println!("{summary}");
    Ok(())
}

/// Checks every crate of a workspace; tells how much was looked at.
fn check_workspace(root: &Path) -> anyhow::Result<String> {
    let document = root.join(DOCUMENT);
    let text = std::fs::read_to_string(&document)
        .with_context(|| format!("{} cannot be read", document.display()))?;
    let orders = order::parse(&text).with_context(|| DOCUMENT.to_owned())?;
    let crates = crates(root)?;
    ensure!(!crates.is_empty(), "no crate in {}", root.display());
    if let Some(name) = orders.keys().find(|name| !crates.contains_key(*name)) {
        anyhow::bail!("{DOCUMENT} orders `{name}`, and there is no such crate");
    }

    let mut all = Found::default();
    for (name, folder) in &crates {
        let order = orders.get(name).with_context(|| {
            format!("{DOCUMENT} does not say the order of `{name}`: a block ```layers {name}")
        })?;
        let found = check_crate(root, folder, order).with_context(|| format!("crate {name}"))?;
        all.add(found);
    }
    let Found {
        upwards,
        circles,
        files,
        imports,
    } = all;
    ensure!(
        upwards.is_empty() && circles.is_empty(),
        "{}\n{} against the order in {DOCUMENT}, {} in a circle",
        [&upwards[..], &circles].concat().join("\n"),
        upwards.len(),
        circles.len()
    );
    ensure!(imports > 0, "no import was found, which cannot be");
    Ok(format!(
        "{} crates, {files} files, {imports} imports: none goes up, none goes round",
        crates.len()
    ))
}

/// What was found in a crate.
#[derive(Default)]
struct Found {
    /// Imports against the order, and what is wrong with the order itself.
    upwards: Vec<String>,
    circles: Vec<String>,
    files: usize,
    imports: usize,
}

impl Found {
    fn add(&mut self, other: Self) {
        self.upwards.extend(other.upwards);
        self.circles.extend(other.circles);
        self.files += other.files;
        self.imports += other.imports;
    }
}

fn check_crate(root: &Path, folder: &Path, order: &Order) -> anyhow::Result<Found> {
    let mut found = Found::default();
    let mut names = Vec::new();
    for file in ["src/lib.rs", "src/main.rs"] {
        let file = folder.join(file);
        if !file.exists() {
            continue;
        }
        let tree = Tree::load(root, &file)?;
        let imports = imports(&tree);
        names.extend(tree.top_level().map(str::to_owned));
        found.upwards.extend(upwards::problems(&imports, order));
        found.circles.extend(circles::problems(&imports));
        found.files += tree.file_count();
        found.imports += imports.len();
    }
    ensure!(found.files > 0, "neither src/lib.rs nor src/main.rs");
    found.upwards.extend(order.mismatches(&names));
    Ok(found)
}

type Crates = std::collections::BTreeMap<String, PathBuf>;

/// The crates of the workspace by name: each folder in `crates/`, and `xtask/`.
fn crates(root: &Path) -> anyhow::Result<Crates> {
    let mut folders = vec![root.join("xtask")];
    let inner = root.join("crates");
    for entry in std::fs::read_dir(&inner).with_context(|| inner.display().to_string())? {
        folders.push(entry?.path());
    }
    let is_crate = |folder: &PathBuf| folder.join("Cargo.toml").exists();
    let named = folders.into_iter().filter(is_crate).filter_map(|folder| {
        let name = folder.file_name()?.to_string_lossy().into_owned();
        Some((name, folder))
    });
    Ok(named.collect())
}
