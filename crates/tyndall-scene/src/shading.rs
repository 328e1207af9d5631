//! Surfaces lit by the frame's lights: Lambert, shadow-mapped. The arithmetic is spelled out so that a shader can do
//! the same.
//!
//! Radiance towards the eye of a surface with base colour `c`, unit normal `n` and point `p`:
//!
//! `view_tint * (emissive + c / pi * sum over lights of (visibility * max(-n . l, 0) * full + ambient * bare))`
//!
//! where `l` is the way the light travels and `full` the irradiance on a surface facing it: with the spot's cone and the
//! light's texture, and for local lights exp(-sigma_t d) / d^2 ([`LightModel::incident`]). `bare` is the same without
//! cone and texture; times `ambient` = [`AMBIENT`] * (1 + [`AMBIENT_TILT`] * n.y) it keeps what is unlit from being
//! quite black. Attenuation between surface and eye is left to the composite.
//!
//! **Visibility** compares depths at the four texels round a point, weighted bilinearly, each multiplied by the tints of
//! the glass layers before the point. The point is `p` moved along `n` by [`NORMAL_OFFSET_TEXELS`] texels, as large as
//! texels are at `p`. The four texels are at most sqrt(2) texels away; on a plane of any slope an offset of as much
//! clears the depths there, and the rest is for curved surfaces. Texels outside the map are lit; a cube's are clamped to
//! the face. A texel where nothing was drawn is lit.
//!
//! **Rectangles** have no shadow map. They shine as [`RECT_SAMPLES`] points, unblocked; visibility is the share of their
//! light that arrives of as many samples as the light itself says: traced on the CPU, through glass as well, and on the GPU
//! what a technique of tyndall's found.
//!
//! **Sky**, where there is no surface: from [`SKY_HORIZON`] to [`SKY_ZENITH`] with the height of the view ray's
//! direction, times the directional lights' illuminance and the view tint. A scene without a sun has a black sky.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use tyndall::{
    camera::CameraRays,
    cpu::{CpuLightInputs, GlassMap, ShadowMap},
    frame::{Emitter, Frame, Light, ShadowProjection},
    light::LightModel,
    physics::medium::Optics,
    shadow,
};

use crate::{
    trace::{GBuffer, Tracer},
    view::Ray,
};

/// How far a point moves along its normal before its shadow is looked up [texels].
pub const NORMAL_OFFSET_TEXELS: f64 = 2.0;
/// Irradiance from all around, relative to what a light would give a surface that faces it unblocked.
pub const AMBIENT: f64 = 0.03;
/// How much more of it falls on what faces up, and less on what faces down.
pub const AMBIENT_TILT: f64 = 0.5;
/// Radiance of the sky at the horizon and below, relative to the sun's illuminance [1/sr].
pub const SKY_HORIZON: [f64; 3] = [0.020, 0.024, 0.029];
/// Radiance of the sky overhead, relative to the sun's illuminance [1/sr].
pub const SKY_ZENITH: [f64; 3] = [0.006, 0.011, 0.022];
/// Points that a rectangular light is taken as.
pub const RECT_SAMPLES: u32 = 16;
/// How far off their surface rays to a rectangular light begin, over the distance to the eye: above what the depth buffer
/// leaves open.
const OFF_SURFACE: f64 = 1e-4;

