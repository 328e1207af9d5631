//! A frame and its inputs, drawn from bytes.

use tyndall::{
    cpu::{GlassMap, LightTexture, ShadowMap},
    frame::{
        Camera, DepthRange, Emitter, Frame, Light, Medium, MediumComponent, Phase, Projection,
        ShadowProjection, TexturePlacement,
    },
    phase,
    techniques::TechniqueChoice,
};

use crate::{draw::Draw, picked};

/// The most pixels of a side.
const SIDE: u8 = 20;

/// A frame, what belongs to it, and who is to compute it.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) frame: Frame,
    pub(super) size: [u32; 2],
    pub(super) depth: Vec<f32>,
    pub(super) lights: Vec<Pictures>,
    /// Corners of triangles, and points with a radius.
    pub(super) points: Vec<[f32; 4]>,
    pub(super) techniques: TechniqueChoice,
}

/// A light's pictures.
#[derive(Debug, Default)]
pub(super) struct Pictures {
    pub(super) shadow_map: Option<ShadowMap>,
    pub(super) glass: Option<GlassMap>,
    pub(super) texture: Option<LightTexture>,
}

impl Drawn {
    pub(super) fn new(bytes: &[u8]) -> Self {
        let draw = &mut Draw::new(bytes);
        let all = (!draw.once_in(8)).then(|| picked::technique(draw));
        let size = [0; 2].map(|_: u32| u32::from(1 + draw.below(SIDE)));
        let camera = camera(draw);
        let components = 1 + usize::from(draw.below(2)) + 3 * usize::from(draw.once_in(16));
        let medium = Medium {
            components: draw.list(components, component),
        };
        let count = if draw.once_in(16) { draw.below(4) } else { 1 };
        let lights = draw.list(usize::from(count), light);
        let own = lights
            .iter()
            .map(|_| draw.once_in(16).then(|| picked::technique(draw)));
        let techniques = TechniqueChoice {
            all,
            lights: own.collect(),
        };
        let pictures = lights.iter().map(|light| pictures(draw, light)).collect();
        Self {
            points: draw.list(6, |draw| draw.many(Draw::real)),
            depth: values(draw, (size[0] * size[1]) as usize, |draw| draw.unit()),
            lights: pictures,
            frame: Frame {
                camera,
                lights,
                medium,
            },
            size,
            techniques,
        }
    }
}

/// So many values, of a dozen that are drawn.
fn values<T: Copy>(draw: &mut Draw<'_>, count: usize, of: impl Fn(&mut Draw<'_>) -> T) -> Vec<T> {
    let drawn = draw.list(12, of);
    (0..count)
        .map(|i| drawn[(i * 7 + i / 5) % drawn.len()])
        .collect()
}

fn camera(draw: &mut Draw<'_>) -> Camera {
    let half_extent = draw.many(|draw| draw.real_or(|draw| *draw.one_of(&[0.5, 1.0, 0.2, 3.0])));
    let center = if draw.once_in(4) {
        draw.many(Draw::real)
    } else {
        [0.0; 2]
    };
    let near = draw.real_or(|draw| *draw.one_of(&[0.1, 0.001, 1.0, 1e-6]));
    let far = draw.real_or(|draw| *draw.one_of(&[50.0, 10.0, 1e3, 1e6]));
    let is_parallel = draw.once_in(4);
    Camera {
        eye: draw.many(Draw::real),
        forward: draw.many(|draw| draw.real_or(|draw| *draw.one_of(&[-1.0, 0.1, 0.5, 0.0]))),
        up: draw.many(|draw| draw.real_or(|draw| *draw.one_of(&[0.0, 1.0, 0.2]))),
        projection: if is_parallel {
            Projection::Orthographic {
                half_extent,
                center,
                near,
                far,
            }
        } else {
            Projection::Perspective {
                half_extent,
                center,
                near,
                far,
            }
        },
        depth_range: *draw.one_of(&[
            DepthRange::Reversed,
            DepthRange::Standard,
            DepthRange::ReversedInfinite,
        ]),
    }
}

