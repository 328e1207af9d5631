//! Temporal reuse while the camera moves: kept pixels stay within the tolerance of computed ones.

mod common;

use common::{Stage, StageLight, gpu as on, media, run::Run, steps, technique};
use glam::{Mat4, Vec3};
use tyndall::{
    camera::CameraRays,
    cpu::ShadowMap,
    frame::{Camera, DepthRange, Emitter, Frame, Light, Projection, ShadowProjection},
    techniques::Technique,
    temporal::Reuse,
};
use tyndall_testkit::device::device_or_skip;

/// Width and height of the images \[pixels].
const SIZE: [u32; 2] = [128, 96];
const PIXELS: u32 = SIZE[0] * SIZE[1];
/// Texels of a shadow map's side.
const MAP: u32 = 256;

/// Boxes in a hall, seen by a camera and shone on through what hangs from above.
#[derive(Clone)]
struct Hall {
    boxes: Vec<[Vec3; 2]>,
    light: Light,
    map: ShadowMap,
}

/// The hall's walls and floor.
const WALLS: [Vec3; 2] = [Vec3::new(-7.0, 0.0, -8.0), Vec3::new(7.0, 9.0, 9.0)];

/// Distances along a ray where it is in a box.
fn inside(corners: [Vec3; 2], origin: Vec3, way: Vec3) -> [f32; 2] {
    let [a, b] = corners.map(|corner| (corner - origin) / way);
    [a.min(b).max_element(), a.max(b).min_element()]
}

impl Hall {
    fn new(light: Light) -> Self {
        let slat = |i: u8| {
            let x = -6.0 + 2.2 * f32::from(i);
            [Vec3::new(x, 5.0, -8.0), Vec3::new(x + 1.1, 5.2, 4.0)]
        };
        let column = |x, z| {
            [
                Vec3::new(x, 0.0, z),
                Vec3::new(x + 0.6, 3.0 + 0.2 * x, z + 0.6),
            ]
        };
        let columns = [
            column(-3.0, -2.0),
            column(1.5, -4.0),
            column(3.0, 0.5),
            column(-4.5, -6.0),
        ];
        Self::of((0..6).map(slat).chain(columns).collect(), light)
    }

    fn of(boxes: Vec<[Vec3; 2]>, light: Light) -> Self {
        let map = ShadowMap {
            size: [MAP; 2],
            depth: Vec::new(),
        };
        let mut hall = Self { boxes, light, map };
        hall.map.depth = hall.shadow_depths();
        hall
    }

    /// A room with something in it.
    fn with(&self, more: [Vec3; 2]) -> Self {
        Self::of([&self.boxes[..], &[more]].concat(), self.light)
    }

    /// The distance at which a ray first meets a box.
    fn first_box(&self, origin: Vec3, way: Vec3) -> f32 {
        let spans = self.boxes.iter().map(|b| inside(*b, origin, way));
        let ahead = spans.filter(|[near, far]| near < far && *near > 0.0);
        ahead.map(|[near, _]| near).fold(f32::INFINITY, f32::min)
    }

    fn depth(&self, camera: &Camera) -> Vec<f32> {
        let rays = CameraRays::new(camera, SIZE);
        let far = camera.depth_range.far_value();
        let pixel = |i: u32| {
            let ray = rays.ray(i % SIZE[0], i / SIZE[0], far);
            let (origin, way) = (ray.origin.as_vec3(), ray.direction.as_vec3());
            let wall = inside(WALLS, origin, way)[1];
            let distance = f64::from(self.first_box(origin, way).min(wall));
            rays.depth_value(distance * ray.direction.dot(rays.forward))
        };
        (0..PIXELS).map(pixel).collect()
    }

    fn shadow_depths(&self) -> Vec<f32> {
        let faces = match self.light.shadow {
            Some(ShadowProjection::Cube { .. }) => 6,
            _ => 1,
        };
        let texel = |i: u32| {
            let [x, y] =
                [i % MAP, i / MAP % MAP].map(|n| (n as f32 + 0.5) / MAP as f32 * 2.0 - 1.0);
            self.shadow_depth(i / (MAP * MAP), x, -y)
        };
        (0..faces * MAP * MAP).map(texel).collect()
    }

