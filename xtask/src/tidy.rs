//! What no other tool looks at: sizes and kinds of files, and white space.

use anyhow::{Context, ensure};
use std::path::Path;
use std::process::Command;

/// Larger files make every clone slow \[bytes].
const MAX_BYTES: usize = 1 << 20;

/// Models, truths and archives, which have other licences or are made by the program.
const UNWANTED: &[&str] = &[
    "blend", "dll", "exe", "exr", "fbx", "glb", "gz", "hdr", "so", "tar", "zip",
];

pub(crate) fn check() -> anyhow::Result<()> {
    let Some(files) = files()? else {
        println!("skipped: this is no git checkout, so nothing says which files belong to it");
        return Ok(());
    };
    ensure!(!files.is_empty(), "git lists no files");
    let mut problems = Vec::new();
    for file in &files {
        // A file that git knows may have been deleted just now.
        if let Ok(bytes) = std::fs::read(file) {
            let found = problems_of(Path::new(file), &bytes);
            problems.extend(found.into_iter().map(|problem| format!("{file}{problem}")));
        }
    }
    ensure!(problems.is_empty(), "{}", problems.join("\n"));
    println!("{} files are tidy", files.len());
    Ok(())
}

/// The files that belong to the repository or may be about to; `None` outside a git checkout.
fn files() -> anyhow::Result<Option<Vec<String>>> {
    let arguments = [
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ];
    let Ok(output) = Command::new("git").args(arguments).output() else {
        return Ok(None);
    };
    if !output.status.success() {
        return Ok(None);
    }
    let text = String::from_utf8(output.stdout).context("a file's name is not UTF-8")?;
    Ok(Some(
        text.split_terminator('\0').map(str::to_owned).collect(),
    ))
}

/// What is wrong with a file, each as what follows its name: `: problem` or `:line: problem`.
fn problems_of(path: &Path, bytes: &[u8]) -> Vec<String> {
    let mut problems = Vec::new();
    if bytes.len() > MAX_BYTES {
        problems.push(format!(": {} bytes, more than {MAX_BYTES}", bytes.len()));
    }
    let ending = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    if UNWANTED.contains(&ending.as_str()) {
        problems.push(format!(": files that end in .{ending} do not belong here"));
    }
    if let Ok(text) = std::str::from_utf8(bytes) {
        problems.extend(white_space(text));
    }
    problems
}

fn white_space(text: &str) -> Vec<String> {
    let mut problems: Vec<_> = text
        .split_terminator('\n')
        .enumerate()
        .filter_map(|(i, line)| Some(format!(":{}: {}", i + 1, problem_of_line(line)?)))
        .collect();
    if !text.is_empty() && !text.ends_with('\n') {
        problems.push(": no line break at the end".to_owned());
    }
    problems
}

fn problem_of_line(line: &str) -> Option<&'static str> {
    if line.contains('\t') {
        Some("a tab")
    } else if line.ends_with('\r') {
        Some("a carriage return")
    } else if line.ends_with(' ') {
        Some("white space at the end")
    } else if line.starts_with("<<<<<<< ") || line.starts_with(">>>>>>> ") {
        Some("a conflict that was not resolved")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tidy_files_pass_and_others_are_named() {
        let cases: &[(&str, &[u8], &[&str])] = &[
            ("a.rs", b"fn main() {}\n", &[]),
            ("empty", b"", &[]),
            ("a.png", b"\x89PNG\t\xff", &[]),
            ("a.wgsl", b"fn f() {\n\treturn;\n}\n", &[":2: a tab"]),
            (
                "a.md",
                b"one \ntwo\r\n",
                &[":1: white space at the end", ":2: a carriage return"],
            ),
            ("a.toml", b"a = 1", &[": no line break at the end"]),
            (
                "a.rs",
                b"<<<<<<< main\n",
                &[":1: a conflict that was not resolved"],
            ),
            (
                "a.GLB",
                b"glTF\n",
                &[": files that end in .glb do not belong here"],
            ),
        ];
        for (name, bytes, expected) in cases {
            assert_eq!(problems_of(Path::new(name), bytes), *expected, "{name}");
        }
    }

    #[test]
    fn large_files_are_named() {
        let sized = |bytes: usize| problems_of(Path::new("a.png"), &vec![0xff; bytes]);
        assert!(sized(MAX_BYTES).is_empty());
        assert_eq!(sized(MAX_BYTES + 1), [": 1048577 bytes, more than 1048576"]);
    }
}
