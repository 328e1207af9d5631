//! `tyndall info`: what this machine, this program, a scene or a shot has to offer.

use std::{
    ffi::OsStr,
    fmt::Write,
    io::{ErrorKind, Write as _},
};

use tyndall::{
    frame::{Emitter, Projection},
    phase::{self, PhaseInfo},
    techniques::{Backends, TABLE, TechniqueInfo},
};
use tyndall_scene::{
    builtin, framing,
    geometry::Geometry,
    scene::{Blocking, Scene},
};

use crate::{
    args::InfoArgs,
    backend::AdapterDescription,
    failure::Failure,
    load::{LoadedShot, ShotFrame, load_scene},
    progress::Progress,
    shot::{SceneSource, Shot},
};

pub(super) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let mut text = String::new();
    let written = match &args.input {
        Some(file) if file.extension() == Some(OsStr::new("toml")) => {
            let shot = Shot::load(file, None, &[]).map_err(Failure::input)?;
            let frame = LoadedShot::at_rest(&shot, &mut Progress::quiet())?.frame(0)?;
            write_shot(&mut text, &shot, &frame)
        }
        Some(scene) => {
            let scene = load_scene(&SceneSource::of(scene))?;
            write_scene(&mut text, &scene)
        }
        None => write_adapters(&mut text)
            .and_then(|()| write_techniques(&mut text))
            .and_then(|()| write_phases(&mut text))
            .and_then(|()| write_builtins(&mut text)),
    };
    written.map_err(Failure::input)?;
    match std::io::stdout().write_all(text.as_bytes()) {
        // Whoever reads has read enough.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done.map_err(Failure::input),
    }
}

fn write_adapters(text: &mut String) -> std::fmt::Result {
    writeln!(text, "Adapters")?;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let descriptor = descriptor.with_env();
    let backends = descriptor.backends;
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(backends));
    if adapters.is_empty() {
        writeln!(text, "  none: everything runs on the CPU")?;
    }
    for adapter in adapters {
        write_adapter(text, &adapter)?;
    }
    Ok(())
}

fn write_adapter(text: &mut String, adapter: &wgpu::Adapter) -> std::fmt::Result {
    use wgpu::Features;
    let AdapterDescription { name, driver, api } = AdapterDescription::of(adapter);
    let kind = adapter.get_info().device_type;
    let limits = adapter.limits();
    writeln!(text, "  {name} ({kind:?}, {api}, {driver})")?;
    writeln!(
        text,
        "    textures to {} texels a side, buffers to {} MiB",
        limits.max_texture_dimension_2d,
        limits.max_buffer_size >> 20
    )?;
    for (feature, use_of_it) in [
        (Features::TIMESTAMP_QUERY, "milliseconds a pass"),
        (Features::FLOAT32_BLENDABLE, "pictures of any brightness"),
        (
            Features::FLOAT32_FILTERABLE,
            "light textures of any brightness",
        ),
    ] {
        let has = if adapter.features().contains(feature) {
            "yes"
        } else {
            "no"
        };
        writeln!(text, "    {use_of_it}: {has}")?;
    }
    Ok(())
}

fn write_techniques(text: &mut String) -> std::fmt::Result {
    writeln!(text, "\nTechniques (the first is the default)")?;
    TABLE
        .iter()
        .try_for_each(|info| write_technique(text, info))
}

fn write_technique(text: &mut String, info: &TechniqueInfo) -> std::fmt::Result {
    let lights: Vec<&str> = info.lights.iter().map(|kind| kind.name()).collect();
    let backends = match info.backends {
        Backends::Cpu => "CPU",
        Backends::Gpu => "GPU",
        Backends::Both => "GPU and CPU",
    };
    writeln!(text, "  {}: {}", info.name, info.about)?;
    writeln!(text, "    {}", info.citation)?;
    writeln!(
        text,
        "    runs on {backends}; lights: {}",
        lights.join(", ")
    )?;
    for param in info.default_technique().params() {
        writeln!(
            text,
            "    technique.{} = {}: {} ({})",
            param.key, param.default, param.about, param.range
        )?;
    }
    Ok(())
}

fn write_phases(text: &mut String) -> std::fmt::Result {
    writeln!(text, "\nPhase functions, for medium.phase.kind")?;
    phase::TABLE
        .iter()
        .try_for_each(|info| write_phase(text, info))
}

fn write_phase(text: &mut String, info: &PhaseInfo) -> std::fmt::Result {
    writeln!(text, "  {}: {}", info.name, info.about)?;
    writeln!(text, "    {}", info.citation)?;
    info.params.iter().try_for_each(|param| {
        let (key, about, range) = (param.key, param.about, param.range);
        writeln!(text, "    medium.phase.{key}: {about} ({range})")
    })
}

