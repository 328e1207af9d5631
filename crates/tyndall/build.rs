//! Lists the shader package: every `.wesl` file under `src`, by its module path.

use std::{
    fmt::Write as _,
    fs, io,
    path::{Path, PathBuf},
};

fn main() -> io::Result<()> {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR")?).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files)?;
    files.sort();
    let mut list = String::from("&[\n");
    for file in &files {
        let path = file.with_extension("");
        let path = path.strip_prefix(&root).map_err(io::Error::other)?;
        let names: Vec<_> = path.iter().map(|name| name.to_string_lossy()).collect();
        let _ = writeln!(
            list,
            "    (\"tyndall::{}\", include_str!({file:?})),",
            names.join("::")
        );
    }
    list.push(']');
    let out = PathBuf::from(variable("OUT_DIR")?);
    fs::write(out.join("shader_modules.rs"), list)
}

fn variable(name: &str) -> io::Result<String> {
    std::env::var(name).map_err(io::Error::other)
}

/// Finds the files, and has Cargo watch the folders for new ones.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path
            .extension()
            .is_some_and(|extension| extension == "wesl")
        {
            files.push(path);
        }
    }
    Ok(())
}
