//! Exact shadows on view rays against shadow rays from points on them.

use glam::{DVec3, Vec2, Vec3, vec2, vec3};
use tyndall::cpu::{LightSource, Occluders, Shade};

use super::Tracer;
use crate::{
    scene::{Blocking, Scene, Texture, Wrap},
    test_scenes::{Random, ball, block, material, opaque, quad, scene, soup},
    view::Ray,
};

/// Points on a view ray this close to the end of a shade may be on either side of it, relative to half the scene's size.
/// Grazing hits amplify rounding.
const BORDER: f64 = 1e-9;

/// Rays a case; each is compared at 24 points.
const RAYS: usize = 400;

fn shades(tracer: &Tracer, ray: &Ray, length: f64, light: LightSource) -> Vec<Shade> {
    let mut shades = Vec::new();
    tracer.shades(
        ray.origin.into(),
        ray.direction.into(),
        length,
        light,
        &mut shades,
    );
    shades
}

/// The rest of the light at a point of a ray, by its shades.
fn by_shades(shades: &[Shade], s: f64) -> DVec3 {
    shades
        .iter()
        .filter(|shade| (shade.start..shade.end).contains(&s))
        .map(|shade| DVec3::from(shade.tint))
        .product()
}

/// The rest of the light at a point, by a shadow ray.
fn by_shadow_ray(tracer: &Tracer, point: DVec3, light: LightSource, size: f64) -> DVec3 {
    let (direction, distance) = match light {
        LightSource::Direction(d) => (-DVec3::from(d), 100.0 * size),
        LightSource::Position(p) => {
            let offset = DVec3::from(p) - point;
            (offset.normalize(), offset.length())
        }
    };
    let ray = Ray {
        origin: point,
        direction,
    };
    let range = [1e-9 * size, distance];
    if tracer.blocked(&ray, range) {
        return DVec3::ZERO;
    }
    let mut glass = Vec::new();
    tracer.glass(&ray, range, &mut glass);
    glass.iter().map(|hit| hit.tint).product()
}

/// Points of random rays: that differ by more than a tolerance, that were compared, that are not fully lit, and that are
/// too close to a border to be compared.
#[derive(Default)]
struct Comparison {
    wrong: usize,
    compared: usize,
    shaded: usize,
    at_borders: usize,
}

impl Comparison {
    fn compare(&mut self, found: DVec3, expected: DVec3, tolerance: f64) {
        self.compared += 1;
        self.shaded += usize::from(expected != DVec3::ONE);
        self.wrong += usize::from((found - expected).abs().max_element() > tolerance);
    }

    /// At most these shares of wrong points and of points too near to a border; some points must be shaded.
    fn check(&self, case: &str, wrong: f64, at_borders: f64) {
        let compared = self.compared as f64;
        let counts = format!(
            "{case}: {} of {} wrong, {} shaded, {} at borders",
            self.wrong, self.compared, self.shaded, self.at_borders
        );
        println!("{counts}");
        assert!(self.compared > 0 && self.shaded > 0, "{counts}");
        assert!(self.wrong as f64 <= wrong * compared, "{counts}");
        assert!(self.at_borders as f64 <= at_borders * compared, "{counts}");
    }
}

fn compare(scene: &Scene, rays: usize, tolerance: f64, light: &LightOf, seed: u64) -> Comparison {
    let tracer = Tracer::new(scene);
    let bounds = tracer.geometry().bounds().unwrap();
    let (center, half) = (bounds.center().as_dvec3(), 0.5 * bounds.extent().as_dvec3());
    let size = half.max_element();
    let mut random = Random::new(seed);
    let mut counts = Comparison::default();
    for _ in 0..rays {
        let (from, to) = (
            center + 2.0 * half * random.point(),
            center + 1.5 * half * random.point(),
        );
        let ray = Ray {
            origin: from,
            direction: (to - from).normalize(),
        };
        // Every second ray goes on through the surfaces it meets.
        let length = tracer
            .closest(&ray, [0.0, 6.0 * size])
            .filter(|_| random.unit() < 0.5)
            .map_or(6.0 * size, |hit| hit.distance);
        let light = light(&mut random, &ray, size);
        let shades = shades(&tracer, &ray, length, light);
        for _ in 0..24 {
            let s = length * random.unit();
            let near_border = |x: f64| (x - s).abs() < BORDER * size;
            if shades
                .iter()
                .any(|shade| near_border(shade.start) || near_border(shade.end))
            {
                counts.at_borders += 1;
                continue;
            }
            let expected = by_shadow_ray(&tracer, ray.at(s), light, size);
            let found = by_shades(&shades, s);
            counts.compare(found, expected, tolerance);
        }
    }
    counts
}

