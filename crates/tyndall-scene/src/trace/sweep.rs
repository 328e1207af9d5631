//! The exact stretches of a view ray that surfaces shade.
//!
//! All points between a view ray and a light form a piece of a plane: a half strip where the light is directional, the
//! triangle (ray's start, ray's end, light) where it is a point. The tree is asked for the triangles that meet this
//! piece; each is cut with the plane, the cut is clipped to the piece and projected along the light onto the ray.
//!
//! In the plane a point has coordinates (x, y): x along the ray and y away from it, towards the light. It shades the
//! ray at `s = (x + k y) / (1 - c y)`, with (Q = P(s) + y / b * (light - P(s)) solved for s)
//! - point light at (p, b): k = -p / b, c = 1 / b;
//! - light that comes from direction (a, b): k = -a / b, c = 0.
//!
//! **Edges.** A corner on the plane counts as on its positive side, as if the plane were moved by an infinitesimal
//! distance; a corner's side and where an edge is cut depend only on coordinates. So surfaces that are closed leave no
//! gap between their triangles' shades, and triangles within the plane shade nothing (they have no thickness).
//!
//! **Tolerances.** Surfaces that light meets less than [`CLEARANCE`] of the scene's size before the ray don't shade it:
//! the ray lies in them or starts on them. A ray that ends on a surface may pass it by rounding; only the rest beyond the
//! surface is shaded then. Closer to a local light than the same share of its distance, nothing shades either. A light
//! within [`PARALLEL`] of the ray's own line makes a piece of plane without width; the ray itself is cast through the scene
//! then.

use glam::{DVec2, DVec3, Vec3, Vec3A, Vec4};
use tyndall::cpu::{LightSource, Occluders, Shade};

use super::{texels, tracer::Tracer};
use crate::view::Ray;

/// Surfaces closer to the ray along the light than this share of the scene's largest coordinate don't shade it.
const CLEARANCE: f64 = 1e-10;

/// Sine of the angle between ray and light (point light: its distance from the ray's line over the longer of the ray's
/// length and the light's distance) below which the light counts as on the ray's line.
const PARALLEL: f64 = 1e-9;

/// Rounding of the f32 tests against boxes, relative to their constant terms.
const ROUNDING: f32 = 1e-6;

impl Occluders for Tracer {
    fn shades(
        &self,
        origin: [f64; 3],
        direction: [f64; 3],
        length: f64,
        light: LightSource,
        shades: &mut Vec<Shade>,
    ) {
        let ray = Ray {
            origin: origin.into(),
            direction: direction.into(),
        };
        match Swept::new(&ray, length, light, self.scale()) {
            Swept::Plane(sweep) => self.plane_shades(&sweep, shades),
            Swept::Line(light_at) => [-1.0, 1.0]
                .into_iter()
                .filter_map(|side| LineWalk::new(&ray, length, light_at, side))
                .for_each(|walk| self.line_shades(&walk, shades)),
        }
    }
}

impl Tracer {
    fn plane_shades(&self, sweep: &Sweep, shades: &mut Vec<Shade>) {
        let region = sweep.region();
        for tree in [&self.blockers, &self.glass] {
            tree.within(
                |center, half| region.meets(center, half),
                |triangle| self.triangle_shades(sweep, triangle, shades),
            );
        }
    }

    fn triangle_shades(&self, sweep: &Sweep, triangle: usize, shades: &mut Vec<Shade>) {
        let Some(cut) = sweep.cut(&self.geometry.positions[triangle]) else {
            return;
        };
        let surface = self.surface(triangle);
        if let Some(tint) = surface.uniform {
            shades.extend(sweep.shade(&cut, [0.0, 1.0], tint));
            return;
        }
        let uv = cut.weights.map(|weights| self.uv(triangle, weights));
        texels::pieces(surface, &self.textures, uv, |piece, tint| {
            shades.extend(sweep.shade(&cut, piece, tint));
        });
    }

