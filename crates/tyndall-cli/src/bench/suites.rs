//! The suites: each has a paper's tables, or tables of our own.

use std::{path::Path, time::Instant};

use tyndall::techniques::Technique;

use super::{
    billeter, lin,
    paper::{self, Paper},
    poses,
    report::{Bench, Report, header, header_text, print, write_json},
    scaling,
    subject::{self, find_assets},
    wyman_dai, yusov,
};
use crate::{
    backend::{Backend, BackendChoice},
    failure::Failure,
    output::check_folder,
    progress::Progress,
};

/// The tables of a suite.
enum Tables {
    Paper(Paper),
    LightVolumes(billeter::LightVolumes),
    Epipolar(yusov::Epipolar),
    Films(lin::Films),
    AreaLights(wyman_dai::AreaLights),
    Scaling,
    Poses(poses::Poses),
}

/// Tables that belong together.
pub(super) struct Suite {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    tables: Tables,
}

const PICTURE: [u32; 2] = [1280, 960];

pub(super) const SUITES: [Suite; 7] = [
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
        about: "every technique from random places: its errors, and the worst that it states",
        tables: Tables::Poses(poses::Poses {
            poses: 20,
            size: [160, 120],
        }),
    },
];

/// The suites' names, in the order they run.
pub(crate) fn suite_names() -> Vec<&'static str> {
    SUITES.iter().map(|suite| suite.name).collect()
}

/// Measures one suite, or all, and writes the numbers as JSON where a file is given. `assets` is the folder of the papers'
/// scenes; left out, it is looked for.
///
/// # Errors
/// [`Failure`] where there is nothing to write to, a scene is broken, or the device fails.
pub(crate) fn run(
    suite: Option<&str>,
    json: Option<&Path>,
    assets: Option<&Path>,
) -> Result<(), Failure> {
    if let Some(file) = json {
        check_folder(file).map_err(Failure::input)?;
    }
    let bench = Bench {
        backend: Backend::choose(BackendChoice::Auto, &[Technique::default().info()])?,
        assets: assets.map(Path::to_owned).or_else(find_assets),
    };
    let header = header(&bench);
    print(&header_text(&header))?;
    let (mut suites, mut faults) = (Vec::new(), Vec::new());
    let chosen = |known: &&Suite| suite.is_none_or(|name| name == known.name);
    for suite in SUITES.iter().filter(chosen) {
        let (start, mut progress) = (Instant::now(), Progress::default());
        let report = suite.tables.measure(&bench, &mut progress)?;
        print(&report.to_text(suite.name, suite.about, start.elapsed()))?;
        suites.push(report.to_json(suite.name));
        faults.extend(report.faults);
    }
    if let Some(file) = json {
        write_json(file, &header, suites)?;
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(Failure::Input(anyhow::anyhow!("{}", faults.join("\n"))))
    }
}

impl Tables {
    fn measure(&self, bench: &Bench, progress: &mut Progress) -> Result<Report, Failure> {
        match self {
            Self::Paper(paper) => paper::run(paper, bench, progress),
            Self::LightVolumes(suite) => billeter::run(suite, bench, progress),
            Self::Epipolar(suite) => yusov::run(suite, bench, progress),
            Self::Films(films) => lin::run(films, bench, progress),
            Self::AreaLights(suite) => wyman_dai::run(suite, bench, progress),
            Self::Scaling => scaling::run(bench, progress),
            Self::Poses(suite) => poses::run(suite, bench, progress),
        }
    }
}