/// Radiance of what the camera sees [W/(m^2 sr)], linear RGB, row by row from the top left; without the medium between
/// it and the eye. `lights` has one entry a light of the frame, in the same order. What blocks rectangular lights is traced;
/// nothing blocks them where there is no tracer.
pub fn shade(
    g_buffer: &GBuffer,
    frame: &Frame,
    lights: &[CpuLightInputs<'_>],
    tracer: Option<&Tracer>,
) -> Vec<[f32; 3]> {
    let scene_lights: Vec<SurfaceLight<'_>> = frame
        .lights
        .iter()
        .zip(lights)
        .map(|(light, inputs)| SurfaceLight::new(light, inputs, tracer))
        .collect();
    let shading = Shading {
        g_buffer,
        rays: CameraRays::new(&frame.camera, g_buffer.size),
        far_value: frame.camera.depth_range.far_value(),
        optics: Optics::new(&frame.medium),
        lights: scene_lights,
        sun: frame.lights.iter().map(sun_illuminance).sum(),
    };
    (0..g_buffer.depth.len())
        .into_par_iter()
        .map(|pixel| shading.radiance(pixel).as_vec3().to_array())
        .collect()
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

pub(crate) fn sun_illuminance(light: &Light) -> DVec3 {
    match light.emitter {
        Emitter::Directional { illuminance, .. } => vector(illuminance),
        _ => DVec3::ZERO,
    }
}

/// Radiance of the sky in a direction.
fn sky(direction: DVec3, sun: DVec3) -> DVec3 {
    sun * DVec3::from(SKY_HORIZON).lerp(SKY_ZENITH.into(), direction.y.clamp(0.0, 1.0))
}

struct Shading<'a> {
    g_buffer: &'a GBuffer,
    rays: CameraRays,
    far_value: f32,
    optics: Optics,
    lights: Vec<SurfaceLight<'a>>,
    /// Illuminance of the directional lights together [W/m^2].
    sun: DVec3,
}

impl Shading<'_> {
    fn radiance(&self, pixel: usize) -> DVec3 {
        let [width, _] = self.g_buffer.size;
        let (x, y) = (pixel as u32 % width, pixel as u32 / width);
        let depth = self.g_buffer.depth[pixel];
        let ray = self.rays.ray(x, y, depth);
        let tint = vector(self.g_buffer.view_tint[pixel]);
        if depth == self.far_value {
            return tint * sky(ray.direction, self.sun);
        }
        let surface = SurfacePoint {
            point: ray.at(ray.length),
            normal: vector(self.g_buffer.normal[pixel]),
            distance: ray.length,
        };
        let irradiance: DVec3 = self
            .lights
            .iter()
            .map(|light| light.irradiance(&surface, &self.optics))
            .sum();
        let reflected = vector(self.g_buffer.base_color[pixel]) / PI * irradiance;
        tint * (reflected + vector(self.g_buffer.emissive[pixel]))
    }
}

/// What a pixel sees.
struct SurfacePoint {
    point: DVec3,
    /// Unit, facing the viewer.
    normal: DVec3,
    /// From where the view ray starts [m].
    distance: f64,
}

/// A light as surfaces see it.
struct SurfaceLight<'a> {
    samples: Vec<LightModel<'a>>,
    /// The light without cone and texture.
    bare: Vec<LightModel<'a>>,
    shadow: Option<SurfaceShadow<'a>>,
    traced: Option<TracedShadow<'a>>,
}

impl<'a> SurfaceLight<'a> {
    fn new(light: &Light, inputs: &CpuLightInputs<'a>, tracer: Option<&'a Tracer>) -> Self {
        let mut sampled = *light;
        if let Emitter::Rect { samples, .. } = &mut sampled.emitter {
            *samples = RECT_SAMPLES;
        }
        Self {
            samples: LightModel::samples(&sampled, inputs.texture),
            bare: LightModel::samples(&bare(light), None),
            shadow: SurfaceShadow::new(light, inputs),
            traced: tracer
                .filter(|_| matches!(light.emitter, Emitter::Rect { .. }))
                .map(|tracer| TracedShadow {
                    samples: LightModel::samples(light, inputs.texture),
                    tracer,
                }),
        }
    }

