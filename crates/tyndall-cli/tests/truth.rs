//! Renders the shared truth shots, where present, with the `tyndall` command and holds its errors against bounds.
//!
//! The truths were ray traced outside this project with no shadow map, so that the error of `ray-march` is mostly its
//! shadow map's. A shot that is missing is counted as ignored.

use libtest_mimic::{Arguments, Completion, Failed, Trial};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::sync::Mutex;
use tyndall::techniques::TABLE;
use tyndall_testkit::metrics::{PictureError, compare};
use tyndall_testkit::picture::Picture;
use tyndall_testkit::truth::{self, TruthShot};
use tyndall_testkit::{device, skip};

/// Where a technique runs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Backend {
    Cpu,
    Gpu,
    /// One after the other, and held against each other.
    Both,
}

/// A technique, and the largest relMAE each shot may have by it.
struct Held {
    technique: &'static str,
    backend: Backend,
    settings: &'static [&'static str],
    bounds: &'static [(&'static str, f64)],
}

/// Every technique in the order of the library's table, the default first. Beside each bound stands the measured error: of `Cpu`
/// on the CPU, of `Gpu` on llvmpipe (Mesa 22.3.6), of `Both` in that order; 28 November 2026.
const HELD: &[Held] = &[
    Held {
        technique: "min-max",
        backend: Backend::Gpu,
        settings: &[],
        bounds: &[
            ("box-point", 1.2e-4),   // 0.00006
            ("city-lamp", 3.6e-4),   // 0.00018
            ("dragon-gobo", 0.005),  // 0.00282
            ("dragon-spot", 7e-4),   // 0.00036
            ("hall-sun", 0.009),     // 0.00595
            ("sibenik-rose", 0.017), // 0.01062
            ("sibenik-sun", 0.02),   // 0.01287
            ("terrain-sun", 2.2e-4), // 0.00011
        ],
    },
    Held {
        technique: "min-max",
        backend: Backend::Cpu,
        settings: &[],
        bounds: &[
            ("box-point", 1.2e-4),   // 0.00006
            ("city-lamp", 3.6e-4),   // 0.00018
            ("dragon-gobo", 7e-4),   // 0.00035
            ("dragon-spot", 6e-4),   // 0.00030
            ("hall-sun", 0.009),     // 0.00597
            ("sibenik-rose", 0.017), // 0.01064
            ("sibenik-sun", 0.02),   // 0.01286
            ("terrain-sun", 1.4e-4), // 0.00007
        ],
    },
    Held {
        technique: "ivsv",
        backend: Backend::Gpu,
        settings: &[],
        bounds: &[
            ("donuts-rect", 0.02), // 0.01520
        ],
    },
    Held {
        technique: "ray-march",
        backend: Backend::Both,
        settings: STEPS,
        bounds: &[
            ("box-point", 2e-4),     // 0.00006, 0.00006
            ("city-lamp", 4e-4),     // 0.00018, 0.00018
            ("dragon-gobo", 8e-4),   // 0.00038, 0.00038
            ("dragon-spot", 8e-4),   // 0.00033, 0.00038
            ("hall-sun", 0.009),     // 0.00645, 0.00643
            ("sibenik-rose", 0.018), // 0.01182, 0.01179
            ("sibenik-sun", 0.022),  // 0.01577, 0.01577
            ("terrain-sun", 3e-4),   // 0.00007, 0.00011
        ],
    },
    Held {
        technique: "ray-march",
        backend: Backend::Gpu,
        settings: AREA_STEPS,
        bounds: &[
            ("donuts-rect", 0.02), // 0.01503
        ],
    },
    Held {
        technique: "epipolar",
        backend: Backend::Gpu,
        settings: &[],
        bounds: &[
            ("box-point", 4e-4),    // 0.00020
            ("city-lamp", 0.0035),  // 0.00192
            ("dragon-gobo", 0.01),  // 0.00609
            ("dragon-spot", 0.005), // 0.00277
            ("hall-sun", 0.03),     // 0.02248
            ("sibenik-rose", 0.06), // 0.05398
            ("sibenik-sun", 0.04),  // 0.02269
            ("terrain-sun", 0.002), // 0.00113
        ],
    },
    Held {
        technique: "light-volume",
        backend: Backend::Gpu,
        settings: &[],
        bounds: &[
            ("box-point", 2e-4),     // 0.00006
            ("city-lamp", 5e-4),     // 0.00019
            ("dragon-spot", 8e-4),   // 0.00040
            ("hall-sun", 0.008),     // 0.00585
            ("sibenik-rose", 0.018), // 0.01432
            ("sibenik-sun", 0.018),  // 0.01378
            ("terrain-sun", 2e-4),   // 0.00011
        ],
    },
    Held {
        technique: "hybrid",
        backend: Backend::Gpu,
        settings: STEPS,
        bounds: &[
            ("box-point", 2e-4),     // 0.00006
            ("city-lamp", 4e-4),     // 0.00019
            ("dragon-gobo", 8e-4),   // 0.00038
            ("dragon-spot", 8e-4),   // 0.00038
            ("hall-sun", 0.009),     // 0.00643
            ("sibenik-rose", 0.018), // 0.01179
            ("sibenik-sun", 0.022),  // 0.01577
            ("terrain-sun", 3e-4),   // 0.00011
        ],
    },
    Held {
        technique: "vsv",
        backend: Backend::Gpu,
        settings: &[],
        bounds: &[
            ("box-point", 4e-4),    // 0.00020
            ("city-lamp", 0.0012),  // 0.00058
            ("dragon-gobo", 0.003), // 0.00170
            ("dragon-spot", 0.002), // 0.00097
            ("hall-sun", 0.03),     // 0.02051
            ("sibenik-rose", 0.12), // 0.08636
            ("sibenik-sun", 0.1),   // 0.07531
            ("terrain-sun", 0.002), // 0.00123
        ],
    },
    Held {
        technique: "incremental",
        backend: Backend::Cpu,
        settings: &[],
        bounds: &[
            ("box-point", 0.001),   // 0.00061
            ("city-lamp", 0.001),   // 0.00060
            ("hall-sun", 0.014),    // 0.00911
            ("sibenik-sun", 0.022), // 0.01498
            ("terrain-sun", 0.005), // 0.00303
        ],
    },
    Held {
        technique: "reference",
        backend: Backend::Cpu,
        settings: &[],
        bounds: &[
            ("box-point", 5e-5), // 0.00001
            ("city-lamp", 1e-4), // 0.00004
            // The truth itself has 256 samples of the light.
            ("donuts-rect", 0.012),  // 0.00730
            ("dragon-gobo", 5e-4),   // 0.00028
            ("dragon-spot", 4e-4),   // 0.00017
            ("hall-sun", 0.001),     // 0.00050
            ("sibenik-rose", 0.001), // 0.00051
            ("sibenik-sun", 0.002),  // 0.00106
            ("terrain-sun", 5e-5),   // 0.00002
        ],
    },
];