    /// The light's map at a place of its clip space.
    fn shadow_depth(&self, face: u32, x: f32, y: f32) -> f32 {
        match (self.light.shadow, self.light.emitter) {
            (
                Some(ShadowProjection::Single {
                    clip_from_world, ..
                }),
                _,
            ) => {
                let clip_from_world = Mat4::from_cols_array_2d(&clip_from_world);
                let world_from_clip = clip_from_world.inverse();
                let [near, far] =
                    [1.0, 0.0].map(|depth| world_from_clip.project_point3(Vec3::new(x, y, depth)));
                let way = (far - near).normalize();
                let end = near + self.first_box(near, way).min(1e3) * way;
                clip_from_world.project_point3(end).z.max(0.0)
            }
            (Some(ShadowProjection::Cube { near, far, .. }), Emitter::Point { position, .. }) => {
                // The WebGPU specification's faces.
                let way = [
                    Vec3::new(1.0, y, -x),
                    Vec3::new(-1.0, y, x),
                    Vec3::new(x, 1.0, -y),
                    Vec3::new(x, -1.0, y),
                    Vec3::new(x, y, 1.0),
                    Vec3::new(-x, y, -1.0),
                ][face as usize];
                let along_axis = self.first_box(position.into(), way).min(far);
                near / (far - near) * (far / along_axis - 1.0)
            }
            _ => unreachable!("all of them have such a map"),
        }
    }

    fn stage(&self, camera: Camera) -> Stage {
        let [_, (_, medium), ..] = media();
        Stage {
            name: String::new(),
            depth: self.depth(&camera),
            lights: vec![StageLight {
                shadow_map: Some(self.map.clone()),
                glass: None,
                texture: None,
            }],
            frame: Frame {
                camera,
                lights: vec![self.light],
                medium,
            },
        }
    }
}

/// The sun, a spot and a lamp.
fn lights() -> [Light; 3] {
    use glam::camera::rh::{proj::directx, view::look_to_mat4};
    let way = Vec3::new(0.35, -0.85, -0.25).normalize();
    let sun_view = look_to_mat4(-16.0 * way, way, Vec3::X);
    // Reversed depth ranges: near and far swapped.
    let sun_map = directx::orthographic(-10.0, 10.0, -10.0, 10.0, 30.0, 0.5) * sun_view;
    let sun = Emitter::Directional {
        direction: way.to_array(),
        illuminance: [10.0, 9.0, 7.0],
    };
    let above = Vec3::new(0.0, 8.0, -3.0);
    let axis = Vec3::new(0.05, -1.0, 0.1).normalize();
    let spot_map = directx::perspective(1.8, 1.0, 25.0, 0.2) * look_to_mat4(above, axis, Vec3::X);
    let spot = Emitter::Spot {
        position: above.to_array(),
        direction: axis.to_array(),
        intensity: [300.0, 280.0, 250.0],
        inner: 0.5,
        outer: 0.85,
        radius: 0.0,
    };
    let lamp = Emitter::Point {
        position: above.to_array(),
        intensity: [300.0, 280.0, 250.0],
        radius: 0.0,
    };
    let single = |map: Mat4| ShadowProjection::Single {
        clip_from_world: map.to_cols_array_2d(),
        reversed_depth: true,
    };
    let cube = ShadowProjection::Cube {
        near: 0.1,
        far: 25.0,
        reversed_depth: true,
    };
    [
        (sun, single(sun_map)),
        (spot, single(spot_map)),
        (lamp, cube),
    ]
    .map(|(emitter, shadow)| Light {
        emitter,
        shadow: Some(shadow),
        texture: None,
    })
}

/// A camera that walks and looks about, two centimetres and a sixth of a degree a frame.
fn camera(frame: u32) -> Camera {
    let t = frame as f32;
    let eye = Vec3::new(-1.5 + 0.016 * t, 1.7, 7.5 - 0.012 * t);
    let angle = 0.1 - 0.003 * t;
    let ahead = Vec3::new(angle.sin(), 0.1, -angle.cos());
    let target = (eye + ahead).to_array();
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    Camera::perspective(
        eye.to_array(),
        target,
        [0.0, 1.0, 0.0],
        1.0,
        aspect,
        0.1,
        40.0,
    )
}

/// A camera without an eye that goes sideways.
fn flat_camera(frame: u32) -> Camera {
    Camera {
        projection: Projection::Orthographic {
            half_extent: [4.0, 3.0],
            center: [0.0; 2],
            near: 0.0,
            far: 20.0,
        },
        depth_range: DepthRange::Standard,
        eye: [-1.5 + 0.016 * frame as f32, 1.7, 7.5],
        forward: [0.0, 0.1, -1.0],
        ..camera(frame)
    }
}

fn reproject(tolerance: f32) -> Option<Reuse> {
    Some(Reuse {
        reproject: Some(tolerance),
        ..Reuse::default()
    })
}

