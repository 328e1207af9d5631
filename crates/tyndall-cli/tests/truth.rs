//! Renders the shared truth shots, where present, with the `tyndall` command and holds its errors against bounds.
//!
//! The truths were ray traced outside this project with no shadow map, so that the error of `ray-march` is mostly its
//! shadow map's. A shot that is missing is counted as ignored.

use libtest_mimic::{Arguments, Completion, Failed, Trial};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::sync::Mutex;
use tyndall_testkit::metrics::{PictureError, compare};
use tyndall_testkit::picture::Picture;
use tyndall_testkit::truth::{self, TruthShot};
use tyndall_testkit::{device, skip};

/// The largest relMAE a shot may have.
struct Bounds {
    shot: &'static str,
    reference: f64,
    /// Of 2048 steps, and of `hybrid`, which takes the same between closed forms; `None` where the light's kind is not
    /// for them.
    ray_march: Option<f64>,
    /// `None` where the light is not for `light-volume`.
    light_volume: Option<f64>,
}

/// Beside each bound what was measured: by the reference; by `ray-march` on the CPU, and on llvmpipe (Mesa 22.3.6); by
/// `light-volume` there; November 2026.
const BOUNDS: &[Bounds] = &[
    bounds("box-point", 5e-5, Some(2e-4), Some(2e-4)), // 0.00001; 0.00006, 0.00006; 0.00006
    bounds("city-lamp", 1e-4, Some(4e-4), Some(5e-4)), // 0.00004; 0.00018, 0.00018; 0.00019
    // The truth itself has 256 samples of the light.
    bounds("donuts-rect", 0.012, None, None),      // 0.00730
    bounds("dragon-gobo", 8e-4, Some(8e-4), None), // 0.00040; 0.00038, 0.00038
    bounds("dragon-spot", 4e-4, Some(8e-4), Some(0.0012)), // 0.00017; 0.00033, 0.00038; 0.00080
    bounds("hall-sun", 0.001, Some(0.009), Some(0.008)), // 0.00050; 0.00645, 0.00643; 0.00585
    bounds("sibenik-rose", 0.001, Some(0.018), Some(0.018)), // 0.00051; 0.01182, 0.01179; 0.01432
    bounds("sibenik-sun", 0.002, Some(0.022), Some(0.018)), // 0.00106; 0.01577, 0.01577; 0.01378
    bounds("terrain-sun", 5e-5, Some(3e-4), Some(2e-4)), // 0.00002; 0.00007, 0.00011; 0.00011
];

/// The same of techniques on the GPU that move borders by voxels, or take a light as samples of their own; beside each what was
/// measured on llvmpipe (Mesa 22.3.6), November 2026.
const COARSE: &[(&str, &str, &[&str], f64)] = &[
    ("box-point", "vsv", &[], 4e-4),                // 0.00021
    ("city-lamp", "vsv", &[], 0.0012),              // 0.00060
    ("dragon-gobo", "vsv", &[], 0.003),             // 0.00165
    ("dragon-spot", "vsv", &[], 0.002),             // 0.00101
    ("hall-sun", "vsv", &[], 0.03),                 // 0.0205
    ("sibenik-rose", "vsv", &[], 0.12),             // 0.0864
    ("sibenik-sun", "vsv", &[], 0.1),               // 0.0753
    ("terrain-sun", "vsv", &[], 0.002),             // 0.00120
    ("donuts-rect", "ivsv", &[], 0.02),             // 0.0152
    ("donuts-rect", "ray-march", AREA_STEPS, 0.02), // 0.0150
];

/// Of each sample of a rectangle.
const AREA_STEPS: &[&str] = &["--set", "technique.steps=64"];

/// A shot with a rectangular light, and how far its lit surfaces by `ivsv` may be from traced ones (relMAE): 0.0739 measured on
/// llvmpipe; without shadows they are 0.196 apart.
const SURFACE_SHOT: &str = "donuts-rect";
const SURFACES_APART: f64 = 0.1;

/// How far GPU and CPU may be apart (relMAE): f32 against f64, a rasterised shadow map against a ray-cast one.
/// Measured: at most 0.00017, on sibenik-rose.
const BACKENDS_APART: f64 = 4e-4;

const STEPS: &str = "technique.steps=2048";