fn component(draw: &mut Draw<'_>) -> MediumComponent {
    let name = draw.one_of(phase::TABLE).name;
    let params = [draw.unit(), draw.unit()];
    let sigma =
        |draw: &mut Draw<'_>| draw.real_or(|draw| *draw.one_of(&[0.02, 0.0, 0.1, 1.0, 10.0, 1e-4]));
    MediumComponent {
        sigma_s: draw.many(sigma),
        sigma_a: draw.many(sigma),
        phase: Phase::from_name(name, params).unwrap_or(Phase::Isotropic),
    }
}

fn light(draw: &mut Draw<'_>) -> Light {
    let (place, travel, strength) = (
        draw.many(Draw::real),
        draw.many(Draw::real),
        draw.many(Draw::positive),
    );
    let radius = draw.real_or(|draw| *draw.one_of(&[0.0, 0.1]));
    let emitter = match draw.below(4) {
        0 => Emitter::Point {
            position: place,
            intensity: strength,
            radius,
        },
        1 => Emitter::Directional {
            direction: travel,
            illuminance: strength,
        },
        2 => Emitter::Spot {
            position: place,
            direction: travel,
            intensity: strength,
            inner: draw.real_or(|draw| *draw.one_of(&[0.1, 0.0])),
            outer: draw.real_or(|draw| *draw.one_of(&[0.5, 1.2, 0.1, std::f32::consts::FRAC_PI_2])),
            radius,
        },
        _ => Emitter::Rect {
            center: place,
            edge_x: travel,
            edge_y: draw.many(Draw::real),
            radiance: strength,
            samples: *draw.one_of(&[4, 1, 16, 0, u32::MAX]),
        },
    };
    Light {
        shadow: (!matches!(emitter, Emitter::Rect { .. }) && draw.once_in(2)).then(|| shadow(draw)),
        texture: draw.once_in(4).then(|| placement(draw, &emitter)),
        emitter,
    }
}

fn shadow(draw: &mut Draw<'_>) -> ShadowProjection {
    let reversed_depth = draw.once_in(2);
    match draw.below(3) {
        0 => ShadowProjection::Cube {
            near: draw.real_or(|_| 0.05),
            far: draw.real_or(|_| 40.0),
            reversed_depth,
        },
        // A sun's, looking down from 20 m.
        1 => ShadowProjection::Single {
            clip_from_world: [
                [0.1, 0.0, 0.0, 0.0],
                [0.0, 0.0, -0.025, 0.0],
                [0.0, 0.1, 0.0, 0.0],
                [0.0, 0.0, 0.5, 1.0],
            ]
            .map(|column: [f32; 4]| column.map(|x| draw.real_or(|_| x))),
            reversed_depth,
        },
        _ => ShadowProjection::Single {
            clip_from_world: std::array::from_fn(|_| draw.many(Draw::real)),
            reversed_depth,
        },
    }
}

fn placement(draw: &mut Draw<'_>, emitter: &Emitter) -> TexturePlacement {
    let up = draw.many(Draw::real);
    match emitter {
        _ if draw.once_in(16) => TexturePlacement::Rectangle,
        Emitter::Directional { .. } => TexturePlacement::Parallelogram {
            center: up,
            edge_x: draw.many(Draw::real),
            edge_y: draw.many(Draw::real),
        },
        Emitter::Point { .. } => TexturePlacement::Sphere {
            up,
            forward: draw.many(Draw::real),
        },
        Emitter::Spot { .. } => TexturePlacement::Cone { up },
        Emitter::Rect { .. } => TexturePlacement::Rectangle,
    }
}

fn pictures(draw: &mut Draw<'_>, light: &Light) -> Pictures {
    let side = *draw.one_of(&[4_u32, 1, 8, 16]);
    let (size, area) = ([side, side], (side * side) as usize);
    let faces = light.faces() as usize;
    let map = light.shadow.map(|_| ShadowMap {
        size,
        depth: values(draw, faces * area, |draw| draw.unit()),
    });
    let glass = (map.is_some() && draw.once_in(4)).then(|| GlassMap {
        size,
        layers: 2,
        texels: values(draw, 2 * faces * area, |draw| draw.many(Draw::unit)),
    });
    Pictures {
        shadow_map: map,
        glass,
        texture: light.texture.map(|_| LightTexture {
            size,
            texels: values(draw, area, |draw| draw.many(Draw::unit)),
        }),
    }
}