/// Radiance of the pixels' three channels.
fn colors(output: &[[u32; 4]]) -> Vec<[f64; 3]> {
    let color = |p: &[u32; 4]| [p[0], p[1], p[2]].map(|bits| f64::from(f32::from_bits(bits)));
    output.iter().map(color).collect()
}

/// Mean of |difference| over the mean of the reference.
fn relative_mae(picture: &[[f64; 3]], reference: &[[f64; 3]]) -> f64 {
    let pairs = picture.iter().flatten().zip(reference.iter().flatten());
    let error: f64 = pairs.map(|(a, b)| (a - b).abs()).sum();
    error / reference.iter().flatten().sum::<f64>()
}

/// The pixels' largest difference of a channel over the brightest value in its tile of 8 x 8, or over a hundredth of the
/// picture's mean where that is more.
fn worst(picture: &[[f64; 3]], reference: &[[f64; 3]]) -> f64 {
    let most = |color: [f64; 3]| color.into_iter().fold(0.0, f64::max);
    let width = SIZE[0] as usize;
    let tile = |i: usize| i % width / 8 + i / width / 8 * width;
    let mean = reference.iter().flatten().sum::<f64>() / (3 * reference.len()) as f64;
    let mut brightest = vec![0.01 * mean; picture.len()];
    for (i, color) in picture.iter().enumerate() {
        brightest[tile(i)] = most(*color).max(brightest[tile(i)]);
    }
    let errors = (0..picture.len()).map(|i| {
        let error = [0, 1, 2].map(|k| (picture[i][k] - reference[i][k]).abs());
        most(error) / brightest[tile(i)]
    });
    errors.fold(0.0, f64::max)
}

/// Errors of a run of frames.
#[derive(Debug, Default)]
struct Film {
    /// Mean share of the pixels that were computed.
    computed: f64,
    /// The worst frame's error against brute force, of the technique alone and with reuse, and the largest ratio of the two.
    own: f64,
    kept: f64,
    ratio: f64,
    /// The worst frame's difference from the technique alone, as a mean and of a pixel.
    mean: f64,
    worst: f64,
}

/// A technique with and without reuse, over frames of a hall, after the first.
fn film(
    technique: &Technique,
    tolerance: f32,
    frames: u32,
    stage: impl Fn(u32) -> Stage,
) -> Option<Film> {
    let gpu = device_or_skip("reuse while the camera moves")?;
    let effect = on::effect(gpu);
    let brute = common::technique("ray-march", &[steps(192)]);
    let [mut truth, mut alone] = [(); 2].map(|()| Run::sized(SIZE, gpu, &effect, None));
    let mut reused = Run::sized(SIZE, gpu, &effect, reproject(tolerance));
    let mut film = Film::default();
    for frame in 0..=frames {
        let stage = stage(frame);
        let truth = colors(&truth.frame(&stage, &brute));
        let fresh = colors(&alone.frame(&stage, technique));
        let picture = colors(&reused.frame(&stage, technique));
        if frame == 0 {
            assert_eq!(picture, fresh);
            continue;
        }
        let [own, kept] = [&fresh, &picture].map(|picture| relative_mae(picture, &truth));
        let computed = f64::from(reused.stale()[0]) / f64::from(PIXELS);
        film = Film {
            computed: film.computed + computed / f64::from(frames),
            own: film.own.max(own),
            kept: film.kept.max(kept),
            ratio: film.ratio.max(kept / own),
            mean: film.mean.max(relative_mae(&picture, &fresh)),
            worst: film.worst.max(worst(&picture, &fresh)),
        };
    }
    println!("{} {tolerance}: {film:?}", technique.info().name);
    Some(film)
}

/// No frame's error over twice that of the technique without reuse.
#[test]
fn frames_of_a_moving_camera_are_as_good_as_without_reuse() {
    let hall = Hall::new(lights()[0]);
    let march = technique("ray-march", &[steps(32)]);
    let stage = |frame| hall.stage(camera(frame));
    let Some(film) = film(&march, 0.1, 120, stage) else {
        return;
    };
    assert!(film.ratio < 2.0, "{film:?}");
    assert!(film.computed < 0.8, "{film:?}");
}