/// Fine enough that the shadow map's error is what is left of brute force, and of `hybrid`, which takes these steps between
/// closed forms.
const STEPS: &[&str] = &["--set", "technique.steps=2048"];

/// Of each sample of a rectangle.
const AREA_STEPS: &[&str] = &["--set", "technique.steps=64"];

/// A shot with a rectangular light, and how far its lit surfaces by `ivsv` may be from traced ones (relMAE): 0.0739 measured on
/// llvmpipe; without shadows they are 0.196 apart.
const SURFACE_SHOT: &str = "donuts-rect";
const SURFACES_APART: f64 = 0.1;

/// How far GPU and CPU may be apart (relMAE): f32 against f64, a rasterised shadow map against a ray-cast one.
/// Measured: at most 0.00017, on sibenik-rose.
const BACKENDS_APART: f64 = 4e-4;

/// What was measured, printed once all is done.
static ROWS: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    // Each render uses all cores by itself.
    arguments.test_threads = arguments.test_threads.or(Some(1));
    let conclusion = libtest_mimic::run(&arguments, trials());
    if let Ok(rows) = ROWS.lock() {
        rows.iter().for_each(|row| println!("{row}"));
    }
    conclusion.exit_code()
}

fn trials() -> Vec<Trial> {
    let mut trials = vec![
        Trial::test("every_technique_has_a_trial", every_technique_has_a_trial),
        Trial::test("a_missing_technique_is_named", a_missing_technique_is_named),
    ];
    for held in HELD {
        trials.extend(held.bounds.iter().map(|&(shot, bound)| {
            Trial::ignorable_test(held.name_of(shot), move || {
                with_shot(shot, |shot| held.run(shot, bound))
            })
        }));
    }
    trials.push(Trial::ignorable_test(
        format!("{SURFACE_SHOT}::surface"),
        || with_shot(SURFACE_SHOT, surface),
    ));
    trials
}