fn sun(random: &mut Random, _: &Ray, _: f64) -> LightSource {
    LightSource::Direction(random.point().normalize().into())
}

fn lamp(random: &mut Random, ray: &Ray, size: f64) -> LightSource {
    LightSource::Position((ray.at(2.0 * size) + size * random.point()).into())
}

/// Almost along the ray, from before or behind.
fn grazing_sun(random: &mut Random, ray: &Ray, _: f64) -> LightSource {
    let side = if random.unit() < 0.5 { -1.0 } else { 1.0 };
    let off = 10_f64.powf(-8.0 * random.unit()) * random.point();
    LightSource::Direction((side * ray.direction + off).normalize().into())
}

/// Almost on the ray's line: before it, on it or beyond it.
fn lamp_near_ray(random: &mut Random, ray: &Ray, size: f64) -> LightSource {
    let off = 10_f64.powf(-7.0 * random.unit()) * random.point();
    LightSource::Position((ray.at(size * (8.0 * random.unit() - 2.0)) + size * off).into())
}

fn lamp_at_eye(random: &mut Random, ray: &Ray, _: f64) -> LightSource {
    let off = if random.unit() < 0.5 {
        DVec3::ZERO
    } else {
        1e-6 * random.point()
    };
    LightSource::Position((ray.origin + off).into())
}

fn sun_along_ray(random: &mut Random, ray: &Ray, _: f64) -> LightSource {
    let side = if random.unit() < 0.5 { -1.0 } else { 1.0 };
    LightSource::Direction((side * ray.direction).into())
}

/// A row of slats across the cube, as thin as triangles are.
fn slats() -> Vec<[Vec3; 3]> {
    (0..40)
        .flat_map(|i| {
            quad(
                vec3(-1.0, 0.05 * i as f32 - 1.0, 0.0),
                2.0 * Vec3::X,
                vec3(0.0, 0.02, 0.03),
            )
        })
        .collect()
}

