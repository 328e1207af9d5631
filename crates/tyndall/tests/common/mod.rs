//! Stages: everything a frame needs, made by code without a scene. Blocky shadow maps with holes, a bumpy depth buffer,
//! every kind of light, medium and camera.
#![allow(dead_code, reason = "each test binary uses its own part")]

use std::ops::Range;

use glam::{DVec3, Mat4, Vec3};
use tyndall::{
    camera::CameraRays,
    cpu::{self, CpuInputs, CpuLightInputs, GlassMap, LightTexture, ShadowMap},
    frame::{
        Camera, DepthRange, Emitter, Frame, Light, Medium, MediumComponent, Phase, Projection,
        ShadowProjection, TexturePlacement,
    },
    techniques::{Technique, TechniqueChoice, Value},
};
use tyndall_testkit::{metrics::compare, picture::Picture};

#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(feature = "gpu")]
pub(crate) mod run;

/// Width and height of the images \[pixels].
pub(crate) const SIZE: [u32; 2] = [48, 36];
const MAP: u32 = 64;
const GLASS_LAYERS: u32 = 2;

/// A frame and its textures.
#[derive(Clone)]
pub(crate) struct Stage {
    pub(crate) name: String,
    pub(crate) frame: Frame,
    pub(crate) depth: Vec<f32>,
    pub(crate) lights: Vec<StageLight>,
}

/// The textures of one light.
#[derive(Clone, Default)]
pub(crate) struct StageLight {
    pub(crate) shadow_map: Option<ShadowMap>,
    pub(crate) glass: Option<GlassMap>,
    pub(crate) texture: Option<LightTexture>,
}

/// A number in [0, 1) that looks random.
pub(crate) fn noise(seed: u32) -> f32 {
    let mut x = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    ((x >> 22) ^ x) as f32 / 4_294_967_296.0
}

/// Numbers in [0, 1) that look random, one after another.
pub(crate) struct Random(pub(crate) u32);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 += 1;
        noise(self.0).into()
    }

    /// One of `count` numbers from 0 on.
    pub(crate) fn roll(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize % count
    }

    /// A vector within a cube of this half size.
    pub(crate) fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| size * (2.0 * self.next() - 1.0)))
    }
}

/// A technique by name, with parameters.
pub(crate) fn technique(name: &str, params: &[(&str, Value)]) -> Technique {
    let mut technique = Technique::from_name(name).expect("a technique of the table");
    for (key, value) in params {
        technique.set(key, value).expect("a parameter of it");
    }
    technique
}

pub(crate) fn steps(n: i64) -> (&'static str, Value) {
    ("steps", Value::Integer(n))
}

/// `min-max` with the svd integrator.
pub(crate) fn svd(rank: i64) -> Technique {
    let integrator = ("integrator", Value::Word("svd".into()));
    technique("min-max", &[integrator, ("rank", Value::Integer(rank))])
}

impl Stage {
    pub(crate) fn cpu_lights(&self) -> Vec<CpuLightInputs<'_>> {
        fn inputs(light: &StageLight) -> CpuLightInputs<'_> {
            CpuLightInputs {
                shadow_map: light.shadow_map.as_ref(),
                glass: light.glass.as_ref(),
                texture: light.texture.as_ref(),
            }
        }
        self.lights.iter().map(inputs).collect()
    }

    /// In-scatter by the CPU backend.
    /// The stage in another window: its depths are strewn over it.
    pub(crate) fn sized(mut self, [width, height]: [u32; 2]) -> Self {
        let depths = self.depth.iter().copied().cycle();
        self.depth = depths.take((width * height) as usize).collect();
        self
    }

    pub(crate) fn on_cpu(&self, technique: Technique) -> Picture {
        let frame = self.frame.clone();
        let frame_by = TechniqueChoice::from(technique);
        let lights = self.cpu_lights();
        let inputs = CpuInputs {
            size: SIZE,
            depth: &self.depth,
            lights: &lights,
            occluders: None,
        };
        let result = cpu::render(&frame, &inputs, &frame_by, &|_, _| {}).expect("a good stage");
        picture(&result.pixels)
    }
}