/// A technique that nothing holds against the truth could be wrong unseen.
fn every_technique_has_a_trial() -> Result<(), Failed> {
    let names: Vec<&str> = TABLE.iter().map(|info| info.name).collect();
    match untried(&names, HELD)[..] {
        [] => Ok(()),
        ref missing => Err(format!("no trial holds {}", missing.join(", ")).into()),
    }
}

fn a_missing_technique_is_named() -> Result<(), Failed> {
    let one = Held {
        technique: "a",
        backend: Backend::Cpu,
        settings: &[],
        bounds: &[("shot", 0.0)],
    };
    let none = Held {
        technique: "b",
        bounds: &[],
        ..one
    };
    match untried(&["a", "b", "c"], &[one, none])[..] {
        ["b", "c"] => Ok(()),
        ref found => Err(format!("expected b and c, found {found:?}").into()),
    }
}

/// The techniques of these names that are held on no shot.
fn untried<'a>(names: &[&'a str], held: &[Held]) -> Vec<&'a str> {
    let is_tried = |name: &str| {
        let mut of_name = held.iter().filter(|held| held.technique == name);
        of_name.any(|held| !held.bounds.is_empty())
    };
    let names = names.iter().copied();
    names.filter(|name| !is_tried(name)).collect()
}

impl Held {
    /// `shot::technique`, followed by the backend where there is a choice of it.
    fn name_of(&self, shot: &str) -> String {
        let of_name = HELD.iter().filter(|held| held.technique == self.technique);
        let mut backends = of_name.map(|held| held.backend);
        let technique = self.technique.replace('-', "_");
        match self.backend {
            Backend::Cpu if backends.any(|backend| backend != Backend::Cpu) => {
                format!("{shot}::{technique}_on_the_cpu")
            }
            _ => format!("{shot}::{technique}"),
        }
    }

    fn run(&self, shot: &TruthShot, bound: f64) -> Result<Completion, Failed> {
        match self.backend {
            Backend::Cpu => self.on_cpu(shot, bound).map(|_| Completion::Completed),
            Backend::Gpu => with_gpu(shot, || self.on_gpu(shot, bound).map(|_| ())),
            Backend::Both => {
                let cpu = self.on_cpu(shot, bound)?;
                with_gpu(shot, || {
                    let gpu = self.on_gpu(shot, bound)?;
                    check(shot, "GPU against CPU", &gpu, &cpu, BACKENDS_APART)
                })
            }
        }
    }

    fn on_cpu(&self, shot: &TruthShot, bound: f64) -> Result<Picture, Failed> {
        self.render(shot, "cpu", bound)
    }

    fn on_gpu(&self, shot: &TruthShot, bound: f64) -> Result<Picture, Failed> {
        self.render(shot, "gpu", bound)
    }

