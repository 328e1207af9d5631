//! Light textures: images that lights shine through, looked up by the point a light shines on.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use crate::{
    frame::{Emitter, TexturePlacement},
    inputs::LightTexture,
    physics::reals,
};

/// Maps points to places on the texture: rows of an affine map relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct TextureMapping {
    /// World-space origin of the rows \[m].
    pub origin: DVec3,
    /// Rows that give u, v, and w; see `kind`.
    pub rows: [DVec3; 3],
    /// The meaning of the rows' products.
    pub kind: MappingKind,
}

/// The meaning of the products (u, v, w) of a [`TextureMapping`]'s rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MappingKind {
    /// (u, v) are texture coordinates from its middle.
    Affine,
    /// (u / w, v / w) are texture coordinates from its middle.
    Projective,
    /// (u, v, w) are right, up and forward of the direction that longitude and latitude are taken of.
    Sphere,
}

impl TextureMapping {
    /// The mapping of a light's texture. `None` where the placement is not of this kind of light, or is degenerate.
    pub fn new(emitter: &Emitter, placement: &TexturePlacement) -> Option<Self> {
        match (*emitter, *placement) {
            (
                Emitter::Directional { direction, .. },
                TexturePlacement::Parallelogram {
                    center,
                    edge_x,
                    edge_y,
                },
            ) => Self::affine(center, edge_x, edge_y, reals(direction)),
            (
                Emitter::Rect {
                    center,
                    edge_x,
                    edge_y,
                    ..
                },
                TexturePlacement::Rectangle,
            ) => Self::affine(center, edge_x, edge_y, reals(edge_x).cross(reals(edge_y))),
            (
                Emitter::Spot {
                    position,
                    direction,
                    outer,
                    ..
                },
                TexturePlacement::Cone { up },
            ) => {
                let axis = reals(direction).try_normalize()?;
                let right = axis.cross(reals(up)).try_normalize()?;
                let half = 0.5 / f64::from(outer).tan();
                Some(Self {
                    origin: reals(position),
                    rows: [half * right, -half * right.cross(axis), axis],
                    kind: MappingKind::Projective,
                })
            }
            (Emitter::Point { position, .. }, TexturePlacement::Sphere { up, forward }) => {
                let up = reals(up).try_normalize()?;
                let right = reals(forward).cross(up).try_normalize()?;
                Some(Self {
                    origin: reals(position),
                    rows: [right, up, up.cross(right)],
                    kind: MappingKind::Sphere,
                })
            }
            _ => None,
        }
    }

    /// `p = center + u edge_x + v edge_y + t along`, solved for u and v.
    fn affine(center: [f32; 3], edge_x: [f32; 3], edge_y: [f32; 3], along: DVec3) -> Option<Self> {
        let edges = DMat3::from_cols(reals(edge_x), reals(edge_y), along);
        let relative = edges.determinant().abs()
            / (reals(edge_x).length() * reals(edge_y).length() * along.length());
        // Also where an edge of zero length makes it NaN.
        if relative.is_nan() || relative <= 1e-9 {
            return None;
        }
        let rows = edges.inverse().transpose();
        Some(Self {
            origin: reals(center),
            rows: [rows.x_axis, rows.y_axis, DVec3::ZERO],
            kind: MappingKind::Affine,
        })
    }

    /// Texture coordinates of a world-space point: (0, 0) top left, (1, 1) bottom right.
    pub fn uv(&self, point: DVec3) -> [f64; 2] {
        let q = point - self.origin;
        let [u, v, w] = self.rows.map(|row| row.dot(q));
        match self.kind {
            MappingKind::Affine => [u + 0.5, v + 0.5],
            MappingKind::Projective => [u / w + 0.5, v / w + 0.5],
            MappingKind::Sphere => [
                u.atan2(w) / (2.0 * PI) + 0.5,
                0.5 - (v / q.length()).clamp(-1.0, 1.0).asin() / PI,
            ],
        }
    }

    /// Appends the distances of the ray within `(a, b)` where it crosses the texture's border, and points between
    /// such that a stretch spans at most [`TEXELS_A_STRETCH`] texels (on the sphere: a fixed number).
    pub(crate) fn breaks(
        &self,
        origin: DVec3,
        direction: DVec3,
        [a, b]: [f64; 2],
        size: [u32; 2],
        breaks: &mut Vec<f64>,
    ) {
        let q = origin - self.origin;
        let at = self.rows.map(|row| [row.dot(q), row.dot(direction)]);
        let w = match self.kind {
            MappingKind::Affine => [1.0, 0.0],
            MappingKind::Projective => at[2],
            MappingKind::Sphere => {
                let step = (b - a) / f64::from(SPHERE_STRETCHES);
                breaks.extend((1..SPHERE_STRETCHES).map(|i| a + f64::from(i) * step));
                return;
            }
        };
        for (axis, texels) in [0, 1].into_iter().zip(size) {
            // x(s) = k w(s) at k = -1/2 (left or top border) .. 1/2 (right or bottom).
            let stretches = texels.div_ceil(TEXELS_A_STRETCH);
            let crossings = (0..=stretches).map(|i| {
                let k = f64::from(i) / f64::from(stretches) - 0.5;
                (k * w[0] - at[axis][0]) / (at[axis][1] - k * w[1])
            });
            breaks.extend(crossings.filter(|s| *s > a && *s < b));
        }
    }
}

/// Texels that quadrature may take at once.
const TEXELS_A_STRETCH: u32 = 8;
/// Stretches of a ray past a light with a texture on its sphere.
const SPHERE_STRETCHES: u32 = 64;

impl LightTexture {
    /// The texture at (u, v), bilinear between texel centres; black outside it.
    pub fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        if !((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)) {
            return DVec3::ZERO;
        }
        let (x, y) = (
            u * f64::from(self.size[0]) - 0.5,
            v * f64::from(self.size[1]) - 0.5,
        );
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |dx: f64, dy: f64| {
            let column = (x.floor() + dx).clamp(0.0, f64::from(self.size[0] - 1)) as usize;
            let row = (y.floor() + dy).clamp(0.0, f64::from(self.size[1] - 1)) as usize;
            reals(self.texels[row * self.size[0] as usize + column])
        };
        let top = texel(0.0, 0.0).lerp(texel(1.0, 0.0), fx);
        let bottom = texel(0.0, 1.0).lerp(texel(1.0, 1.0), fx);
        top.lerp(bottom, fy)
    }
}