    /// Casts the ray itself, for a light on its own line: a surface shades all that is beyond it as seen from the light.
    fn line_shades(&self, walk: &LineWalk, shades: &mut Vec<Shade>) {
        let clearance = CLEARANCE * self.scale();
        let range = [clearance, walk.span];
        let blocker = self.closest(&walk.ray, range);
        let mut glass = Vec::new();
        self.glass(
            &walk.ray,
            [clearance, blocker.map_or(walk.span, |hit| hit.distance)],
            &mut glass,
        );
        let glass = glass.iter().map(|hit| (hit.distance, hit.tint));
        let blocker = blocker.map(|hit| (hit.distance, DVec3::ZERO));
        shades.extend(
            glass
                .chain(blocker)
                .filter_map(|(distance, tint)| walk.shade(distance, tint)),
        );
    }
}

/// All points between a view ray and a light.
enum Swept {
    Plane(Sweep),
    /// A light on the ray's line, at this distance from the ray's origin.
    Line(f64),
}

/// A piece of a plane between a view ray and a light; see the module's documentation.
struct Sweep {
    origin: DVec3,
    length: f64,
    /// Unit direction of the ray: the x axis.
    along: DVec3,
    /// Unit vector in the plane, normal to the ray, towards the light: the y axis.
    towards: DVec3,
    /// Unit normal of the plane.
    normal: DVec3,
    k: f64,
    c: f64,
    /// Range of y in which surfaces shade the ray.
    heights: [f64; 2],
}

/// The line in which a triangle meets the plane, between two of its edges.
struct Cut {
    /// Coordinates of its ends in the plane.
    ends: [DVec2; 2],
    /// The ends as weights of the triangle's corners.
    weights: [DVec3; 2],
}

impl Swept {
    /// `scale` is the scene's largest coordinate \[m].
    fn new(ray: &Ray, length: f64, light: LightSource, scale: f64) -> Self {
        let along = ray.direction;
        let to_light = match light {
            LightSource::Direction(direction) => -DVec3::from(direction),
            LightSource::Position(position) => DVec3::from(position) - ray.origin,
        };
        let p = to_light.dot(along);
        let normal = along.cross(to_light);
        let b = normal.length();
        let (reach, c) = match light {
            LightSource::Direction(_) => (1.0, 0.0),
            LightSource::Position(_) => (length.max(to_light.length()), 1.0 / b),
        };
        if b <= PARALLEL * reach {
            return Self::Line(match light {
                // As good as infinitely far: beyond all surfaces and both ends of the ray.
                LightSource::Direction(_) => {
                    p.signum() * (length + 4.0 * scale + 2.0 * ray.origin.length())
                }
                LightSource::Position(_) => p,
            });
        }
        let normal = normal / b;
        Self::Plane(Sweep {
            origin: ray.origin,
            length,
            along,
            towards: normal.cross(along),
            normal,
            k: -p / b,
            c,
            heights: [CLEARANCE * scale * b / reach, (1.0 - CLEARANCE) / c],
        })
    }
}

impl Sweep {
    /// The cut of a triangle with the plane; `None` if all of it is on one side.
    fn cut(&self, corners: &[Vec3; 3]) -> Option<Cut> {
        let relative = corners.map(|p| p.as_dvec3() - self.origin);
        let distance = relative.map(|q| q.dot(self.normal));
        let positive = distance.map(|d| d >= 0.0);
        // The corner that is alone on its side.
        let alone = match positive {
            [a, b, c] if a == b && b == c => return None,
            [a, b, c] if b == c && a != b => 0,
            [a, _, c] if a == c => 1,
            _ => 2,
        };
        let plane = relative.map(|q| DVec2::new(q.dot(self.along), q.dot(self.towards)));
        let cut_edge = |other: usize| {
            // From the negative to the positive corner, whichever triangle asks: neighbours get the same point.
            let (from, to) = if positive[alone] {
                (other, alone)
            } else {
                (alone, other)
            };
            let t = distance[from] / (distance[from] - distance[to]);
            let mut weights = DVec3::ZERO;
            weights[from] = 1.0 - t;
            weights[to] = t;
            (plane[from] + t * (plane[to] - plane[from]), weights)
        };
        let [first, second] = [(alone + 1) % 3, (alone + 2) % 3].map(cut_edge);
        Some(Cut {
            ends: [first.0, second.0],
            weights: [first.1, second.1],
        })
    }

