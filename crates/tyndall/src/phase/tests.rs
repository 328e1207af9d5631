use std::f64::consts::PI;

use super::{
    cornette_shanks::phase_cornette_shanks, draine::phase_draine, droplets::droplets,
    henyey_greenstein::phase_hg, rayleigh::phase_rayleigh, *,
};

/// Every function of the table with values out of a list that its parameters allow, in all combinations.
fn all() -> Vec<Phase> {
    const VALUES: [f32; 8] = [-0.8, 0.0, 0.3, 0.76, 0.95, 1.0, 5.0, 30.0];
    let allowed = |param: Option<&PhaseParam>| match param {
        Some(param) => VALUES.into_iter().filter(|v| (param.allows)(*v)).collect(),
        None => vec![0.0],
    };
    let mut phases = Vec::new();
    for info in TABLE {
        let [first, second] = [0, 1].map(|i| allowed(info.params.get(i)));
        for a in first {
            for b in &second {
                phases.extend(Phase::from_name(info.name, [a, *b]));
            }
        }
    }
    phases
}

#[test]
fn names_and_numbers_lead_back() {
    assert_eq!(TABLE.len(), 5);
    for (number, info) in TABLE.iter().enumerate() {
        assert!(info.params.len() <= MAX_PARAMS, "{}", info.name);
        let phase = Phase::from_name(info.name, [0.25, 0.75]).expect("a name of the table");
        assert_eq!(phase.info().name, info.name);
        assert_eq!(phase.number() as usize, number);
        let expected = [0.25, 0.75].map(Some);
        for (i, value) in phase.values().into_iter().enumerate() {
            let is_used = i < info.params.len();
            assert_eq!(Some(value), if is_used { expected[i] } else { Some(0.0) });
        }
        assert_eq!(Phase::from_name(info.name, phase.values()), Some(phase));
    }
    assert_eq!(Phase::from_name("mie", [0.0; 2]), None);
    let draine = Phase::Draine { g: 0.5, alpha: 2.0 };
    let params: Vec<_> = draine.params().map(|(p, value)| (p.key, value)).collect();
    assert_eq!(params, [("g", 0.5), ("alpha", 2.0)]);
}

#[test]
fn ranges_are_what_they_say() {
    let allowed = |phase: Phase| phase.params().all(|(param, value)| (param.allows)(value));
    for g in [-1.0, 1.0, 1.5, f32::NAN, f32::INFINITY] {
        assert!(!allowed(Phase::HenyeyGreenstein { g }), "{g}");
        assert!(!allowed(Phase::CornetteShanks { g }), "{g}");
        assert!(!allowed(Phase::Draine { g, alpha: 1.0 }), "{g}");
    }
    for alpha in [-0.1, f32::NAN, f32::INFINITY] {
        assert!(!allowed(Phase::Draine { g: 0.5, alpha }), "{alpha}");
    }
    for alpha in [0.0, 1.0, f32::MAX] {
        assert!(allowed(Phase::Draine { g: -0.999, alpha }), "{alpha}");
    }
}

/// Integral over the sphere of `phase * weight(cos_theta)`, midpoint rule in theta (error 1e-7 at g = 0.95).
fn over_sphere(phase: Phase, weight: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    let step = PI / f64::from(n);
    let ring = |i| {
        let theta = (f64::from(i) + 0.5) * step;
        2.0 * PI * theta.sin() * phase.evaluate(theta.cos()) * weight(theta.cos())
    };
    (0..n).map(ring).sum::<f64>() * step
}

#[test]
fn integrates_to_one() {
    for phase in all() {
        let total = over_sphere(phase, |_| 1.0);
        assert!((total - 1.0).abs() < 1e-6, "{phase:?}: {total}");
    }
}

#[test]
fn mean_cosine_is_the_closed_form() {
    for phase in all() {
        let mean = over_sphere(phase, |c| c);
        let stated = phase.mean_cosine();
        assert!(
            (mean - stated).abs() < 1e-6,
            "{phase:?}: {mean}, stated {stated}"
        );
    }
}

#[test]
fn positive_g_scatters_forward() {
    assert!(phase_hg(0.5, 1.0) > phase_hg(0.5, -1.0));
    assert!(phase_cornette_shanks(0.5, 1.0) > phase_cornette_shanks(0.5, -1.0));
    assert!(phase_draine(0.5, 3.0, 1.0) > phase_draine(0.5, 3.0, -1.0));
}