/// Techniques that are exact leave nothing but what reuse leaves.
#[test]
fn kept_pixels_stay_within_the_tolerance() {
    let exact = technique("min-max", &[]);
    let [sun, spot, lamp] = lights();
    let tolerance = 0.05;
    // Measured: 0.028, 0.016 and, with the lamp in the picture, whose shadows are thinner than pixels there, 0.059.
    for (light, frames, most) in [(sun, 120, 0.05), (spot, 20, 0.05), (lamp, 20, 0.075)] {
        let hall = Hall::new(light);
        let Some(film) = film(&exact, tolerance, frames, |frame| hall.stage(camera(frame))) else {
            return;
        };
        assert!(film.worst < most && film.computed < 0.8, "{film:?}");
    }
    let hall = Hall::new(sun);
    let march = technique("ray-march", &[steps(256)]);
    let Some(film) = film(&march, 0.05, 12, |frame| hall.stage(flat_camera(frame))) else {
        return;
    };
    assert!(film.worst < 0.05 && film.computed < 0.8, "{film:?}");
}

/// Something crosses the light while the camera moves, stands still, and is gone.
#[test]
fn no_ghost_stays_of_what_moved() {
    let Some(gpu) = device_or_skip("ghosts of what moved") else {
        return;
    };
    let effect = on::effect(gpu);
    let exact = technique("min-max", &[]);
    let hall = Hall::new(lights()[0]);
    let with_mover = |frame: u32| {
        let corner = Vec3::new(-3.0 + 0.15 * frame.min(24) as f32, 2.5, 0.0);
        match frame {
            0..40 => hall.with([corner, corner + Vec3::new(2.0, 0.5, 2.0)]),
            _ => hall.clone(),
        }
    };
    let [mut alone, mut reused] =
        [None, reproject(0.05)].map(|reuse| Run::sized(SIZE, gpu, &effect, reuse));
    let still = hall.stage(camera(0));
    for frame in 0..56 {
        let stage = with_mover(frame).stage(camera(frame));
        let fresh = colors(&alone.frame(&stage, &exact));
        let picture = colors(&reused.frame(&stage, &exact));
        let worst = worst(&picture, &fresh);
        assert!(worst < 0.05, "{frame}: {worst}");
    }
    // The object is seen: without it the picture is another one.
    let with = Run::sized(SIZE, gpu, &effect, None).frame(&with_mover(0).stage(camera(0)), &exact);
    let without = Run::sized(SIZE, gpu, &effect, None).frame(&still, &exact);
    assert!(worst(&colors(&with), &colors(&without)) > 0.5);
}

/// A cut is computed anew; where the camera rests, all is exact again after eight frames, and then stays.
#[test]
fn cuts_are_computed_and_cameras_that_rest_are_exact() {
    let Some(gpu) = device_or_skip("cuts and rests") else {
        return;
    };
    let effect = on::effect(gpu);
    let exact = technique("min-max", &[]);
    let hall = Hall::new(lights()[0]);
    let mut reused = Run::sized(SIZE, gpu, &effect, reproject(0.05));
    let mut off = Run::sized(SIZE, gpu, &effect, Some(Reuse::default()));
    let mut stale = Vec::new();
    for frame in [0, 1, 2].into_iter().chain([3; 10]) {
        let stage = hall.stage(camera(frame));
        let [picture, computed] = [&mut reused, &mut off].map(|run| run.frame(&stage, &exact));
        let is_same = picture == computed;
        stale.push((reused.stale()[0], off.stale()[0], is_same));
    }
    println!("{stale:?}");
    // Without a tolerance, each camera's first frame is computed whole.
    assert!((0..4).all(|i| stale[i].1 == PIXELS) && (4..13).all(|i| stale[i].1 == 0));
    assert!(stale[0].0 == PIXELS && (1..4).all(|i| stale[i].0 < PIXELS));
    assert!(!stale[3].2 && (4..12).any(|i| stale[i].0 > 0));
    assert!(stale[11].2 && stale[12] == (0, 0, true), "{stale:?}");
    let mut stage = hall.stage(camera(3));
    stage.frame.camera.forward = [0.9, 0.0, 0.4];
    stage.frame.camera.eye = [1.0, 2.0, 1.0];
    stage.depth = hall.depth(&stage.frame.camera);
    reused.frame(&stage, &exact);
    assert_eq!(reused.stale(), [PIXELS]);
}

#[test]
fn tolerances_are_checked() {
    let Some(gpu) = device_or_skip("tolerances") else {
        return;
    };
    let effect = on::effect(gpu);
    let stage = Hall::new(lights()[0]).stage(camera(0));
    for tolerance in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let mut run = Run::sized(SIZE, gpu, &effect, reproject(tolerance));
        let refused = run.prepare_with(&stage, &technique("min-max", &[]), None);
        let expected = format!("`reuse.reproject` must be a finite number > 0, found {tolerance}");
        assert_eq!(refused.expect_err("a bad one").to_string(), expected);
    }
}
