//! Pictures of 3840 x 2160 pixels, whose lists of pixels need more workgroups than a dimension of a dispatch may have. A dispatch
//! that is too large is replaced by none, in silence: what it would have written is missing then.

mod common;

use common::{Stage, crowd, gpu as on, run::Run, steps, technique};
use tyndall::{
    frame::Emitter,
    techniques::{Backends, TABLE, Technique, Value},
};
use tyndall_testkit::{device::device_or_skip, metrics::compare, picture::Picture};

const LARGE: [u32; 2] = [3840, 2160];

/// Cheap: what is looked for does not hang on the quality of single pixels.
fn cheap(name: &str) -> Technique {
    let whole = |key, value| (key, Value::Integer(value));
    match name {
        "ray-march" | "hybrid" => technique(name, &[steps(64)]),
        "epipolar" => technique(name, &[whole("slices", 0), whole("samples", 0)]),
        "ivsv" => technique(name, &[whole("resolution", 64)]),
        _ => technique(name, &[]),
    }
}

/// A sun, or a panel for the technique that does nothing else, over depths that differ from pixel to pixel: all are listed.
fn stage(technique: &Technique) -> Stage {
    let mut stage = crowd();
    stage.frame.lights.truncate(1);
    stage.lights.truncate(1);
    let light = &mut stage.frame.lights[0];
    if !technique.info().can(light.kind(), Backends::Gpu) {
        light.emitter = Emitter::Rect {
            center: [0.0, 3.0, 0.0],
            edge_x: [1.0, 0.0, 0.0],
            edge_y: [0.0, 0.0, 1.0],
            radiance: [5.0; 3],
            samples: 4,
        };
        (light.shadow, light.texture) = (None, None);
        stage.lights[0] = Default::default();
    }
    stage.sized(LARGE)
}

#[test]
#[ignore = "takes minutes on a software driver"]
fn no_pixel_is_missing() {
    let Some(gpu) = device_or_skip("large pictures") else {
        return;
    };
    let effect = on::effect(gpu);
    let picture = |stage: &Stage, technique: &Technique| {
        let pixels = Run::sized(LARGE, gpu, &effect, None).frame(stage, technique);
        let color = |p: &[u32; 4]| [p[0], p[1], p[2]].map(|bits| f64::from(f32::from_bits(bits)));
        let colors = pixels.iter().map(color).collect();
        Picture::new(LARGE.map(|n| n as usize), colors).expect("as many as the size")
    };
    for info in TABLE.iter().filter(|info| info.backends != Backends::Cpu) {
        let technique = cheap(info.name);
        let stage = stage(&technique);
        let error = compare(
            &picture(&stage, &technique),
            &picture(&stage, &cheap("ray-march")),
        );
        let error = error.expect("same size").rel_mae;
        println!("{}: {error:.1e}", info.name);
        assert!(error < 0.05, "{}: {error}", info.name);
    }
}
