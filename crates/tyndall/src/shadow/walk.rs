//! A view ray walked through a shadow map texel by texel: the exact limit of marching it with ever smaller steps.
//!
//! In a face's clip space a ray is `c0 + s c1` (homogeneous). Texel borders are crossed where
//! `x(s) = border * w(s)`, and inside a texel of depth D the light is blocked where `z(s) < D w(s)`: all linear in s.

use glam::{DVec3, DVec4};

use super::{
    map::{Shadows, picture_point, texel_index},
    shade::Shade,
};

/// A ray in a face's clip space.
#[derive(Clone, Copy)]
struct ClipRay {
    c0: DVec4,
    c1: DVec4,
}

impl ClipRay {
    fn at(&self, s: f64) -> DVec4 {
        self.c0 + s * self.c1
    }

    /// >= 0 where light that has passed this depth reaches the point at `s`.
    fn margin(&self, s: f64, depth: f64) -> f64 {
        let clip = self.at(s);
        clip.z - depth * clip.w
    }
}

/// A ray over a shadow map, taken apart where it goes over from one face to another.
pub(crate) struct RayOnMap<'a> {
    shadows: &'a Shadows<'a>,
    pieces: Vec<Piece>,
}

/// The stretch of a ray that lies over one face, in front of the light.
struct Piece {
    face: usize,
    ray: ClipRay,
    span: [f64; 2],
}

impl RayOnMap<'_> {
    /// Appends what the map blocks of the ray's points within a part of its span \[m], in order; stretches that touch are one.
    pub(crate) fn walk_depth(&self, part: [f64; 2], shades: &mut Vec<Shade>) {
        for (piece, part) in self.pieces_of(part) {
            self.shadows
                .walk_depth(piece.face, &piece.ray, part, shades);
        }
    }

    /// Appends what the glass tints of a part of its span; stretches of one tint that touch are one.
    pub(crate) fn walk_tints(&self, part: [f64; 2], shades: &mut Vec<Shade>) {
        if self.shadows.glass.is_some() {
            for (piece, part) in self.pieces_of(part) {
                self.shadows
                    .walk_glass(0, piece.face, &piece.ray, part, shades);
            }
        }
    }

    fn pieces_of(&self, [from, to]: [f64; 2]) -> impl Iterator<Item = (&Piece, [f64; 2])> {
        self.pieces.iter().filter_map(move |piece| {
            let part = [from.max(piece.span[0]), to.min(piece.span[1])];
            (part[0] < part[1]).then_some((piece, part))
        })
    }
}

impl Shadows<'_> {
    /// Appends what the map blocks and the glass tints of the ray's points between `a` and `b` \[m], in order of
    /// distance for each texel; stretches of one tint that touch are one.
    pub fn walk(
        &self,
        origin: glam::DVec3,
        direction: glam::DVec3,
        span: [f64; 2],
        shades: &mut Vec<Shade>,
    ) {
        let ray = self.on_map(origin, direction, span);
        ray.walk_depth(span, shades);
        ray.walk_tints(span, shades);
    }

    /// The ray's points between `a` and `b` \[m], ready to be walked in parts.
    pub(crate) fn on_map(
        &self,
        origin: glam::DVec3,
        direction: glam::DVec3,
        [a, b]: [f64; 2],
    ) -> RayOnMap<'_> {
        let mut borders = self.face_borders(origin, direction, [a, b]);
        borders.push(b);
        let mut from = a;
        let mut pieces = Vec::with_capacity(borders.len());
        for to in borders {
            let face = self.face_of(origin + 0.5 * (from + to) * direction);
            let matrix = &self.faces[face].clip_from_world;
            let ray = ClipRay {
                c0: *matrix * origin.extend(1.0),
                c1: *matrix * direction.extend(0.0),
            };
            if let Some(span) = in_front(&ray, [from, to]) {
                pieces.push(Piece { face, ray, span });
            }
            from = to;
        }
        RayOnMap {
            shadows: self,
            pieces,
        }
    }

    /// Distances where the ray goes over from one cube face to another, sorted: |x| = |y| and so on.
    fn face_borders(
        &self,
        origin: glam::DVec3,
        direction: glam::DVec3,
        [a, b]: [f64; 2],
    ) -> Vec<f64> {
        if self.faces.len() == 1 {
            return Vec::new();
        }
        let q = origin - self.center;
        let mut borders = Vec::with_capacity(7);
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            for sign in [-1.0, 1.0] {
                let s = (sign * q[j] - q[i]) / (direction[i] - sign * direction[j]);
                if s > a && s < b {
                    borders.push(s);
                }
            }
        }
        borders.sort_by(f64::total_cmp);
        borders
    }

    fn walk_depth(&self, face: usize, ray: &ClipRay, span: [f64; 2], shades: &mut Vec<Shade>) {
        for_each_texel(ray, span, self.map.size, |texel, [from, to]| {
            let stored = self.stored_depth(face, texel);
            if let Some(span) = behind(ray, stored, [from, to]) {
                push(shades, span, DVec3::ZERO);
            }
        });
    }

    /// Over the glass's blocks from a level down; texel by texel where none can tell.
    fn walk_glass(
        &self,
        level: usize,
        face: usize,
        ray: &ClipRay,
        span: [f64; 2],
        shades: &mut Vec<Shade>,
    ) {
        let Some(blocks) = self.panes.level(level) else {
            return self.walk_layers(face, ray, span, shades);
        };
        for_each_texel(ray, span, blocks.size, |block, span| {
            let margins = |depth| span.map(|s| ray.margin(s, depth));
            match blocks.block(face, block).tint_of(margins) {
                Some(DVec3::ONE) => {}
                Some(tint) => push(shades, span, tint),
                None => self.walk_glass(level + 1, face, ray, span, shades),
            }
        });
    }

    fn walk_layers(&self, face: usize, ray: &ClipRay, span: [f64; 2], shades: &mut Vec<Shade>) {
        let Some(glass) = self.glass else { return };
        for_each_texel(ray, span, glass.size, |texel, [from, to]| {
            for layer in 0..glass.layers {
                let (depth, tint) = self.glass_layer(glass, face, layer, texel);
                if let Some(span) = behind(ray, depth, [from, to]) {
                    push(shades, span, tint);
                }
            }
        });
    }
}

