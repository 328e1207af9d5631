//! Reports of suites: what all share, and their text and JSON.

use std::{
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use serde_json::{Value, json};

use super::table::Table;
use crate::{
    backend::{AdapterDescription, Backend},
    failure::Failure,
    output::write_atomically,
};

/// The backend and the folder of the papers' scenes, which all suites share.
pub(super) struct Bench {
    pub(super) backend: Backend,
    pub(super) assets: Option<PathBuf>,
}

/// The tables that a suite measured.
pub(super) struct Report {
    pub(super) tables: Vec<Table>,
    /// Names of the paper's techniques that are not there.
    pub(super) missing: Vec<&'static str>,
    /// Results that must not be, in words; the command fails where there are any.
    pub(super) faults: Vec<String>,
}

/// Machine, command and date, without which no number means anything.
pub(super) fn header(bench: &Bench) -> Vec<(&'static str, String)> {
    let adapter = match bench.backend.adapter() {
        Some(AdapterDescription { name, driver, api }) => format!("{name}, {driver}, {api}"),
        None => "none: the CPU".to_owned(),
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    // The program's own path says nothing.
    let arguments = std::env::args().skip(1);
    let command: Vec<String> = std::iter::once("tyndall".to_owned())
        .chain(arguments)
        .collect();
    let now = humantime::format_rfc3339_seconds(SystemTime::now());
    vec![
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("command", command.join(" ")),
        ("date", now.to_string()),
        ("adapter", adapter),
        ("cores", cores.to_string()),
    ]
}

/// The header, a line an entry.
pub(super) fn header_text(header: &[(&'static str, String)]) -> String {
    let lines = header.iter();
    lines
        .map(|(key, value)| format!("{key:<8} {value}\n"))
        .collect()
}

/// Writes to standard output; whoever reads may have read enough.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done.map_err(Failure::input),
    }
}

pub(super) fn write_json(
    file: &Path,
    header: &[(&'static str, String)],
    suites: Vec<Value>,
) -> Result<(), Failure> {
    let mut report: serde_json::Map<String, Value> = header
        .iter()
        .map(|(key, value)| ((*key).to_owned(), json!(value)))
        .collect();
    report.insert("suites".to_owned(), json!(suites));
    let text = format!("{:#}\n", Value::Object(report));
    write_atomically(file, text.as_bytes()).map_err(Failure::input)
}

impl Report {
    pub(super) fn to_text(&self, name: &str, about: &str, took: Duration) -> String {
        let tables = self.tables.iter().map(|table| format!("\n{table}"));
        let missing = match self.missing[..] {
            [] => String::new(),
            _ => format!("\nmissing: {}\n", self.missing.join(", ")),
        };
        format!(
            "\n== {name}: {about}\n{}{missing}\nmeasured in {:.0} s\n",
            tables.collect::<String>(),
            took.as_secs_f64()
        )
    }

    pub(super) fn to_json(&self, name: &str) -> Value {
        json!({
            "suite": name,
            "tables": self.tables.iter().map(Table::to_json).collect::<Vec<_>>(),
            "missing": self.missing,
            "faults": self.faults,
        })
    }
}
