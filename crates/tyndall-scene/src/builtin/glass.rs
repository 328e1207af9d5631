//! Textures made by code: stained glass and floor tiles.

use glam::{Vec2, Vec3, vec2, vec3};

use super::noise::Random;
use crate::scene::{Texture, Wrap};

/// Linear colours of the panes.
const PANES: [Vec3; 7] = [
    vec3(0.85, 0.06, 0.05),
    vec3(0.04, 0.10, 0.80),
    vec3(0.95, 0.55, 0.05),
    vec3(0.05, 0.45, 0.12),
    vec3(0.10, 0.45, 0.85),
    vec3(0.45, 0.06, 0.50),
    vec3(0.95, 0.85, 0.55),
];

/// Linear colour of the lead between panes.
const LEAD: Vec3 = vec3(0.005, 0.005, 0.005);

/// Makes a texture of linear colours; `color` gets the texel's centre in [0, 1]^2, y down.
fn paint(size: [u32; 2], wrap: Wrap, color: impl Fn(Vec2) -> Vec3) -> Texture {
    let texels = (0..size[1])
        .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
        .map(|(x, y)| {
            let center = vec2(x as f32 + 0.5, y as f32 + 0.5);
            let [r, g, b] = color(center / vec2(size[0] as f32, size[1] as f32))
                .to_array()
                .map(srgb_encode);
            [r, g, b, 255]
        })
        .collect();
    Texture {
        size,
        texels,
        wrap: [wrap; 2],
    }
}

/// IEC 61966-2-1.
fn srgb_encode(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * encoded.clamp(0.0, 1.0)).round() as u8
}

/// A lancet's glass: irregular panes, bound by lead, in a border of one colour.
pub(super) fn lancet(seed: u64) -> Texture {
    const PANE_COUNT: usize = 90;
    const LEAD_WIDTH: f32 = 0.012;
    const BORDER: f32 = 0.09;
    /// Height / width.
    const ASPECT: f32 = 2.0;
    let mut random = Random::new(seed);
    let border = PANES[random.below(PANES.len())];
    let panes: Vec<(Vec2, Vec3)> = (0..PANE_COUNT)
        .map(|_| {
            let center = vec2(random.unit(), ASPECT * random.unit());
            (
                center,
                PANES[random.below(PANES.len())] * random.between(0.7, 1.0),
            )
        })
        .collect();
    paint([128, 256], Wrap::ClampToEdge, |uv| {
        let point = uv * vec2(1.0, ASPECT);
        let from_edge = point.min(vec2(1.0, ASPECT) - point).min_element();
        if from_edge < BORDER {
            return lead_below((from_edge - BORDER).abs() - LEAD_WIDTH, border);
        }
        let (mut nearest, mut second) = ((f32::MAX, Vec3::ZERO), f32::MAX);
        for &(center, color) in &panes {
            let distance = center.distance(point);
            if distance < nearest.0 {
                second = nearest.0;
                nearest = (distance, color);
            } else {
                second = second.min(distance);
            }
        }
        lead_below(second - nearest.0 - 2.0 * LEAD_WIDTH, nearest.1)
    })
}

/// A rose window: rings of petals round a middle.
pub(super) fn rose(seed: u64) -> Texture {
    /// Outer radius and number of petals of each ring, from inside; the texture's half width is 1.
    const RINGS: [(f32, u32); 5] = [(0.16, 1), (0.38, 8), (0.62, 16), (0.84, 16), (1.0, 32)];
    const LEAD_WIDTH: f32 = 0.014;
    let mut random = Random::new(seed);
    let colors = RINGS.map(|_| [0, 1].map(|_| PANES[random.below(PANES.len())]));
    paint([512, 512], Wrap::ClampToEdge, |uv| {
        let point = 2.0 * uv - Vec2::ONE;
        let (radius, turn) = (
            point.length(),
            point.to_angle() / std::f32::consts::TAU + 0.5,
        );
        let mut inner = 0.0;
        for ((outer, petals), colors) in RINGS.into_iter().zip(colors) {
            if radius < outer {
                let along = turn * petals as f32;
                let to_spoke =
                    (along - along.round()).abs() * std::f32::consts::TAU * radius / petals as f32;
                let to_lead = if petals == 1 { f32::MAX } else { to_spoke }
                    .min(outer - radius)
                    .min(radius - inner + LEAD_WIDTH * f32::from(inner == 0.0));
                let color = colors[along as usize % 2];
                return lead_below(to_lead - LEAD_WIDTH, color);
            }
            inner = outer;
        }
        LEAD
    })
}

/// Light and dark floor tiles, two by two, with joints.
pub(super) fn tiles() -> Texture {
    const JOINT: f32 = 0.012;
    const LIGHT: Vec3 = vec3(0.52, 0.47, 0.40);
    const DARK: Vec3 = vec3(0.20, 0.17, 0.15);
    const MORTAR: Vec3 = vec3(0.08, 0.075, 0.07);
    paint([128, 128], Wrap::Repeat, |uv| {
        let tile = (2.0 * uv).floor();
        let within = 2.0 * uv - tile;
        if within.min(Vec2::ONE - within).min_element() < JOINT {
            MORTAR
        } else if (tile.x + tile.y) % 2.0 == 0.0 {
            LIGHT
        } else {
            DARK
        }
    })
}

fn lead_below(distance: f32, pane: Vec3) -> Vec3 {
    if distance < 0.0 { LEAD } else { pane }
}