const fn bounds(
    shot: &'static str,
    reference: f64,
    ray_march: Option<f64>,
    light_volume: Option<f64>,
) -> Bounds {
    Bounds {
        shot,
        reference,
        ray_march,
        light_volume,
    }
}

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
    let mut trials = Vec::new();
    for bounds in BOUNDS {
        trials.push(Trial::ignorable_test(
            format!("{}::reference", bounds.shot),
            || with_shot(bounds.shot, |shot| reference(shot, bounds.reference)),
        ));
        if let Some(bound) = bounds.ray_march {
            trials.push(Trial::ignorable_test(
                format!("{}::ray_march", bounds.shot),
                move || with_shot(bounds.shot, |shot| ray_march(shot, bound)),
            ));
            trials.push(Trial::ignorable_test(
                format!("{}::hybrid", bounds.shot),
                move || {
                    with_shot(bounds.shot, |shot| {
                        on_gpu(shot, "hybrid", &["--set", STEPS], bound)
                    })
                },
            ));
        }
        if let Some(bound) = bounds.light_volume {
            trials.push(Trial::ignorable_test(
                format!("{}::light_volume", bounds.shot),
                move || with_shot(bounds.shot, |shot| on_gpu(shot, "light-volume", &[], bound)),
            ));
        }
    }
    trials.extend(COARSE.iter().map(|&(name, technique, more, bound)| {
        Trial::ignorable_test(format!("{name}::{technique}"), move || {
            with_shot(name, |shot| on_gpu(shot, technique, more, bound))
        })
    }));
    trials.push(Trial::ignorable_test(
        format!("{SURFACE_SHOT}::surface"),
        || with_shot(SURFACE_SHOT, surface),
    ));
    trials
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

fn reference(shot: &TruthShot, bound: f64) -> Result<Completion, Failed> {
    let picture = render(shot, &["--technique", "reference"])?;
    check(shot, "reference", &picture, &shot.in_scatter()?, bound)?;
    Ok(Completion::Completed)
}

fn ray_march(shot: &TruthShot, bound: f64) -> Result<Completion, Failed> {
    let truth = shot.in_scatter()?;
    let march = |backend| {
        render(
            shot,
            &[
                "--technique",
                "ray-march",
                "--set",
                STEPS,
                "--backend",
                backend,
            ],
        )
    };
    let cpu = march("cpu")?;
    check(shot, "ray-march, CPU", &cpu, &truth, bound)?;
    match device::device() {
        Ok(_) => {
            let gpu = march("gpu")?;
            check(shot, "ray-march, GPU", &gpu, &truth, bound)?;
            check(shot, "GPU against CPU", &gpu, &cpu, BACKENDS_APART)?;
            Ok(Completion::Completed)
        }
        Err(missing) if missing.is_excused() => {
            skip::skip(&format!("{} on the GPU", shot.name), &missing.to_string());
            Ok(Completion::ignored_with("right on the CPU, no GPU"))
        }
        Err(missing) => Err(missing.into()),
    }
}

fn on_gpu(
    shot: &TruthShot,
    technique: &str,
    more: &[&str],
    bound: f64,
) -> Result<Completion, Failed> {
    match device::device() {
        Ok(_) => {
            let picture = render(shot, &[&["--technique", technique], more].concat())?;
            check(shot, technique, &picture, &shot.in_scatter()?, bound)?;
            Ok(Completion::Completed)
        }
        Err(missing) if missing.is_excused() => {
            skip::skip(&format!("{} on the GPU", shot.name), &missing.to_string());
            Ok(Completion::ignored_with("no GPU"))
        }
        Err(missing) => Err(missing.into()),
    }
}

/// Surfaces shadowed by the voxels, against those that rays find.
fn surface(shot: &TruthShot) -> Result<Completion, Failed> {
    match device::device() {
        Ok(_) => {
            let lit = |arguments: &[&str]| render_layer(shot, "surface", arguments);
            let traced = lit(&["--technique", "reference"])?;
            let bare = compare(&lit(&["--technique", "ray-march"])?, &traced)?.rel_mae;
            if bare < 1.5 * SURFACES_APART {
                return Err(format!("there are no shadows to be seen: {bare}").into());
            }
            let voxels = lit(&["--technique", "ivsv"])?;
            check(shot, "ivsv, surfaces", &voxels, &traced, SURFACES_APART)?;
            Ok(Completion::Completed)
        }
        Err(missing) if missing.is_excused() => {
            skip::skip(&format!("{} on the GPU", shot.name), &missing.to_string());
            Ok(Completion::ignored_with("no GPU"))
        }
        Err(missing) => Err(missing.into()),
    }
}

/// Renders a shot's in-scattered radiance.
fn render(shot: &TruthShot, arguments: &[&str]) -> Result<Picture, Failed> {
    render_layer(shot, "inscatter", arguments)
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
        "{shot:<13} {what:<16} relMAE {rel_mae:.5} (at most {bound:.5})  bias {bias:+.5}  p99 {p99:.4}"
    )
}