    /// The stretch of the ray that a piece of a cut, given as shares of its length from end to end, shades.
    fn shade(&self, cut: &Cut, piece: [f64; 2], tint: DVec3) -> Option<Shade> {
        let [from, to] = piece.map(|t| match t {
            0.0 => cut.ends[0],
            1.0 => cut.ends[1],
            _ => cut.ends[0].lerp(cut.ends[1], t),
        });
        let (low, high) = if from.y <= to.y {
            (from, to)
        } else {
            (to, from)
        };
        let [floor, ceiling] = self.heights;
        if high.y <= floor || low.y >= ceiling {
            return None;
        }
        // Exactly at this height: behind the light s would change its sign.
        let at = |y: f64| {
            let share = (y - low.y) / (high.y - low.y);
            DVec2::new(low.x + (high.x - low.x) * share, y)
        };
        let low_end = if low.y < floor { at(floor) } else { low };
        let high_end = if high.y > ceiling { at(ceiling) } else { high };
        let [a, b] = [low_end, high_end].map(|q| (q.x + self.k * q.y) / (1.0 - self.c * q.y));
        let (start, end) = (a.min(b).max(0.0), a.max(b).min(self.length));
        (start < end).then(|| Shade {
            start,
            end,
            tint: tint.to_array(),
        })
    }

    fn region(&self) -> Region {
        let Self {
            origin,
            along,
            towards,
            normal,
            k,
            c,
            length,
            ..
        } = *self;
        // Each is affine and positive (the first: zero) within the region:
        // distance from the plane, y, the numerator of s, and length times the denominator less the numerator.
        let gradients = [
            normal,
            towards,
            along + k * towards,
            -along - (k + length * c) * towards,
        ];
        let constants = [0.0, 0.0, 0.0, length];
        let scaled: [(DVec3, f64); 4] = std::array::from_fn(|i| {
            let steepness = gradients[i].length();
            let gradient = gradients[i] / steepness;
            (gradient, constants[i] / steepness - gradient.dot(origin))
        });
        let lane = |component: &dyn Fn(&(DVec3, f64)) -> f64| {
            Vec4::from_array(std::array::from_fn(|i| component(&scaled[i]) as f32))
        };
        let columns = [lane(&|f| f.0.x), lane(&|f| f.0.y), lane(&|f| f.0.z)];
        let constant = lane(&|f| f.1);
        Region {
            steepness: columns.map(Vec4::abs),
            columns,
            constant,
            slack: ROUNDING * constant.abs(),
        }
    }
}

/// A conservative test of boxes against a [`Sweep`]'s piece of plane: four affine functions, one a lane.
struct Region {
    columns: [Vec4; 3],
    steepness: [Vec4; 3],
    constant: Vec4,
    slack: Vec4,
}

impl Region {
    /// False only where a box certainly lies outside.
    fn meets(&self, center: Vec3A, half: Vec3A) -> bool {
        let [x, y, z] = self.columns;
        let value = x * center.x + y * center.y + z * center.z + self.constant;
        let [x, y, z] = self.steepness;
        let spread = x * half.x + y * half.y + z * half.z + self.slack;
        (value + spread).cmpge(Vec4::ZERO).all() && value.x <= spread.x
    }
}

/// A walk along the ray's line, away from a light on it.
struct LineWalk {
    /// Starts at the light.
    ray: Ray,
    light_at: f64,
    /// 1 if the walk goes in the ray's direction, -1 if it goes against it.
    side: f64,
    /// Length of the ray on this side of the light \[m].
    span: f64,
    length: f64,
}

impl LineWalk {
    fn new(ray: &Ray, length: f64, light_at: f64, side: f64) -> Option<Self> {
        let span = if side > 0.0 {
            length - light_at
        } else {
            light_at
        };
        (span > 0.0).then(|| Self {
            ray: Ray {
                origin: ray.at(light_at),
                direction: side * ray.direction,
            },
            light_at,
            side,
            span,
            length,
        })
    }

    /// The stretch that a surface at a distance from the light shades.
    fn shade(&self, distance: f64, tint: DVec3) -> Option<Shade> {
        let s = self.light_at + self.side * distance;
        let (start, end) = if self.side > 0.0 {
            (s.max(0.0), self.length)
        } else {
            (0.0, s.min(self.length))
        };
        (start < end).then(|| Shade {
            start,
            end,
            tint: tint.to_array(),
        })
    }
}