#[test]
fn limits_are_the_simpler_functions() {
    for i in 0..=200 {
        let cos = f64::from(i) / 100.0 - 1.0;
        let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-14, "{cos}: {a} and {b}");
        for g in [-0.9, -0.3, 0.0, 0.5, 0.99] {
            same(phase_draine(g, 0.0, cos), phase_hg(g, cos));
            same(phase_draine(g, 1.0, cos), phase_cornette_shanks(g, cos));
        }
        same(phase_draine(0.0, 1.0, cos), phase_rayleigh(cos));
        same(phase_cornette_shanks(0.0, cos), phase_rayleigh(cos));
    }
}

/// The fit's own parameters at 10 um, worked out by another program, and the mean cosine of clouds, which is 0.8 to 0.9 by all measures.
#[test]
fn droplets_are_the_published_fit() {
    let [(share, lobe), (rest, peak)] = droplets(10.0).expect("within the range");
    let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-5, "{found}");
    close(share, 0.481_955);
    close(share + rest, 1.0);
    let [g, alpha] = lobe.values().map(f64::from);
    close(g, 0.555_671);
    close(alpha, 21.995_521);
    close(f64::from(peak.values()[0]), 0.988_177);
    for diameter in [5.0, 8.0, 12.0, 20.0, 35.0, 50.0] {
        let parts = droplets(diameter).expect("within the range");
        let mean: f64 = parts.iter().map(|(w, phase)| w * phase.mean_cosine()).sum();
        assert!((0.78..0.92).contains(&mean), "{diameter}: {mean}");
        for (share, phase) in parts {
            assert!((0.0..1.0).contains(&share), "{diameter}: {share}");
            let is_allowed = phase.params().all(|(param, value)| (param.allows)(value));
            assert!(is_allowed, "{diameter}: {phase:?}");
        }
    }
    for outside in [0.0, 4.9, 50.1, f32::NAN] {
        assert_eq!(droplets(outside), None);
    }
}

#[test]
fn fog_shares_its_coefficients() {
    use crate::frame::MediumComponent;
    let [lobe, peak] = MediumComponent::fog_droplets([0.1, 0.2, 0.3], [0.01, 0.0, 0.02], 20.0)
        .expect("within the range");
    let sum = |a: [f32; 3], b: [f32; 3]| std::array::from_fn::<f32, 3, _>(|i| a[i] + b[i]);
    let near = |found: [f32; 3], exact: [f32; 3]| {
        let mut pairs = found.into_iter().zip(exact);
        assert!(pairs.all(|(a, b)| (a - b).abs() <= 1e-7), "{found:?}");
    };
    near(sum(lobe.sigma_s, peak.sigma_s), [0.1, 0.2, 0.3]);
    near(sum(lobe.sigma_a, peak.sigma_a), [0.01, 0.0, 0.02]);
    assert_eq!((lobe.phase.number(), peak.phase.number()), (4, 2));
    assert_eq!(
        MediumComponent::fog_droplets([0.1; 3], [0.0; 3], 51.0),
        None
    );
}

/// Every function of the table in f32, and with no other compiled in.
#[cfg(feature = "gpu")]
#[test]
fn wgsl_twins_agree() {
    use tyndall_testkit::{device::device_or_skip, wgsl};
    let Some(gpu) = device_or_skip("phase functions") else {
        return;
    };
    let text = "import tyndall::phase::table::phase_evaluate;";
    let text = crate::shader::tests::harness(text, &[], &[]);
    let mut all = all();
    all.push(Phase::HenyeyGreenstein { g: 0.998 });
    all.push(Phase::Draine {
        g: 0.5,
        alpha: f32::MAX,
    });
    for number in 0..TABLE.len() as u32 {
        let phases: Vec<Phase> = all
            .iter()
            .copied()
            .filter(|p| p.number() == number)
            .collect();
        assert!(!phases.is_empty(), "{number}");
        let mut inputs = Vec::new();
        for phase in &phases {
            let [a, b] = phase.values();
            inputs.extend((0..=512).map(|i| [a, b, i as f32 / 256.0 - 1.0]));
        }
        let only = format!("MEDIUM_PHASES: u32 = {}u", 1_u32 << number);
        let alone = text.replace("MEDIUM_PHASES: u32 = 0xffffffffu", &only);
        assert!(alone != text);
        for module in [&text, &alone] {
            let call = format!("phase_evaluate({number}u, vec2f(x[0], x[1]), x[2])");
            let found = wgsl::evaluate(gpu, &[module.as_str()], &call, &inputs);
            let found = found.expect("the shader runs");
            let mut worst = 0.0_f64;
            for (i, (x, found)) in inputs.iter().zip(found).enumerate() {
                let exact = phases[i / 513].evaluate(f64::from(x[2]));
                worst = worst.max((f64::from(found[0]) / exact - 1.0).abs());
            }
            // Largest measured on lavapipe: 1.2e-5, of narrow peaks.
            assert!(worst < 4e-5, "{}: {worst:.1e}", TABLE[number as usize].name);
        }
    }
}
