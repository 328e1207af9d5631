//! Every check of this repository by one name: `cargo xtask test`.

mod checks;
mod command;
mod driver;
mod layers;
mod results;
mod tidy;

use std::process::ExitCode;
use std::time::Instant;

/// A check: its name on the command line, what it is, and how it is run.
struct Check {
    name: &'static str,
    about: &'static str,
    run: fn() -> anyhow::Result<()>,
}

/// In the order `cargo xtask test` runs them. The tests come last, so that their summary is the last thing printed.
const CHECKS: &[Check] = &[
    Check {
        name: "tidy",
        about: "sizes and kinds of files, white space",
        run: tidy::check,
    },
    Check {
        name: "layers",
        about: "imports: none against the order in ARCHITECTURE.md, none in a circle",
        run: layers::check,
    },
    Check {
        name: "fmt",
        about: "formatting",
        run: checks::fmt,
    },
    Check {
        name: "clippy",
        about: "lints, with the GPU and without",
        run: checks::clippy,
    },
    Check {
        name: "doc",
        about: "documentation and its links",
        run: checks::doc,
    },
    Check {
        name: "package",
        about: "packages of the published crates",
        run: checks::package,
    },
    Check {
        name: "driver",
        about: "a Vulkan driver for the tests; installs Mesa's software driver where it can",
        run: driver::ensure,
    },
    Check {
        name: "examples",
        about: "the library's examples; the renderer's picture goes to target/",
        run: checks::examples,
    },
    Check {
        name: "unit",
        about: "all tests, with the shared truth shots where present",
        run: checks::unit,
    },
];

/// Part of `unit`, by itself.
const TRUTH: Check = Check {
    name: "truth",
    about: "only the shared truth shots, where present",
    run: checks::truth,
};

/// No check: it measures.
const RESULTS: Check = Check {
    name: "results",
    about: "measures the tables in results/ anew, on this machine (half an hour on a software adapter)",
    run: results::measure,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["test"] => run(CHECKS),
        [] | ["help" | "--help" | "-h"] => {
            print!("{}", help());
            ExitCode::SUCCESS
        }
        [name] => match CHECKS
            .iter()
            .chain([&TRUTH, &RESULTS])
            .find(|c| c.name == name)
        {
            Some(check) => run(std::slice::from_ref(check)),
            None => usage(),
        },
        _ => usage(),
    }
}

/// Runs checks up to the first that fails. The last one's own words are the last ones.
fn run(checks: &[Check]) -> ExitCode {
    for (i, check) in checks.iter().enumerate() {
        println!("== {}: {}", check.name, check.about);
        let start = Instant::now();
        if let Err(error) = (check.run)() {
            eprintln!("cargo xtask {}: {error:#}", check.name);
            return ExitCode::FAILURE;
        }
        if i + 1 < checks.len() {
            println!(
                "== {} took {:.1} s",
                check.name,
                start.elapsed().as_secs_f64()
            );
        }
    }
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprint!("{}", help());
    ExitCode::from(2)
}

fn help() -> String {
    let mut text =
        "usage: cargo xtask CHECK\n\n  test     every check below, in this order\n".to_owned();
    for check in CHECKS {
        text += &format!("  {:<8} {}\n", check.name, check.about);
    }
    text.push('\n');
    for task in [&TRUTH, &RESULTS] {
        text += &format!("  {:<8} {}\n", task.name, task.about);
    }
    text
}
