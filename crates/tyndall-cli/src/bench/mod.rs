//! `tyndall bench`: the papers' tables, measured on this machine.
//!
//! A suite runs the techniques of its paper that are in the table of techniques, and lists the others as missing.
//! Every ratio is one of two times of one run, frame by frame in turn.

mod billeter;
mod fit;
mod lin;
mod paper;
mod poses;
mod scaling;
mod subject;
mod table;
#[cfg(test)]
mod tests;
mod wyman_dai;
mod yusov;

use std::{
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
    time::{Duration, Instant, SystemTime},
};

use serde_json::{Value, json};
use tyndall::techniques::Technique;

use crate::{
    args::{BackendChoice, BenchArgs},
    failure::Failure,
    output::{check_folder, write_atomically},
    progress::Stages,
    render::{AdapterDescription, Backend},
};
use paper::Paper;
use table::Table;

/// What a suite measures.
enum Tables {
    Paper(Paper),
    LightVolumes(billeter::LightVolumes),
    Epipolar(yusov::Epipolar),
    Films(lin::Films),
    AreaLights(wyman_dai::AreaLights),
    Scaling,
    Poses,
}

/// Tables that belong together.
struct Suite {
    name: &'static str,
    about: &'static str,
    tables: Tables,
}

const PICTURE: [u32; 2] = [1280, 960];

const SUITES: [Suite; 7] = [
    Suite {
        name: "chen",
        about: "Chen et al. 2011, tables 1 and 2",
        tables: Tables::Paper(Paper {
            techniques: &["min-max", "incremental", "light-volume"],
            scenes: &[
                subject::SIBENIK,
                subject::SIBENIKTEX,
                subject::TREES,
                subject::TERRAIN,
            ],
            size: PICTURE,
            reduction: paper::REDUCTION,
            map: 4096,
            spot_maps: &[1024, 2048, 4096],
        }),
    },
    Suite {
        name: "wyman-dai",
        about: "Wyman and Dai 2013, tables 1 and 2: samples of an area light one by one and all at once",
        tables: Tables::AreaLights(wyman_dai::AreaLights {
            scenes: &[
                subject::DONUTS_RECT,
                subject::HAIRBALL,
                subject::ANGEL_RECT,
                subject::CITY_RECT,
            ],
            size: [320, 240],
            samples: &[1, 4, 16, 64, 256],
        }),
    },
    Suite {
        name: "yusov",
        about: "Yusov 2012, section 9",
        tables: Tables::Epipolar(yusov::Epipolar {
            paper: Paper {
                techniques: &[
                    "epipolar",
                    "epipolar initial_step=4 threshold=0.01",
                    "epipolar slices=0 samples=0 initial_step=4 threshold=0.01",
                ],
                scenes: &[subject::TERRAIN, subject::SIBENIK],
                size: PICTURE,
                reduction: 1,
                map: 1024,
                spot_maps: &[],
            },
            maps: &[1024, 2048, 4096],
        }),
    },
    Suite {
        name: "billeter",
        about: "Billeter et al. 2010: polygonal light volumes, by mesh and shadow map",
        tables: Tables::LightVolumes(billeter::LightVolumes {
            scene: subject::SIBENIK,
            size: [1280, 1024],
            maps: &[1024, 2048],
        }),
    },
    Suite {
        name: "lin",
        about: "Lin 2012, table 6.1: temporal reuse",
        tables: Tables::Films(lin::Films {
            scenes: lin::SCENES,
            size: [640, 480],
            map: 1024,
            timed: 12,
            compared_size: [320, 240],
            compared: 60,
        }),
    },
    Suite {
        name: "scaling",
        about: "time and bytes against pixels, texels, triangles and each technique's own fineness",
        tables: Tables::Scaling,
    },
    Suite {
        name: "poses",
        about: "min-max and epipolar from random places: their largest errors beside brute force's",
        tables: Tables::Poses,
    },
];

/// What all suites share.
struct Bench {
    backend: Backend,
    assets: Option<PathBuf>,
}

/// What a suite measured.
struct Report {
    tables: Vec<Table>,
    /// Names of the paper's techniques that are not there.
    missing: Vec<&'static str>,
}

/// The suites' names, in the order they run.
pub(crate) fn suite_names() -> Vec<&'static str> {
    SUITES.iter().map(|suite| suite.name).collect()
}

/// Measures one suite, or all.
///
/// # Errors
/// [`Failure`] where there is nothing to write to, a scene is broken, or the device fails.
pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    if let Some(file) = &args.json {
        check_folder(file).map_err(Failure::input)?;
    }
    let bench = Bench {
        backend: Backend::choose(BackendChoice::Auto, Technique::default().info())?,
        assets: args.assets.clone().or_else(subject::find_assets),
    };
    let header = header(&bench);
    print(
        &header
            .iter()
            .map(|(key, value)| format!("{key:<8} {value}\n"))
            .collect::<String>(),
    )?;
    let mut suites = Vec::new();
    let chosen = |suite: &&Suite| args.suite.as_deref().is_none_or(|name| name == suite.name);
    for suite in SUITES.iter().filter(chosen) {
        let (start, mut stages) = (Instant::now(), Stages::default());
        let report = match &suite.tables {
            Tables::Paper(paper) => paper::run(paper, &bench, &mut stages)?,
            Tables::LightVolumes(suite) => billeter::run(suite, &bench, &mut stages)?,
            Tables::Epipolar(suite) => yusov::run(suite, &bench, &mut stages)?,
            Tables::Films(films) => lin::run(films, &bench, &mut stages)?,
            Tables::AreaLights(suite) => wyman_dai::run(suite, &bench, &mut stages)?,
            Tables::Scaling => scaling::run(&bench, &mut stages)?,
            Tables::Poses => poses::run(poses::POSES, &bench, &mut stages)?,
        };
        print(&report.to_text(suite, start.elapsed()))?;
        suites.push(report.to_json(suite));
    }
    match &args.json {
        Some(file) => write_json(file, &header, suites),
        None => Ok(()),
    }
}

/// What must be known to read any number: on what, by what, when.
fn header(bench: &Bench) -> Vec<(&'static str, String)> {
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

/// Whoever reads may have read enough.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done.map_err(Failure::input),
    }
}

fn write_json(
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
    fn to_text(&self, suite: &Suite, took: Duration) -> String {
        let tables = self.tables.iter().map(|table| format!("\n{table}"));
        let missing = match self.missing[..] {
            [] => String::new(),
            _ => format!("\nmissing: {}\n", self.missing.join(", ")),
        };
        format!(
            "\n== {}: {}\n{}{missing}\nmeasured in {:.0} s\n",
            suite.name,
            suite.about,
            tables.collect::<String>(),
            took.as_secs_f64()
        )
    }

    fn to_json(&self, suite: &Suite) -> Value {
        json!({
            "suite": suite.name,
            "tables": self.tables.iter().map(Table::to_json).collect::<Vec<_>>(),
            "missing": self.missing,
        })
    }
}