/// Goes on with the last shade where it has the same tint and ends where this one starts.
fn push(shades: &mut Vec<Shade>, [start, end]: [f64; 2], tint: DVec3) {
    let tint = tint.to_array();
    match shades.last_mut() {
        Some(last) if last.end == start && last.tint == tint => last.end = end,
        _ => shades.push(Shade { start, end, tint }),
    }
}

/// The part of `[from, to]` with w > 0.
fn in_front(ray: &ClipRay, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
    let crossing = -ray.c0.w / ray.c1.w;
    let [from, to] = match ray.c1.w {
        w if w > 0.0 => [from.max(crossing), to],
        w if w < 0.0 => [from, to.min(crossing)],
        _ if ray.c0.w > 0.0 => [from, to],
        _ => return None,
    };
    (from < to).then_some([from, to])
}

/// The part of `[from, to]` that light does not reach past `stored`: `z(s) - stored w(s) < 0`.
fn behind(ray: &ClipRay, stored: f64, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
    if stored <= 0.0 {
        return None;
    }
    let constant = ray.c0.z - stored * ray.c0.w;
    let slope = ray.c1.z - stored * ray.c1.w;
    let crossing = -constant / slope;
    let [start, end] = match slope {
        k if k > 0.0 => [from, to.min(crossing)],
        k if k < 0.0 => [from.max(crossing), to],
        _ if constant < 0.0 => [from, to],
        _ => return None,
    };
    (start < end).then_some([start, end])
}

/// Calls `visit` with every texel that the ray passes over and the distances between which it does.
fn for_each_texel(
    ray: &ClipRay,
    [from, to]: [f64; 2],
    size: [u32; 2],
    mut visit: impl FnMut(usize, [f64; 2]),
) {
    let mut columns = Borders::new(ray.c0.x, ray.c1.x, ray, size[0], [from, to]);
    let mut rows = Borders::new(-ray.c0.y, -ray.c1.y, ray, size[1], [from, to]);
    let mut start = from;
    while start < to {
        let end = columns.next.min(rows.next).min(to);
        if end > start {
            let clip = ray.at(0.5 * (start + end));
            let texel = picture_point(clip).and_then(|uv| texel_index(uv, size));
            if let Some(texel) = texel {
                visit(texel, [start, end]);
            }
        }
        if columns.next <= end {
            columns.advance(end);
        }
        if rows.next <= end {
            rows.advance(end);
        }
        start = end;
    }
}

/// The distances at which one coordinate of the map, `0.5 + 0.5 (x0 + s x1) / w(s)`, crosses texel borders, in order.
struct Borders {
    x: [f64; 2],
    w: [f64; 2],
    count: f64,
    step: f64,
    /// The border that is crossed next, in texels.
    border: f64,
    /// The distance where it is crossed; infinite where there is none.
    next: f64,
}

impl Borders {
    fn new(x0: f64, x1: f64, ray: &ClipRay, size: u32, [from, to]: [f64; 2]) -> Self {
        let mut borders = Self {
            x: [x0, x1],
            w: [ray.c0.w, ray.c1.w],
            count: f64::from(size),
            step: 0.0,
            border: 0.0,
            next: f64::INFINITY,
        };
        let start = borders.coordinate(from);
        let middle = borders.coordinate(0.5 * (from + to));
        if middle > start {
            borders.step = 1.0;
            borders.border = (start.floor() + 1.0).max(0.0);
        } else if middle < start {
            borders.step = -1.0;
            borders.border = (start.ceil() - 1.0).min(borders.count);
        } else {
            return borders;
        }
        borders.next = borders.crossing(from);
        borders
    }

    fn coordinate(&self, s: f64) -> f64 {
        (0.5 + 0.5 * (self.x[0] + s * self.x[1]) / (self.w[0] + s * self.w[1])) * self.count
    }

    fn advance(&mut self, after: f64) {
        self.border += self.step;
        self.next = self.crossing(after);
    }

    /// The distance at which the coordinate equals the border: `x(s) = k w(s)` with `k = 2 border / count - 1`; not before
    /// `after`.
    fn crossing(&self, after: f64) -> f64 {
        if !(0.0..=self.count).contains(&self.border) {
            return f64::INFINITY;
        }
        let k = 2.0 * self.border / self.count - 1.0;
        let s = (k * self.w[0] - self.x[0]) / (self.x[1] - k * self.w[1]);
        if s.is_nan() {
            f64::INFINITY
        } else {
            s.max(after)
        }
    }
}
