//! Lit stretches of a ray, and the integral over each: the smooth part of every technique that finds visibility first.

use glam::DVec3;

use super::{integrand::integrand, scene::CpuScene};
use crate::{
    camera::Ray,
    light::LightModel,
    physics::{
        airlight::PointOnRay, quadrature::quadrature, transmittance::transmittance_integral,
    },
    shadow::Shade,
};

/// The integral over the part of `span` that `shades` leave lit, to a relative `tolerance` where it has no closed form.
/// Sorts and empties `shades`.
pub(crate) fn integrate_lit(
    ray: &Ray,
    model: &LightModel<'_>,
    scene: &CpuScene<'_>,
    tolerance: f64,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
) -> DVec3 {
    let integral = Integral::new(ray, model, scene, tolerance);
    sum_lit(ray, model, span, shades, |stretch, tint| {
        tint * integral.over(stretch)
    })
}

/// The sum of what `visit` returns of the stretches of `span` that `shades` leave lit, in which the light is smooth
/// ([`LightModel::breaks`]), and of the product of the tints that lie on each. Sorts and empties `shades`.
pub(crate) fn sum_lit(
    ray: &Ray,
    model: &LightModel<'_>,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
    visit: impl Fn([f64; 2], DVec3) -> DVec3,
) -> DVec3 {
    let mut breaks = Vec::new();
    model.breaks(ray.origin, ray.direction, span, &mut breaks);
    breaks.sort_unstable_by(f64::total_cmp);
    let mut sum = DVec3::ZERO;
    lit_stretches(shades, span, |[from, to], tint| {
        let first = breaks.partition_point(|s| *s <= from);
        let within = breaks[first..].iter().copied().take_while(|s| *s < to);
        let mut a = from;
        for b in within.chain([to]) {
            sum += visit([a, b], tint);
            a = b;
        }
    });
    sum
}

/// Calls `visit` with every stretch of `span` that is not blocked and the product of the tints that lie on it.
/// Sorts and empties `shades`.
fn lit_stretches(shades: &mut Vec<Shade>, span: [f64; 2], mut visit: impl FnMut([f64; 2], DVec3)) {
    shades.retain(|s| s.end > span[0] && s.start < span[1] && s.end > s.start);
    shades.sort_unstable_by(|x, y| x.start.total_cmp(&y.start));
    let tints: Vec<Shade> = shades
        .iter()
        .filter(|s| s.tint != [0.0; 3])
        .copied()
        .collect();
    let mut from = span[0];
    for block in shades.drain(..).filter(|s| s.tint == [0.0; 3]) {
        if block.start > from {
            tinted_stretches(&tints, [from, block.start], &mut visit);
        }
        from = from.max(block.end);
    }
    if from < span[1] {
        tinted_stretches(&tints, [from, span[1]], &mut visit);
    }
}

/// Splits a stretch where tints (sorted by start) begin and end.
fn tinted_stretches(
    tints: &[Shade],
    [from, to]: [f64; 2],
    visit: &mut impl FnMut([f64; 2], DVec3),
) {
    let over: Vec<&Shade> = tints
        .iter()
        .take_while(|t| t.start < to)
        .filter(|t| t.end > from)
        .collect();
    let mut cuts: Vec<f64> = over
        .iter()
        .flat_map(|t| [t.start, t.end])
        .filter(|s| *s > from && *s < to)
        .chain([from, to])
        .collect();
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup();
    let mut active: Vec<&Shade> = Vec::new();
    let mut next = 0;
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        while next < over.len() && over[next].start <= middle {
            active.push(over[next]);
            next += 1;
        }
        active.retain(|t| t.end > middle);
        visit(
            [pair[0], pair[1]],
            active.iter().map(|t| DVec3::from(t.tint)).product(),
        );
    }
}

/// The integral over a lit stretch of a ray.
pub(crate) struct Integral<'a> {
    ray: &'a Ray,
    model: &'a LightModel<'a>,
    scene: &'a CpuScene<'a>,
    tolerance: f64,
    /// The light, unless it is directional.
    light: Option<PointOnRay>,
}