fn write_builtins(text: &mut String) -> std::fmt::Result {
    writeln!(text, "\nBuilt-in scenes")?;
    builtin::BUILTINS
        .iter()
        .try_for_each(|scene| writeln!(text, "  builtin:{}: {}", scene.name, scene.about))
}

fn write_scene(text: &mut String, scene: &Scene) -> std::fmt::Result {
    let geometry = Geometry::new(scene);
    writeln!(text, "{}", scene.name)?;
    writeln!(
        text,
        "  {} triangles, {} nodes, {} meshes, {} materials, {} textures",
        geometry.len(),
        scene.nodes.len(),
        scene.meshes.len(),
        scene.materials.len(),
        scene.textures.len()
    )?;
    match geometry.bounds() {
        Some(bounds) => writeln!(
            text,
            "  from {} to {}, {} m",
            bounds.min,
            bounds.max,
            bounds.extent()
        )?,
        None => writeln!(text, "  no bounds: there is nothing in it")?,
    }
    write_materials(text, scene)?;
    write_lights(text, scene)?;
    write_cameras(text, scene)
}

fn write_materials(text: &mut String, scene: &Scene) -> std::fmt::Result {
    let count = |matches: fn(&Blocking) -> bool| {
        let materials = scene.materials.iter();
        materials.filter(|m| matches(&m.blocking)).count()
    };
    writeln!(
        text,
        "  materials: {} opaque, {} alpha-tested, {} glass, {} blended",
        count(|b| matches!(b, Blocking::Opaque)),
        count(|b| matches!(b, Blocking::Masked { .. })),
        count(|b| matches!(b, Blocking::Transmissive { .. })),
        count(|b| matches!(b, Blocking::Blended)),
    )
}

fn write_lights(text: &mut String, scene: &Scene) -> std::fmt::Result {
    for (name, emitter) in framing::lights(scene) {
        writeln!(text, "  light `{name}`: {}", described(&emitter))?;
    }
    Ok(())
}

/// A shot: its scene, and the lights with the techniques that compute them on the GPU, or on the CPU where one runs there
/// only.
fn write_shot(text: &mut String, shot: &Shot, frame: &ShotFrame) -> std::fmt::Result {
    writeln!(text, "{}: {}", shot.name(), shot.scene)?;
    let named = shot.named_techniques();
    let is_on_cpu = named.iter().any(|info| info.backends == Backends::Cpu);
    let side = if is_on_cpu {
        Backends::Cpu
    } else {
        Backends::Gpu
    };
    let techniques = frame.techniques_on(side);
    for (index, (light, technique)) in frame.frame.lights.iter().zip(&techniques).enumerate() {
        let params = technique.params();
        let params: Vec<String> = params
            .iter()
            .map(|param| format!("{} = {}", param.key, param.value))
            .collect();
        writeln!(
            text,
            "  light.{index}: {}, by {} ({})",
            described(&light.emitter),
            technique.info().name,
            params.join(", ")
        )?;
    }
    write_scene(text, &frame.scene)
}

/// An emitter in words.
fn described(emitter: &Emitter) -> String {
    match emitter {
        Emitter::Directional {
            direction,
            illuminance,
        } => format!("directional along {direction:?}, {illuminance:?} W/m^2"),
        Emitter::Point {
            position,
            intensity,
            radius,
        } => format!("point at {position:?}, radius {radius} m, {intensity:?} W/sr"),
        Emitter::Spot {
            position,
            direction,
            intensity,
            inner,
            outer,
            radius,
        } => format!(
            "spot at {position:?} along {direction:?}, radius {radius} m, {intensity:?} W/sr, {inner} to {outer} rad"
        ),
        Emitter::Rect {
            center, radiance, ..
        } => format!("rect at {center:?}, {radiance:?} W/(m^2 sr)"),
    }
}

fn write_cameras(text: &mut String, scene: &Scene) -> std::fmt::Result {
    for (name, camera) in framing::cameras(scene, 1.0) {
        let (what, near, far) = match camera.projection {
            Projection::Perspective {
                half_extent,
                near,
                far,
                ..
            } => {
                let yfov = 2.0 * half_extent[1].atan().to_degrees();
                (format!("perspective, yfov {yfov:.1} degrees"), near, far)
            }
            Projection::Orthographic {
                half_extent,
                near,
                far,
                ..
            } => (
                format!("orthographic, {} m high", 2.0 * half_extent[1]),
                near,
                far,
            ),
        };
        writeln!(
            text,
            "  camera `{name}`: {what}, from {near} to {far} m, at {:?}",
            camera.eye
        )?;
    }
    Ok(())
}