fn town() -> Vec<[Vec3; 3]> {
    let mut random = Random::new(7);
    let mut houses = quad(vec3(-1.0, -1.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z).to_vec();
    for i in 0..6 {
        for j in 0..6 {
            let corner = vec3(i as f32, 0.0, j as f32) / 3.0 - 1.0;
            let height = 0.1 + random.unit() as f32;
            houses.extend(block(corner, corner + vec3(0.2, height, 0.2)));
        }
    }
    houses
}

fn opaque_scenes() -> Vec<(&'static str, Scene)> {
    let balls = [
        ball(Vec3::ZERO, 0.6, 24),
        ball(vec3(0.7, 0.3, -0.4), 0.3, 16),
    ]
    .concat();
    vec![
        ("soup", opaque(&soup(1500, 1))),
        ("balls", opaque(&balls)),
        ("slats", opaque(&slats())),
        ("town", opaque(&town())),
    ]
}

/// Given the ray and half the scene's size.
type LightOf = dyn Fn(&mut Random, &Ray, f64) -> LightSource;

const LIGHTS: [(&str, &LightOf); 6] = [
    ("sun", &sun),
    ("lamp", &lamp),
    ("grazing sun", &grazing_sun),
    ("lamp near ray", &lamp_near_ray),
    ("lamp at eye", &lamp_at_eye),
    ("sun along ray", &sun_along_ray),
];

#[test]
fn opaque_shades_are_those_of_shadow_rays() {
    for (name, scene) in opaque_scenes() {
        for (light_name, light) in LIGHTS {
            let found = compare(&scene, RAYS, 0.0, light, 11);
            // Measured: none wrong, none at borders.
            found.check(&format!("{name}, {light_name}"), 0.0, 1e-3);
        }
    }
}

/// A wavy wall in the cube's middle, with its texture once across in `x` and `y`.
fn wall() -> Vec<[Vec3; 3]> {
    let point = |i: i32, j: i32| {
        vec3(
            0.25 * i as f32 - 1.0,
            0.25 * j as f32 - 1.0,
            0.1 * ((i + 2 * j) % 3) as f32,
        )
    };
    (0..8)
        .flat_map(|i| (0..8).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

fn noise_texture(size: [u32; 2], wrap: Wrap, seed: u64) -> Texture {
    let mut random = Random::new(seed);
    let mut byte = || (256.0 * random.unit()) as u8;
    Texture {
        size,
        texels: (0..size[0] * size[1])
            .map(|_| std::array::from_fn(|_| byte()))
            .collect(),
        wrap: [wrap; 2],
    }
}

fn textured(blocking: Blocking, size: [u32; 2], wrap: Wrap) -> Scene {
    let uv = |p: Vec3| vec2(1.3 * p.x + 0.2, 1.7 * p.y - 0.3);
    scene(
        &wall(),
        uv,
        material(blocking, [0.9, 0.8, 1.0, 0.9]),
        Some(noise_texture(size, wrap, 3)),
    )
}

#[test]
fn holes_are_those_of_shadow_rays() {
    for (size, wrap) in [
        ([16, 8], Wrap::Repeat),
        ([5, 7], Wrap::MirroredRepeat),
        ([32, 32], Wrap::ClampToEdge),
    ] {
        let scene = textured(Blocking::Masked { cutoff: 0.5 }, size, wrap);
        for (name, light) in LIGHTS {
            let found = compare(&scene, RAYS, 0.0, light, 12);
            found.check(&format!("{wrap:?}, {name}"), 0.0, 1e-3);
        }
    }
}

#[test]
fn plain_glass_tints_as_along_shadow_rays() {
    let tints = [
        (
            Blocking::Transmissive { transmission: 0.8 },
            [0.9, 0.2, 0.5, 1.0],
        ),
        (Blocking::Blended, [0.1, 0.9, 0.4, 0.6]),
    ];
    for (blocking, base_color) in tints {
        let glass = scene(
            &soup(300, 4),
            |_| Vec2::ZERO,
            material(blocking, base_color),
            None,
        );
        for (name, light) in LIGHTS {
            // 1e-12: products in another order.
            let found = compare(&glass, RAYS, 1e-12, light, 13);
            found.check(&format!("{blocking:?}, {name}"), 0.0, 1e-3);
        }
    }
}

#[test]
fn textured_glass_is_piecewise_constant_but_right_on_average() {
    let mut random = Random::new(14);
    let scene = textured(
        Blocking::Transmissive { transmission: 1.0 },
        [16, 8],
        Wrap::Repeat,
    );
    let tracer = Tracer::new(&scene);
    let (mut error, mut mean) = (0.0, 0.0);
    for _ in 0..RAYS {
        let origin = 2.0 * random.point();
        let ray = Ray {
            origin,
            direction: (1.5 * random.point() - origin).normalize(),
        };
        let light = LightSource::Direction(random.point().normalize().into());
        let shades = shades(&tracer, &ray, 4.0, light);
        let samples = 2000;
        let total = |of: &dyn Fn(f64) -> DVec3| -> DVec3 {
            (0..samples)
                .map(|i| of(4.0 * (f64::from(i) + 0.5) / f64::from(samples)))
                .sum()
        };
        let found = total(&|s| by_shades(&shades, s));
        let expected = total(&|s| by_shadow_ray(&tracer, ray.at(s), light, 1.0));
        error += (found - expected).abs().element_sum();
        mean += expected.element_sum();
    }
    let relative = error / mean;
    println!("textured glass: relative error {relative:e}");
    // Measured: 5.1e-4.
    assert!(relative < 1e-3, "relative error {relative:e}");
}

#[test]
fn clear_glass_and_nothing_shade_nothing() {
    let clear = material(Blocking::Transmissive { transmission: 1.0 }, [1.0; 4]);
    let white = Texture {
        size: [2, 2],
        texels: vec![[255; 4]; 4],
        wrap: [Wrap::Repeat; 2],
    };
    for scene in [
        Scene::default(),
        opaque(&[[Vec3::ZERO; 3], [Vec3::X, Vec3::ZERO, Vec3::NEG_X]]),
        scene(&wall(), |p| p.truncate(), clear.clone(), None),
        scene(&wall(), |p| p.truncate(), clear, Some(white)),
    ] {
        let tracer = Tracer::new(&scene);
        assert!(!tracer.has_tinted_glass());
        for (_, light) in LIGHTS {
            let mut random = Random::new(15);
            let ray = Ray {
                origin: DVec3::new(0.1, -0.2, -3.0),
                direction: DVec3::Z,
            };
            let light = light(&mut random, &ray, 1.0);
            assert_eq!(shades(&tracer, &ray, 6.0, light), []);
        }
    }
}

/// The closed form: a lamp above a square plate throws a shadow of known size on a horizontal ray below it.
#[test]
fn a_plate_s_shadow_has_the_length_of_similar_triangles() {
    let tracer = Tracer::new(&opaque(&quad(vec3(-0.5, 1.0, -0.5), Vec3::X, Vec3::Z)));
    let ray = Ray {
        origin: DVec3::new(-4.0, 0.0, 0.125),
        direction: DVec3::X,
    };
    for (light, [start, end]) in [
        (LightSource::Position([0.0, 2.0, 0.0]), [3.0, 5.0]),
        (LightSource::Position([0.5, 3.0, 0.25]), [2.75 + 0.25, 4.5]),
        (LightSource::Direction([0.0, -1.0, 0.0]), [3.5, 4.5]),
        (LightSource::Direction([0.6, -0.8, 0.0]), [4.25, 5.25]),
    ] {
        let mut found = shades(&tracer, &ray, 8.0, light);
        found.sort_by(|a, b| a.start.total_cmp(&b.start));
        let [first, second] = found[..] else {
            panic!("{light:?}: the plate's two triangles, found {found:?}");
        };
        assert_eq!(first.end, second.start, "{light:?}");
        let error = (first.start - start).abs().max((second.end - end).abs());
        assert!(
            error < 1e-14,
            "{light:?}: [{}, {}]",
            first.start,
            second.end
        );
    }
}

/// The surface that a ray ends on does not shade it from the front and shades all of it from behind.
#[test]
fn the_surface_at_the_ray_s_end_shades_from_behind_only() {
    let tracer = Tracer::new(&opaque(&quad(
        vec3(-500.0, 0.0, -500.0),
        1000.0 * Vec3::X,
        1000.0 * Vec3::Z,
    )));
    let mut random = Random::new(16);
    for _ in 0..1000 {
        let (origin, end) = (
            random.point() + 1.01 * DVec3::Y,
            2.0 * random.point() * DVec3::new(1.0, 0.0, 1.0),
        );
        // As from a depth buffer: rounded to f32.
        let length = f64::from((end - origin).length() as f32);
        let ray = Ray {
            origin,
            direction: (end - origin).normalize(),
        };
        let away = random.point() - 1.01 * DVec3::Y;
        let shaded = |light: LightSource| -> f64 {
            let shades = shades(&tracer, &ray, length, light);
            shades.iter().map(|shade| shade.end - shade.start).sum()
        };
        for (front, behind) in [
            (
                LightSource::Direction(away.into()),
                LightSource::Direction((-away).into()),
            ),
            (
                LightSource::Position((-away).into()),
                LightSource::Position(away.into()),
            ),
        ] {
            // 1e-5: rounding of the length (1e-7), over the smallest sine of the ray's angle with the surface.
            assert!(shaded(front) < 1e-5, "{front:?}: {}", shaded(front));
            assert!(
                (shaded(behind) - length).abs() < 1e-5,
                "{behind:?}: {}",
                shaded(behind)
            );
        }
    }
}

/// Compares shades with shadow rays on real models, where the shared assets are present.
#[test]
fn models_shades_are_those_of_shadow_rays() {
    let assets = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    for name in ["sibenik.glb", "hall.glb", "terrain.glb", "city.glb"] {
        let path = assets.join(name);
        if !path.exists() {
            eprintln!("skipped: {} is missing", path.display());
            continue;
        }
        let scene = crate::load::load(&path).unwrap();
        for (light_name, light) in LIGHTS {
            // Measured: none wrong, none at borders. 1e-12: products of tints in another order.
            let found = compare(&scene, 100, 1e-12, light, 17);
            found.check(&format!("{name}, {light_name}"), 0.0, 1e-3);
        }
    }
}

/// The comparison must notice a wrong light: one from elsewhere, here.
#[test]
#[should_panic(expected = "wrong")]
fn the_comparison_can_fail() {
    let tracer_scene = opaque(&soup(1500, 1));
    let tracer = Tracer::new(&tracer_scene);
    let ray = Ray {
        origin: DVec3::new(0.0, 0.0, -2.0),
        direction: DVec3::Z,
    };
    let found = shades(&tracer, &ray, 4.0, LightSource::Direction([1.0, 0.0, 0.0]));
    let other = LightSource::Direction([0.0, 1.0, 0.0]);
    let mut counts = Comparison::default();
    for i in 0..100 {
        let s = 0.04 * f64::from(i);
        counts.compare(
            by_shades(&found, s),
            by_shadow_ray(&tracer, ray.at(s), other, 1.0),
            0.0,
        );
    }
    counts.check("light from elsewhere", 0.0, 0.0);
}
