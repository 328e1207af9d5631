//! Holds `angle.wesl` against f64's own sine and cosine.

use tyndall_testkit::{device::device_or_skip, samples, wgsl};

use crate::shader::tests::harness;

/// Measured on lavapipe and on SwiftShader: 2.6e-7, 6.3e-8.
const BOUND: f64 = 4e-7;
const RELATIVE_BOUND: f64 = 1.5e-7;

#[test]
fn directions_are_exact() {
    let Some(gpu) = device_or_skip("angle.wesl") else {
        return;
    };
    let module = harness("import tyndall::physics::angle::angle_direction;", &[], &[]);
    let in_box = samples::in_box(3, 20_000, [-7.0_f32..=7.0, -1.0..=1.0]);
    // Any angle, and a small one.
    let inputs: Vec<_> = in_box.iter().map(|x| [x[0], x[1].powi(5)]).collect();
    let expression = "angle_direction(x[0]), angle_direction(x[1])";
    let found = wgsl::evaluate(gpu, &[&module], expression, &inputs).expect("the shader runs");
    let [mut worst, mut relative] = [0.0_f64; 2];
    for (x, found) in inputs.iter().zip(found) {
        let (sine, cosine) = f64::from(x[0]).sin_cos();
        let errors = [f64::from(found[0]) - cosine, f64::from(found[1]) - sine];
        worst = errors.iter().fold(worst, |w, e| w.max(e.abs()));
        let small = f64::from(x[1]).sin();
        relative = relative.max((f64::from(found[3]) / small - 1.0).abs());
    }
    println!("{worst:.1e}, relative {relative:.1e}");
    assert!(worst < BOUND, "{worst:.1e}");
    assert!(relative < RELATIVE_BOUND, "{relative:.1e}");
}