    /// Renders the shot and holds it against the truth.
    fn render(&self, shot: &TruthShot, backend: &str, bound: f64) -> Result<Picture, Failed> {
        let arguments = ["--technique", self.technique, "--backend", backend];
        let picture = render_layer(shot, "inscatter", &[&arguments, self.settings].concat())?;
        let what = format!("{}, {}", self.technique, backend.to_uppercase());
        check(shot, &what, &picture, &shot.in_scatter()?, bound)?;
        Ok(picture)
    }
}

/// Runs a test on the GPU; ignored where there is none and none has to be.
fn with_gpu(
    shot: &TruthShot,
    test: impl FnOnce() -> Result<(), Failed>,
) -> Result<Completion, Failed> {
    match device::device() {
        Ok(_) => test().map(|()| Completion::Completed),
        Err(missing) if missing.is_excused() => {
            skip::skip(&format!("{} on the GPU", shot.name), &missing.to_string());
            Ok(Completion::ignored_with("no GPU"))
        }
        Err(missing) => Err(missing.into()),
    }
}

/// Finds the shot and runs its test; ignored where the shared folder is missing, failed where only the shot is.
fn with_shot(
    name: &str,
    test: impl FnOnce(&TruthShot) -> Result<Completion, Failed>,
) -> Result<Completion, Failed> {
    let Some(folder) = truth::folder() else {
        let why = "the shared truth shots are not here";
        skip::skip(name, why);
        return Ok(Completion::ignored_with(why));
    };
    let shots = truth::shots(&folder)?;
    let shot = shots.iter().find(|shot| shot.name == name);
    test(shot.ok_or_else(|| format!("no shot `{name}` in {}", folder.display()))?)
}

/// Surfaces shadowed by the voxels, against those that rays find.
fn surface(shot: &TruthShot) -> Result<Completion, Failed> {
    with_gpu(shot, || {
        let lit = |arguments: &[&str]| render_layer(shot, "surface", arguments);
        let traced = lit(&["--technique", "reference"])?;
        let bare = compare(&lit(&["--technique", "ray-march"])?, &traced)?.rel_mae;
        if bare < 1.5 * SURFACES_APART {
            return Err(format!("there are no shadows to be seen: {bare}").into());
        }
        let voxels = lit(&["--technique", "ivsv"])?;
        check(shot, "ivsv, surfaces", &voxels, &traced, SURFACES_APART)
    })
}

/// Renders a layer of a shot.
fn render_layer(shot: &TruthShot, layer: &str, arguments: &[&str]) -> Result<Picture, Failed> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("in-scatter.exr");
    let output = tyndall(&shot.shot, &out, layer, arguments).output()?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr);
        return Err(format!("tyndall failed ({}): {message}", output.status).into());
    }
    Ok(Picture::read_exr(&out)?)
}

fn tyndall(shot: &Path, out: &Path, layer: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tyndall"));
    command.arg("render").arg(shot).arg("-o").arg(out);
    command.args(["--layer", layer]).args(arguments);
    command
}

fn check(
    shot: &TruthShot,
    what: &str,
    picture: &Picture,
    truth: &Picture,
    bound: f64,
) -> Result<(), Failed> {
    let error = compare(picture, truth)?;
    let row = row(&shot.name, what, &error, bound);
    if let Ok(mut rows) = ROWS.lock() {
        rows.push(row.clone());
    }
    if error.rel_mae <= bound {
        Ok(())
    } else {
        Err(row.into())
    }
}

fn row(shot: &str, what: &str, error: &PictureError, bound: f64) -> String {
    let PictureError {
        rel_mae, p99, bias, ..
    } = error;
    format!(
        "{shot:<13} {what:<17} relMAE {rel_mae:.5} (at most {bound:.5})  bias {bias:+.5}  p99 {p99:.4}"
    )
}