    /// Irradiance on a surface, direct and ambient [W/m^2].
    fn irradiance(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let (point, normal) = (surface.point, surface.normal);
        let direct: DVec3 = self
            .samples
            .iter()
            .map(|sample| {
                let incident = sample.incident(point, optics);
                incident.irradiance * (-normal.dot(incident.direction)).max(0.0)
            })
            .sum();
        let bare: DVec3 = self
            .bare
            .iter()
            .map(|sample| sample.incident(point, optics).irradiance)
            .sum();
        let ambient = AMBIENT * (1.0 + AMBIENT_TILT * normal.y) * bare;
        if direct == DVec3::ZERO {
            return ambient;
        }
        let mapped = self.shadow.as_ref();
        let mapped = mapped.map_or(DVec3::ONE, |shadow| shadow.visibility(point, normal));
        let traced = self.traced.as_ref();
        let traced = traced.map_or(DVec3::ONE, |shadow| shadow.visibility(surface, optics));
        ambient + mapped * traced * direct
    }
}

/// A rectangle's samples, and what blocks them.
struct TracedShadow<'a> {
    samples: Vec<LightModel<'a>>,
    tracer: &'a Tracer,
}

impl TracedShadow<'_> {
    /// The share of the light that arrives; all of it where there is none.
    fn visibility(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let (mut arriving, mut all) = (DVec3::ZERO, DVec3::ZERO);
        let point = surface.point + OFF_SURFACE * surface.distance * surface.normal;
        for sample in &self.samples {
            let incident = sample.incident(surface.point, optics);
            let received = (-surface.normal.dot(incident.direction)).max(0.0);
            let light = received * incident.irradiance;
            if let (Some(position), true) = (sample.position(), light != DVec3::ZERO) {
                all += light;
                arriving += light * self.tint(point, position);
            }
        }
        DVec3::select(all.cmpgt(DVec3::ZERO), arriving / all, DVec3::ONE)
    }

    /// What light is multiplied by on its way from one point to another.
    fn tint(&self, point: DVec3, light: DVec3) -> DVec3 {
        let distance = (light - point).length();
        let ray = Ray {
            origin: point,
            direction: (light - point) / distance,
        };
        if self.tracer.blocked(&ray, [0.0, distance]) {
            return DVec3::ZERO;
        }
        let mut glass = Vec::new();
        self.tracer.glass(&ray, [0.0, distance], &mut glass);
        glass.iter().map(|hit| hit.tint).product()
    }
}

/// A light of the same strength that shines evenly: a spot without its cone, a rectangle as a point in its middle with
/// the intensity of its bright side.
fn bare(light: &Light) -> Light {
    let emitter = match light.emitter {
        Emitter::Spot {
            position,
            intensity,
            ..
        } => Emitter::Point {
            position,
            intensity,
        },
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            ..
        } => {
            let area = vector(edge_x).cross(vector(edge_y)).length() as f32;
            Emitter::Point {
                position: center,
                intensity: radiance.map(|l| l * area),
            }
        }
        plain => plain,
    };
    Light {
        emitter,
        shadow: None,
        texture: None,
    }
}

/// A shadow map with its glass, filtered.
struct SurfaceShadow<'a> {
    faces: Vec<shadow::Face>,
    /// Where a cube's faces meet; unused for a single map.
    center: DVec3,
    reversed: bool,
    map: &'a ShadowMap,
    glass: Option<&'a GlassMap>,
}