/// The colours of RGBA pixels.
pub(crate) fn picture(pixels: &[[f32; 4]]) -> Picture {
    let colors = pixels.iter().map(|p| [p[0], p[1], p[2]].map(f64::from));
    Picture::new(SIZE.map(|n| n as usize), colors.collect()).expect("as many as the size")
}

pub(crate) fn media() -> [(&'static str, Medium); 4] {
    let one = |sigma_s, sigma_a, phase| MediumComponent {
        sigma_s,
        sigma_a,
        phase,
    };
    [
        (
            "isotropic",
            vec![one([0.05; 3], [0.01; 3], Phase::Isotropic)],
        ),
        (
            "forward, chromatic",
            vec![one(
                [0.03, 0.06, 0.12],
                [0.01, 0.02, 0.05],
                Phase::HenyeyGreenstein { g: 0.6 },
            )],
        ),
        (
            "air",
            vec![
                one([0.006, 0.014, 0.033], [0.0; 3], Phase::Rayleigh),
                one([0.02; 3], [0.004; 3], Phase::HenyeyGreenstein { g: 0.76 }),
            ],
        ),
        (
            "thin, backward",
            vec![one(
                [1e-4; 3],
                [0.0; 3],
                Phase::HenyeyGreenstein { g: -0.5 },
            )],
        ),
    ]
    .map(|(name, components)| (name, Medium { components }))
}

/// Media of the phase functions that [`media`] does not have: haze, dust, and the droplets of a fog.
fn fogs() -> [(&'static str, Medium); 3] {
    let haze = MediumComponent {
        sigma_s: [0.03, 0.05, 0.08],
        sigma_a: [0.01; 3],
        phase: Phase::CornetteShanks { g: 0.5 },
    };
    let dust = MediumComponent {
        phase: Phase::Draine { g: 0.6, alpha: 0.5 },
        ..haze
    };
    let droplets = MediumComponent::fog_droplets([0.06; 3], [0.003; 3], 10.0);
    let droplets = droplets.expect("a diameter of the fit");
    [
        ("haze", vec![haze]),
        ("dust", vec![dust]),
        ("droplets", droplets.to_vec()),
    ]
    .map(|(name, components)| (name, Medium { components }))
}

/// Cameras in a world of some ten metres about the origin; `TARGET` is where the local lights are.
pub(crate) fn cameras() -> [(&'static str, Camera); 6] {
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let at =
        |eye, target| Camera::perspective(eye, target, [0.0, 1.0, 0.0], 1.0, aspect, 0.1, 30.0);
    let mut standard = at([-6.0, 1.0, 5.0], [3.0, 0.0, -3.0]);
    standard.depth_range = DepthRange::Standard;
    let mut infinite = at([3.0, -2.0, -7.0], [-1.0, 1.5, 0.0]);
    infinite.depth_range = DepthRange::ReversedInfinite;
    let mut flat = at([2.0, 3.0, 8.0], [0.0, 0.0, 0.0]);
    flat.projection = Projection::Orthographic {
        half_extent: [4.0 * aspect, 4.0],
        center: [0.5, -0.25],
        near: 0.5,
        far: 20.0,
    };
    [
        ("towards the light", at([0.5, 0.3, 7.0], LIGHT.to_array())),
        ("away from it", at([0.5, 2.5, -1.0], [1.0, 1.0, 9.0])),
        ("across, standard depth", standard),
        ("from behind, infinite depth", infinite),
        ("orthographic", flat),
        ("straight up", at([0.2, -4.0, 0.1], [0.2, 4.0, 0.11])),
    ]
}

const LIGHT: Vec3 = Vec3::new(-0.6, 2.2, -2.0);

/// Lights with their shadow projections and texture placements.
fn lights() -> Vec<(&'static str, Light)> {
    let direction = Vec3::new(0.3, -0.8, 0.4).normalize();
    let sun = Emitter::Directional {
        direction: (2.0 * direction).to_array(),
        illuminance: [10.0, 9.0, 7.0],
    };
    let lamp = Emitter::Point {
        position: LIGHT.to_array(),
        intensity: [20.0, 25.0, 30.0],
        radius: 0.0,
    };
    let spot = Emitter::Spot {
        position: LIGHT.to_array(),
        direction: [0.3, -0.7, 1.0],
        intensity: [50.0, 40.0, 30.0],
        inner: 0.3,
        outer: 0.6,
        radius: 0.0,
    };
    let hemisphere = Emitter::Spot {
        position: LIGHT.to_array(),
        direction: [0.3, -0.7, 1.0],
        intensity: [30.0, 25.0, 20.0],
        inner: 0.8,
        outer: std::f32::consts::FRAC_PI_2,
        radius: 0.0,
    };
    let sun_view = glam::camera::rh::view::look_to_mat4(-12.0 * direction, direction, Vec3::X);
    // A reversed depth range: near and far swapped.
    let sun_map =
        glam::camera::rh::proj::directx::orthographic(-9.0, 9.0, -9.0, 9.0, 26.0, 0.5) * sun_view;
    let spot_view =
        glam::camera::rh::view::look_to_mat4(LIGHT, Vec3::new(0.3, -0.7, 1.0).normalize(), Vec3::Y);
    let spot_map = glam::camera::rh::proj::directx::perspective(1.25, 1.0, 0.2, 25.0) * spot_view;
    let single = |matrix: Mat4, reversed_depth| {
        Some(ShadowProjection::Single {
            clip_from_world: matrix.to_cols_array_2d(),
            reversed_depth,
        })
    };
    let cube = |reversed_depth| {
        Some(ShadowProjection::Cube {
            near: 0.1,
            far: 25.0,
            reversed_depth,
        })
    };
    let light = |emitter, shadow, texture| Light {
        emitter,
        shadow,
        texture,
    };
    let window = TexturePlacement::Parallelogram {
        center: [0.5, 0.0, 0.0],
        edge_x: [6.0, 0.0, 1.0],
        edge_y: [0.0, 0.0, 7.0],
    };
    let globe = TexturePlacement::Sphere {
        up: [0.1, 1.0, 0.0],
        forward: [0.0, 0.0, 1.0],
    };
    vec![
        ("sun", light(sun, single(sun_map, true), None)),
        ("sun without shadows", light(sun, None, None)),
        (
            "sun through a picture",
            light(sun, single(sun_map, true), Some(window)),
        ),
        ("lamp", light(lamp, cube(true), None)),
        ("lamp, standard depth", light(lamp, cube(false), None)),
        ("lamp in a picture", light(lamp, cube(true), Some(globe))),
        ("spot", light(spot, single(spot_map, false), None)),
        ("hemisphere", light(hemisphere, cube(true), None)),
        (
            "spot through a picture",
            light(
                spot,
                single(spot_map, false),
                Some(TexturePlacement::Cone {
                    up: [0.0, 1.0, 0.0],
                }),
            ),
        ),
    ]
}

/// Blocks at random depths on a quarter of the map's cells.
fn shadow_map(faces: u32, reversed: bool, perspective: bool) -> ShadowMap {
    let texel = |i: u32| {
        let (face, row, column) = (i / (MAP * MAP), i / MAP % MAP, i % MAP);
        let cell = (face * 97 + row / 8) * 31 + column / 8;
        let near_is_one = if noise(cell) < 0.4 {
            0.0
        } else if perspective {
            // Distances of 1 to 11 m at near = 0.1.
            0.1 / (1.0 + 10.0 * noise(cell + 7777))
        } else {
            0.2 + 0.6 * noise(cell + 7777)
        };
        if reversed {
            near_is_one
        } else {
            1.0 - near_is_one
        }
    };
    ShadowMap {
        size: [MAP, MAP],
        depth: (0..faces * MAP * MAP).map(texel).collect(),
    }
}

/// Panes of random tints before the blocks and behind them; a texel's layers come nearest first, empty ones last.
fn glass_map(faces: u32, reversed: bool, perspective: bool) -> GlassMap {
    let side = MAP / 2;
    let empty = [1.0, 1.0, 1.0, if reversed { 0.0 } else { 1.0 }];
    let pane = |plane: u32, row: u32, column: u32| {
        let layer = plane % GLASS_LAYERS;
        let cell = (plane * 57 + row / 4) * 29 + column / 4;
        let distance = 0.1 + 0.4 * layer as f32 + 0.4 * noise(cell);
        let near_is_one = if perspective {
            0.1 / (0.5 + 10.0 * distance)
        } else {
            0.9 - 0.7 * distance
        };
        let depth = if reversed {
            near_is_one
        } else {
            1.0 - near_is_one
        };
        (noise(cell + 99) >= 0.5)
            .then(|| [noise(cell + 1), noise(cell + 2), noise(cell + 3), depth])
    };
    let texel = |i: u32| {
        let (plane, row, column) = (i / (side * side), i / side % side, i % side);
        let first = plane - plane % GLASS_LAYERS;
        let mut panes = (first..first + GLASS_LAYERS).filter_map(|p| pane(p, row, column));
        panes.nth((plane - first) as usize).unwrap_or(empty)
    };
    GlassMap {
        size: [side, side],
        layers: GLASS_LAYERS,
        texels: (0..faces * GLASS_LAYERS * side * side).map(texel).collect(),
    }
}

pub(crate) fn light_texture() -> LightTexture {
    let size = [13, 9];
    let texel = |i| std::array::from_fn(|k| noise(3 * i + k as u32));
    LightTexture {
        size,
        texels: (0..size[0] * size[1]).map(texel).collect(),
    }
}

/// The textures a light asks for.
pub(crate) fn pictures(light: &Light, with_glass: bool) -> StageLight {
    let (faces, reversed) = match light.shadow {
        Some(ShadowProjection::Cube { reversed_depth, .. }) => (6, reversed_depth),
        Some(ShadowProjection::Single { reversed_depth, .. }) => (1, reversed_depth),
        None => (0, false),
    };
    let perspective = !matches!(light.emitter, Emitter::Directional { .. });
    StageLight {
        shadow_map: (faces > 0).then(|| shadow_map(faces, reversed, perspective)),
        glass: (faces > 0 && with_glass).then(|| glass_map(faces, reversed, perspective)),
        texture: light.texture.map(|_| light_texture()),
    }
}

/// A bumpy wall, and the far plane in a corner.
pub(crate) fn depth(reversed: bool) -> Vec<f32> {
    let pixel = |i: u32| {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        // 1 at the near plane: 0.1 / 30 / 0.1 .. in terms of perspective about 3 to 30 m.
        let near_is_one = if x < 8 && y < 8 {
            0.0
        } else {
            0.003 + 0.03 * noise(x / 3 + 100 * (y / 3))
        };
        if reversed {
            near_is_one
        } else {
            1.0 - near_is_one
        }
    };
    (0..SIZE[0] * SIZE[1]).map(pixel).collect()
}

/// A stage of one light.
pub(crate) fn stage(
    name: String,
    camera: Camera,
    medium: Medium,
    light: Light,
    glass: bool,
) -> Stage {
    Stage {
        name,
        depth: depth(camera.depth_range.is_reversed()),
        lights: vec![pictures(&light, glass)],
        frame: Frame {
            camera,
            lights: vec![light],
            medium,
        },
    }
}

/// Every light with every camera; media and glass take turns, so that each meets each light.
pub(crate) fn stages() -> Vec<Stage> {
    let (media, cameras) = (media(), cameras());
    let mut stages = Vec::new();
    for (i, (light_name, light)) in lights().into_iter().enumerate() {
        for (j, (camera_name, camera)) in cameras.iter().enumerate() {
            let (medium_name, medium) = &media[(i + j) % media.len()];
            let glass = light.shadow.is_some() && j % 2 == 1;
            let name = format!("{light_name}; {camera_name}; {medium_name}; glass {glass}");
            stages.push(stage(name, *camera, medium.clone(), light, glass));
        }
    }
    stages
}

/// Sun, lamp and spot in each of the fogs, seen towards the light and from beside it.
pub(crate) fn fog_stages() -> Vec<Stage> {
    let (fogs, cameras) = (fogs(), cameras());
    let mut stages = Vec::new();
    for (light_name, light) in lights() {
        if !["sun", "lamp", "spot"].contains(&light_name) {
            continue;
        }
        for (j, (fog_name, medium)) in fogs.iter().enumerate() {
            let (camera_name, camera) = &cameras[[0, 2, 0][j]];
            let name = format!("{light_name}; {camera_name}; {fog_name}");
            stages.push(stage(name, *camera, medium.clone(), light, false));
        }
    }
    assert_eq!(stages.len(), 9);
    stages
}

/// The stages whose camera has an eye.
pub(crate) fn perspective_stages() -> Vec<Stage> {
    let mut stages = stages();
    stages.retain(|s| matches!(s.frame.camera.projection, Projection::Perspective { .. }));
    stages
}

/// Lights that shine into the camera: stages with their epipole within the image, and the direction to it.
pub(crate) fn epipole_stages() -> Vec<(Stage, Vec3)> {
    let mut stages = stages();
    stages.retain(|s| s.name.contains("; towards the light; ") && s.lights[0].texture.is_none());
    let place = |mut stage: Stage| {
        let camera = &mut stage.frame.camera;
        let eye = Vec3::from_array(camera.eye);
        let axis = match stage.frame.lights[0].emitter {
            Emitter::Directional { direction, .. } => -Vec3::from_array(direction),
            _ => LIGHT - eye,
        }
        .normalize();
        // Beside the middle, between pixels.
        camera.forward = (axis + Vec3::new(0.11, 0.07, 0.03)).to_array();
        (stage, axis)
    };
    stages.into_iter().map(place).collect()
}

/// Distance of every pixel from the epipole \[pixels], as its sine to the axis.
pub(crate) fn off_axis(stage: &Stage, axis: Vec3) -> Vec<f64> {
    let rays = CameraRays::new(&stage.frame.camera, SIZE);
    let axis = axis.as_dvec3();
    let sine = |i: u32| {
        let ray = rays.ray(i % SIZE[0], i / SIZE[0], stage.depth[i as usize]);
        ray.direction.cross(axis).length()
    };
    // A view of one radian from top to bottom.
    let pixel = 2.0 * 0.5_f64.tan() / f64::from(SIZE[1]);
    (0..SIZE[0] * SIZE[1]).map(|i| sine(i) / pixel).collect()
}

/// The error of the pixels whose distances are within a range; `None` where there are none.
fn error_within(
    found: &Picture,
    truth: &Picture,
    distances: &[f64],
    range: &Range<f64>,
) -> Option<f64> {
    let [found, truth] = [found, truth].map(|picture| {
        let pixels = picture.pixels().iter().zip(distances);
        let within = pixels.filter(|(_, d)| range.contains(d)).map(|(p, _)| *p);
        let within: Vec<[f64; 3]> = within.collect();
        Picture::new([within.len(), 1], within).ok()
    });
    Some(compare(&found?, &truth?).expect("same size").rel_mae)
}

/// Errors of `min-max` on either side of the border of the rays that are walked, three pixels wide, for some radii of it.
pub(crate) fn seam_errors(
    stage: &Stage,
    axis: Vec3,
    truth: &Picture,
    render: impl Fn(Technique) -> Picture,
) -> Vec<(i64, f64)> {
    let distances = off_axis(stage, axis);
    let mut errors = Vec::new();
    for radius in [0_i64, 2, 8] {
        let found = render(technique(
            "min-max",
            &[("epipole_radius", Value::Real(radius as f64))],
        ));
        let border = radius as f64;
        for range in [border - 3.0..border, border..border + 3.0] {
            let error = error_within(&found, truth, &distances, &range);
            errors.extend(error.map(|error| (radius, error)));
        }
    }
    errors
}

/// A stage of all lights at once.
pub(crate) fn crowd() -> Stage {
    let (_, camera) = cameras()[0];
    let [_, (_, medium), ..] = media();
    let lights: Vec<Light> = lights().into_iter().map(|(_, light)| light).collect();
    Stage {
        name: "all lights".into(),
        depth: depth(camera.depth_range.is_reversed()),
        lights: lights.iter().map(|l| pictures(l, true)).collect(),
        frame: Frame {
            camera,
            lights,
            medium,
        },
    }
}