impl<'a> Integral<'a> {
    pub(crate) fn new(
        ray: &'a Ray,
        model: &'a LightModel<'a>,
        scene: &'a CpuScene<'a>,
        tolerance: f64,
    ) -> Self {
        let light = model
            .position()
            .map(|position| PointOnRay::new(position - ray.origin, ray.direction, model.radius()));
        Self {
            ray,
            model,
            scene,
            tolerance,
            light,
        }
    }

    pub(crate) fn over(&self, [a, b]: [f64; 2]) -> DVec3 {
        let optics = &self.scene.optics;
        let f = |s| integrand(self.ray, s, self.model, optics);
        match self.light {
            None if self.model.is_plain() => {
                // Constant along the ray but for extinction.
                let path = optics
                    .sigma_t
                    .to_array()
                    .map(|k| transmittance_integral(k, a, b));
                f(0.0) * DVec3::from(path)
            }
            None => quadrature([a, b], self.tolerance, &f),
            Some(light) => {
                let turn = light.turn([a, b]);
                quadrature([0.0, turn], self.tolerance, &|angle: f64| {
                    let [s, ds] = light.turned(a, angle);
                    f(s.min(b)) * ds
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shade(start: f64, end: f64, tint: f64) -> Shade {
        Shade {
            start,
            end,
            tint: [tint; 3],
        }
    }

    #[test]
    fn stretches_are_what_is_left() {
        let mut shades = vec![
            shade(6.0, 9.0, 0.5),
            shade(1.0, 2.0, 0.0),
            shade(1.5, 3.0, 0.0),
            shade(7.0, 7.5, 0.5),
            shade(-1.0, 0.5, 0.0),
            shade(8.5, 20.0, 0.0),
        ];
        let mut found = Vec::new();
        lit_stretches(&mut shades, [0.0, 10.0], |s, tint| found.push((s, tint.x)));
        assert_eq!(
            found,
            vec![
                ([0.5, 1.0], 1.0),
                ([3.0, 6.0], 1.0),
                ([6.0, 7.0], 0.5),
                ([7.0, 7.5], 0.25),
                ([7.5, 8.5], 0.5),
            ]
        );
    }

    /// `stretch.wesl` as the test harness can bind it: all in group 0, made for one kind of light.
    #[cfg(feature = "gpu")]
    fn stretch_module(kind: u32) -> String {
        use crate::shader::tests::{harness, in_one_group};
        let imports = "
import tyndall::camera::camera::Ray;
import tyndall::light::stretch::stretch_plain;
";
        in_one_group(&harness(imports, &[], &[("LIGHT_KIND", kind)]))
    }

    /// The GPU's closed forms and its four-point panels against f64 quadrature, relative to the entire ray.
    #[cfg(feature = "gpu")]
    #[test]
    fn wgsl_twin_agrees() {
        use crate::{
            camera::CameraRays,
            frame::{Camera, Emitter, Frame, Light, Medium, MediumComponent, Phase},
            gpu::{
                airlight::AirlightTextures,
                uniforms::{FrameUniform, LightUniform},
            },
            physics::medium::Optics,
        };
        use std::f32::consts::FRAC_PI_2;
        use tyndall_testkit::{device::device_or_skip, samples, wgsl};
        use wgpu::util::DeviceExt;
        let Some(gpu) = device_or_skip("stretch.wgsl") else {
            return;
        };
        let component = |scale: f32, phase| MediumComponent {
            sigma_s: [0.04 * scale, 0.06 * scale, 0.09 * scale],
            sigma_a: [0.01, 0.01, 0.02],
            phase,
        };
        let medium = Medium {
            components: vec![
                component(1.0, Phase::HenyeyGreenstein { g: 0.5 }),
                component(0.3, Phase::Rayleigh),
            ],
        };
        let (position, direction) = ([0.4, 1.5, -3.0], [0.3, -0.5, 0.8]);
        let intensity = [4.0, 3.0, 2.0];
        let spot = |inner, outer| Emitter::Spot {
            position,
            direction,
            intensity,
            inner,
            outer,
            radius: 0.0,
        };
        // The emitter, and the bound of its error; measured on lavapipe: 2.3e-7, 3.0e-4, 4.2e-4, 5.7e-5, 3.8e-4, 0, 0.
        let lights = [
            (
                Emitter::Directional {
                    direction,
                    illuminance: intensity,
                },
                1e-6,
            ),
            (
                Emitter::Point {
                    position,
                    intensity,
                    radius: 0.0,
                },
                5e-4,
            ),
            (spot(0.2, 0.5), 6e-4),
            (spot(0.0, 1.3), 1e-4),
            (spot(0.49, 0.5), 6e-4),
            (spot(0.3, FRAC_PI_2.next_down()), 1e-4),
            (spot(1.5, FRAC_PI_2), 7e-4),
        ];
        let camera = Camera::perspective(
            [0.0; 3],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            1.0,
            1.0,
            0.1,
            50.0,
        );
        let rays = CameraRays::new(&camera, [8, 8]);
        // A place the ray passes, its direction from there, distance to there, start and length of the stretch.
        let ranges = [
            -3.0..=3.0,
            -3.0..=3.0,
            -6.0..=3.0,
            -1.0..=1.0,
            -1.0..=1.0,
            -1.0..=1.0,
            0.0..=8.0,
            0.0..=8.0,
        ];
        let inputs = samples::in_box(5, 2_000, ranges);
        for (emitter, stated) in lights {
            let light = Light {
                emitter,
                shadow: None,
                texture: None,
            };
            let frame = Frame {
                camera,
                lights: vec![light],
                medium: medium.clone(),
            };
            let uniform = |bytes: &[u8]| {
                gpu.device
                    .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                        label: None,
                        contents: bytes,
                        usage: wgpu::BufferUsages::UNIFORM,
                    })
            };
            let (light_uniform, variant) = LightUniform::new(&light, &camera, 0);
            let frame_buffer = uniform(bytemuck::bytes_of(&FrameUniform::new(
                &frame,
                &rays,
                [8, 8],
            )));
            let light_buffer = uniform(bytemuck::bytes_of(&light_uniform));
            let tables = AirlightTextures::default().of(&gpu.device, &gpu.queue, &medium);
            let bindings = [
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: frame_buffer.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 10,
                    resource: light_buffer.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 3,
                    resource: wgpu::BindingResource::TextureView(&tables),
                },
            ];
            let found = wgsl::evaluate_with(
                gpu,
                &[&stretch_module(variant.kind)],
                &bindings,
                "stretch_plain(Ray(vec3f(x[0], x[1], x[2]), 0.0, normalize(vec3f(x[3], x[4], x[5]))), x[6], x[6] + x[7]), 0.0",
                &inputs,
            )
            .expect("the shader runs");
            let model = &LightModel::samples(&light, &camera, None)[0];
            let scene = CpuScene {
                camera: rays.clone(),
                size: [8, 8],
                depth: &[],
                optics: Optics::new(&medium),
                lights: Vec::new(),
                occluders: None,
            };
            let mut worst = 0.0_f64;
            for (x, found) in inputs.iter().zip(found) {
                let x = x.map(f64::from);
                let ray = Ray {
                    origin: DVec3::new(x[0], x[1], x[2]),
                    direction: DVec3::new(x[3], x[4], x[5]).normalize(),
                    length: 0.0,
                };
                let over = |span: [f64; 2]| {
                    let span = model.reach(ray.origin, ray.direction, span);
                    if span[0] >= span[1] {
                        return DVec3::ZERO;
                    }
                    integrate_lit(&ray, model, &scene, 1e-7, span, &mut Vec::new())
                };
                let (exact, entire) = (over([x[6], x[6] + x[7]]), over([0.0, 40.0]));
                let found = DVec3::new(found[0].into(), found[1].into(), found[2].into());
                if entire.min_element() > 0.0 {
                    worst = worst.max(((found - exact).abs() / entire).max_element());
                } else {
                    assert_eq!(found, DVec3::ZERO, "{emitter:?}: {x:?}");
                }
            }
            println!("{emitter:?}: {worst:.1e}");
            assert!(
                worst < stated,
                "{emitter:?}: {worst:.1e}, stated {stated:.0e}"
            );
        }
    }
}