impl<'a> SurfaceShadow<'a> {
    fn new(light: &Light, inputs: &CpuLightInputs<'a>) -> Option<Self> {
        let projection = light.shadow?;
        let (ShadowProjection::Single { reversed_depth, .. }
        | ShadowProjection::Cube { reversed_depth, .. }) = projection;
        Some(Self {
            faces: shadow::faces(&light.emitter, &projection)?,
            center: match light.emitter {
                Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                    vector(position)
                }
                Emitter::Directional { .. } | Emitter::Rect { .. } => DVec3::ZERO,
            },
            reversed: reversed_depth,
            map: inputs.shadow_map?,
            glass: inputs.glass,
        })
    }

    /// What light that reaches a surface is multiplied by.
    fn visibility(&self, point: DVec3, normal: DVec3) -> DVec3 {
        let offset = NORMAL_OFFSET_TEXELS * self.texel_size(point);
        let point = point + offset * normal;
        let face = self.face_of(point);
        let clip = self.faces[face].clip_from_world * point.extend(1.0);
        // Behind the light.
        if clip.w <= 0.0 {
            return DVec3::ONE;
        }
        let size = DVec2::from(self.map.size.map(f64::from));
        let ndc = clip.truncate() / clip.w;
        let texel = DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * size - 0.5;
        let (corner, share) = (texel.floor(), texel - texel.floor());
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
            .into_iter()
            .map(|(dx, dy)| {
                let weights = DVec2::new(
                    if dx == 0.0 { 1.0 - share.x } else { share.x },
                    if dy == 0.0 { 1.0 - share.y } else { share.y },
                );
                let tint = self.texel_tint(face, corner + DVec2::new(dx, dy), ndc.z);
                weights.element_product() * tint
            })
            .sum()
    }

    /// Edge of a texel at a point's distance from the light [m].
    fn texel_size(&self, point: DVec3) -> f64 {
        let matrix = self.faces[self.face_of(point)].clip_from_world;
        let rows = [matrix.row(0), matrix.row(1)].map(|row| row.truncate().length());
        let per_meter =
            (rows[0] * f64::from(self.map.size[0])).min(rows[1] * f64::from(self.map.size[1]));
        2.0 * (matrix * point.extend(1.0)).w.max(0.0) / per_meter
    }

    /// The tint of light that has passed one texel, for a point at `depth` (1 nearest to the light).
    fn texel_tint(&self, face: usize, texel: DVec2, depth: f64) -> DVec3 {
        let last = DVec2::from(self.map.size.map(f64::from)) - 1.0;
        let clamped = texel.clamp(DVec2::ZERO, last);
        if self.faces.len() == 1 && clamped != texel {
            return DVec3::ONE;
        }
        let [width, height] = self.map.size.map(|n| n as usize);
        let index = clamped.y as usize * width + clamped.x as usize;
        let hides = |stored: f32| {
            let stored = if self.reversed {
                f64::from(stored)
            } else {
                1.0 - f64::from(stored)
            };
            stored > 0.0 && depth < stored
        };
        if hides(self.map.depth[face * width * height + index]) {
            return DVec3::ZERO;
        }
        let Some(glass) = self.glass else {
            return DVec3::ONE;
        };
        let layers = glass.layers as usize;
        (face * layers..(face + 1) * layers)
            .map(|layer| glass.texels[layer * width * height + index])
            .filter(|[.., stored]| hides(*stored))
            .map(|[r, g, b, _]| vector([r, g, b]))
            .product()
    }

    /// The face whose axis is nearest to the direction from the centre.
    fn face_of(&self, point: DVec3) -> usize {
        if self.faces.len() == 1 {
            return 0;
        }
        let q = point - self.center;
        let axis = q.abs().max_position();
        2 * axis + usize::from(q[axis] < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3, vec3};
    use tyndall::frame::{Camera, Medium, MediumComponent, Phase};

    use super::*;
    use crate::{
        geometry::Geometry,
        scene::{Blocking, Scene},
        shadow_fit,
        trace::{
            GLASS_LAYERS, Tracer,
            test_scenes::{ball, block, material, opaque, quad, scene},
        },
    };

    /// On the ground.
    const AMBIENT_UP: f64 = AMBIENT * (1.0 + AMBIENT_TILT);

    const SIZE: [u32; 2] = [48, 48];

    /// Looks down from y = 6 onto 6 x 6 m of the ground.
    fn from_above() -> Camera {
        let half = 0.5_f32;
        Camera::perspective(
            [0.0, 6.0, 0.0],
            [0.0; 3],
            [0.0, 0.0, -1.0],
            2.0 * half.atan(),
            1.0,
            0.1,
            50.0,
        )
    }

    fn ground() -> Vec<[Vec3; 3]> {
        quad(vec3(-20.0, 0.0, -20.0), 40.0 * Vec3::X, 40.0 * Vec3::Z).to_vec()
    }

    fn light(emitter: Emitter) -> Light {
        Light {
            emitter,
            shadow: None,
            texture: None,
        }
    }

    fn frame(lights: Vec<Light>, sigma_a: f32) -> Frame {
        Frame {
            camera: from_above(),
            lights,
            medium: Medium {
                components: vec![MediumComponent {
                    sigma_s: [0.0; 3],
                    sigma_a: [sigma_a; 3],
                    phase: Phase::Isotropic,
                }],
            },
        }
    }

    /// The picture of a scene under one light with its fitted map of `texels` a side.
    fn picture(scene: &Scene, emitter: Emitter, texels: Option<u32>, sigma_a: f32) -> Vec<DVec3> {
        let tracer = Tracer::new(scene);
        let mut light = light(emitter);
        light.shadow = texels.and_then(|_| shadow_fit::fit(tracer.geometry(), &emitter));
        let map_size = [texels.unwrap_or(1); 2];
        let quiet = |_, _| ();
        let map = light
            .shadow
            .map(|p| tracer.shadow_map(&emitter, &p, map_size, &quiet));
        let glass = light
            .shadow
            .and_then(|p| tracer.glass_map(&emitter, &p, map_size, GLASS_LAYERS, &quiet));
        let inputs = CpuLightInputs {
            shadow_map: map.as_ref(),
            glass: glass.as_ref(),
            texture: None,
        };
        let frame = frame(vec![light], sigma_a);
        let g_buffer = tracer.g_buffer(&frame.camera, SIZE, &quiet);
        let picture = shade(&g_buffer, &frame, &[inputs], Some(&tracer));
        assert!(picture.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
        picture.into_iter().map(vector).collect()
    }

    /// World-space point of the ground at a pixel.
    fn ground_point(pixel: usize) -> DVec3 {
        let ray =
            CameraRays::new(&from_above(), SIZE).ray(pixel as u32 % 48, pixel as u32 / 48, 0.0);
        ray.at(ray.origin.y / -ray.direction.y)
    }

    const SUN: Emitter = Emitter::Directional {
        direction: [0.6, -0.8, 0.0],
        illuminance: [10.0, 5.0, 2.0],
    };

    #[test]
    fn unblocked_ground_is_lambert_s() {
        let spot_axis = DVec3::new(0.0, -1.0, 0.0);
        let (inner, outer) = (0.3_f32, 0.6_f32);
        let lamp = DVec3::new(0.5, 3.0, -0.5);
        let position = [0.5, 3.0, -0.5];
        let spot = Emitter::Spot {
            position,
            direction: [0.0, -2.0, 0.0],
            intensity: [7.0; 3],
            inner,
            outer,
        };
        let point = Emitter::Point {
            position,
            intensity: [7.0; 3],
        };
        let falloff = |to: DVec3| {
            let (c, i, o) = (
                to.dot(spot_axis),
                f64::from(inner).cos(),
                f64::from(outer).cos(),
            );
            ((c - o) / (i - o)).clamp(0.0, 1.0).powi(2)
        };
        let local = |p: DVec3, cone: bool| {
            let d = (p - lamp).length();
            let to = (p - lamp) / d;
            let irradiance = 7.0 * (-0.1 * d).exp() / (d * d);
            irradiance * (-to.y * if cone { falloff(to) } else { 1.0 } + AMBIENT_UP)
        };
        type Expected<'a> = &'a dyn Fn(DVec3) -> f64;
        let cases: [(Emitter, Expected<'_>); 3] = [
            (SUN, &|_| 10.0 * (0.8 + AMBIENT_UP)),
            (point, &|p| local(p, false)),
            (spot, &|p| local(p, true)),
        ];
        for (emitter, expected) in cases {
            // With its own shadow map as well: the ground must not shadow itself.
            for texels in [None, Some(64)] {
                for (pixel, found) in picture(&opaque(&ground()), emitter, texels, 0.1)
                    .iter()
                    .enumerate()
                {
                    let expected = 0.5 / PI * expected(ground_point(pixel));
                    // Measured: 1.1e-6; parameters are f32.
                    assert!(
                        (found.x / expected - 1.0).abs() < 4e-6,
                        "{emitter:?}: {}, {expected}",
                        found.x
                    );
                }
            }
        }
    }

    #[test]
    fn shadows_have_the_place_and_size_of_their_blocker() {
        let plate = quad(vec3(-1.0, 2.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z);
        let with_plate = opaque(&[ground(), plate.to_vec()].concat());
        let ambient = 0.5 / PI * 10.0 * AMBIENT_UP;
        let lit = 0.5 / PI * 10.0 * (0.8 + AMBIENT_UP);
        let found = picture(&with_plate, SUN, Some(2048), 0.0);
        let mut counts = [0; 2];
        for (pixel, value) in found.iter().enumerate() {
            let p = ground_point(pixel);
            // The plate hides a square of 3 m of the ground itself; its shadow is 1.5 m to the right.
            if p.x.abs().max(p.z.abs()) < 1.55 {
                continue;
            }
            let outside = (p.x - 1.5).abs().max(p.z.abs()) - 1.0;
            // The map covers 40 m: half a shadow border is two texels of 20 mm.
            if outside.abs() < 0.05 {
                continue;
            }
            let expected = if outside < 0.0 { ambient } else { lit };
            counts[usize::from(outside < 0.0)] += 1;
            assert!(
                (value.x / expected - 1.0).abs() < 1e-5,
                "at {p}: {} for {expected}",
                value.x
            );
        }
        assert!(counts[0] > 1000 && counts[1] > 100, "{counts:?}");
    }

    #[test]
    fn curved_and_flat_surfaces_do_not_shadow_themselves() {
        for emitter in [
            SUN,
            Emitter::Point {
                position: [1.0, 5.0, 2.0],
                intensity: [9.0; 3],
            },
        ] {
            let round = opaque(&[ground(), ball(0.8 * Vec3::Y, 0.8, 48)].concat());
            let (with, without) = (
                picture(&round, emitter, Some(512), 0.0),
                picture(&round, emitter, None, 0.0),
            );
            let tracer = Tracer::new(&round);
            let g_buffer = tracer.g_buffer(&from_above(), SIZE, &|_, _| ());
            let source = LightModel::samples(&light(emitter), None).remove(0);
            let mut acne = 0;
            let mut compared = 0;
            for (pixel, (with, without)) in with.iter().zip(&without).enumerate() {
                let ray = CameraRays::new(&from_above(), SIZE).ray(
                    pixel as u32 % 48,
                    pixel as u32 / 48,
                    g_buffer.depth[pixel],
                );
                let normal = vector(g_buffer.normal[pixel]);
                let incident =
                    source.incident(ray.at(ray.length), &Optics::new(&frame(vec![], 0.0).medium));
                // On the ball's lit side, the first thing light meets.
                if ray.at(ray.length).y > 0.01 && -normal.dot(incident.direction) > 0.15 {
                    compared += 1;
                    acne += usize::from((with.x / without.x - 1.0).abs() > 1e-6);
                }
            }
            assert!(compared > 80, "only {compared} pixels of the ball");
            assert_eq!(acne, 0, "{emitter:?}: of {compared}");
        }
    }

    #[test]
    fn glass_colours_the_ground() {
        let pane = quad(vec3(-2.0, 2.0, -2.0), 4.0 * Vec3::X, 4.0 * Vec3::Z);
        let red = material(
            Blocking::Transmissive { transmission: 1.0 },
            [0.8, 0.1, 0.2, 1.0],
        );
        let mut both = scene(&pane, |_| Vec2::ZERO, red, None);
        let mut floor = opaque(&ground());
        floor.meshes[0].primitives[0].material = 1;
        both.materials.extend(floor.materials);
        both.meshes[0]
            .primitives
            .extend(floor.meshes.remove(0).primitives);
        let found = picture(&both, SUN, Some(256), 0.0);
        // Seen through the pane and lit through it: the middle of the picture.
        let expected =
            0.5 / PI * DVec3::new(10.0, 5.0, 2.0) * (0.8 * DVec3::new(0.8, 0.1, 0.2) + AMBIENT_UP);
        let expected = DVec3::new(0.8, 0.1, 0.2) * expected;
        let middle = found[24 * 48 + 24];
        assert!(
            (middle / expected - 1.0).abs().max_element() < 1e-5,
            "{middle}, {expected}"
        );
    }

    #[test]
    fn the_sky_follows_the_sun() {
        let empty = picture(&Scene::default(), SUN, Some(16), 0.0);
        let below = DVec3::from(SKY_HORIZON) * DVec3::new(10.0, 5.0, 2.0);
        assert!(empty.iter().all(|found| (*found - below).length() < 1e-6));
        let lamp = Emitter::Point {
            position: [0.0; 3],
            intensity: [1.0; 3],
        };
        assert!(
            picture(&Scene::default(), lamp, Some(16), 0.0)
                .iter()
                .all(|found| *found == DVec3::ZERO)
        );
        assert_eq!(sky(DVec3::Y, DVec3::ONE), DVec3::from(SKY_ZENITH));
    }

    #[test]
    fn a_rectangle_is_a_point_from_afar() {
        let height = 40.0;
        let rect = Emitter::Rect {
            center: [0.0, height, 0.0],
            edge_x: [0.5, 0.0, 0.0],
            edge_y: [0.0, 0.0, 0.5],
            radiance: [100.0; 3],
            samples: 256,
        };
        let found = picture(&opaque(&ground()), rect, None, 0.0)[24 * 48 + 24];
        // cross(edge_x, edge_y) points down: the ground is on the bright side.
        let expected = 0.5 / PI * 25.0 / f64::from(height * height) * (1.0 + AMBIENT_UP);
        assert!(
            (found.x / expected - 1.0).abs() < 1e-3,
            "{}, {expected}",
            found.x
        );
    }

    /// Under a plate that hides it: dark in the middle, half lit where the plate's edge halves it, lit far away.
    #[test]
    fn a_rectangle_casts_a_soft_shadow() {
        let rect = Emitter::Rect {
            center: [0.0, 10.0, 0.0],
            edge_x: [0.2, 0.0, 0.0],
            edge_y: [0.0, 0.0, 0.2],
            radiance: [100.0; 3],
            samples: 256,
        };
        // Above the camera, so that it hides nothing of the ground.
        let plate = quad(vec3(-0.1, 8.0, -0.1), 0.2 * Vec3::X, 0.2 * Vec3::Z);
        let open = picture(&opaque(&ground()), rect, None, 0.0);
        let hidden = picture(
            &opaque(&[ground(), plate.to_vec()].concat()),
            rect,
            None,
            0.0,
        );
        let seen = |x: f64| {
            let pixel = (0..hidden.len())
                .min_by_key(|i| {
                    (1e6 * (ground_point(*i) - DVec3::new(x, 0.0, 0.0)).length()) as u64
                })
                .unwrap();
            let ambient = AMBIENT_UP / (1.0 + AMBIENT_UP);
            (hidden[pixel].x / open[pixel].x - ambient) / (1.0 - ambient)
        };
        // The umbra ends at 0.1, the penumbra at 0.9; pixels are 0.125 m.
        assert!(seen(0.0).abs() < 0.01, "{}", seen(0.0));
        assert!((seen(0.5) - 0.5).abs() < 0.15, "{}", seen(0.5));
        assert!((seen(2.0) - 1.0).abs() < 1e-6, "{}", seen(2.0));
    }

    #[test]
    fn a_light_inside_a_corner_stays_finite() {
        let room = block(vec3(-2.0, 0.0, -2.0), vec3(2.0, 5.9, 2.0));
        for position in [[0.0, 0.0, 0.0], [-2.0, 0.0, -2.0], [0.0, 5.9, 0.0]] {
            picture(
                &opaque(&room),
                Emitter::Point {
                    position,
                    intensity: [1.0; 3],
                },
                Some(32),
                0.0,
            );
        }
        assert!(Geometry::new(&opaque(&room)).bounds().is_some());
    }
}
