//! Shapes as triangles.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2};

use crate::scene::Primitive;

/// Triangles under construction.
#[derive(Default)]
pub(super) struct Triangles {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    indices: Vec<u32>,
}

impl Triangles {
    pub(super) fn into_primitive(self, material: usize) -> Primitive {
        Primitive {
            positions: self.positions,
            normals: self.normals,
            uvs: self.uvs,
            indices: self.indices,
            material,
        }
    }

    /// A flat quadrangle, counter-clockwise seen from its front; nothing where it has no area.
    pub(super) fn quad(&mut self, corners: [Vec3; 4], uvs: [Vec2; 4]) {
        let [a, b, c, d] = corners;
        let Some(normal) = (c - a).cross(d - b).try_normalize() else {
            return;
        };
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.normals.extend([normal; 4]);
        self.uvs.extend(uvs);
        self.indices
            .extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }

    /// A flat quadrangle without texture.
    pub(super) fn plain_quad(&mut self, corners: [Vec3; 4]) {
        self.quad(corners, [Vec2::ZERO; 4]);
    }

    /// A parallelepiped round `center` with these half edges (right-handed).
    pub(super) fn block(&mut self, center: Vec3, half_edges: [Vec3; 3]) {
        for axis in 0..3 {
            let [u, v, w] = [0, 1, 2].map(|i| half_edges[(axis + i) % 3]);
            for (u, v, w) in [(u, v, w), (v, u, -w)] {
                let middle = center + w;
                self.plain_quad([
                    middle - u - v,
                    middle + u - v,
                    middle + u + v,
                    middle - u + v,
                ]);
            }
        }
    }

    /// A block between two opposite corners, along the axes.
    pub(super) fn cuboid(&mut self, min: Vec3, max: Vec3) {
        let half = 0.5 * (max - min);
        let half_edges = [half.x * Vec3::X, half.y * Vec3::Y, half.z * Vec3::Z];
        self.block(0.5 * (min + max), half_edges);
    }

    /// A smooth tube of rings: centre and radius each, with `sides` sides, open at both ends.
    /// Rings lie across the line from the ring before to the ring after.
    pub(super) fn tube(&mut self, rings: &[(Vec3, f32)], sides: u32) {
        let first = self.positions.len() as u32;
        for (i, &(center, radius)) in rings.iter().enumerate() {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(rings.len() - 1));
            let run = rings[after].0 - rings[before].0;
            let axis = run.normalize_or(Vec3::Y);
            let widening = (rings[after].1 - rings[before].1) / run.length().max(f32::MIN_POSITIVE);
            let (across, along) = axis.any_orthonormal_pair();
            for side in 0..=sides {
                let turn = side as f32 / sides as f32;
                let (sin, cos) = (-TAU * turn).sin_cos();
                let outward = across * cos + along * sin;
                self.positions.push(center + radius * outward);
                self.normals.push((outward - widening * axis).normalize());
                self.uvs.push(vec2(turn, i as f32));
            }
        }
        self.stitch(first, sides + 1, rings.len() as u32);
    }

    /// A smooth surface over a grid of `columns` x `rows` points, row by row.
    pub(super) fn surface(&mut self, [columns, rows]: [u32; 2], point: impl Fn(u32, u32) -> Vec3) {
        let first = self.positions.len() as u32;
        for row in 0..rows {
            for column in 0..columns {
                let along_row = point((column + 1).min(columns - 1), row)
                    - point(column.saturating_sub(1), row);
                let along_column =
                    point(column, (row + 1).min(rows - 1)) - point(column, row.saturating_sub(1));
                self.positions.push(point(column, row));
                self.normals
                    .push(along_column.cross(along_row).normalize_or(Vec3::Y));
                self.uvs.push(vec2(
                    column as f32 / (columns - 1) as f32,
                    row as f32 / (rows - 1) as f32,
                ));
            }
        }
        self.stitch(first, columns, rows);
    }

    /// Joins rows of points that were pushed one after another.
    fn stitch(&mut self, first: u32, columns: u32, rows: u32) {
        for row in 0..rows.saturating_sub(1) {
            for column in 0..columns - 1 {
                let a = first + row * columns + column;
                let [b, c, d] = [a + 1, a + columns, a + columns + 1];
                self.indices.extend([a, c, b, b, c, d]);
            }
        }
    }

    /// A wall with an opening, and its reveals; see [`Bay`].
    pub(super) fn bay(&mut self, bay: &Bay) {
        let [[left, bottom], [right, top]] = bay.rectangle;
        let opening = &bay.opening.0;
        let (Some(&start), Some(&end)) = (opening.first(), opening.last()) else {
            return;
        };
        self.wall_piece(
            bay,
            [[left, bottom], [left, top]],
            [[start[0], bottom], [start[0], top]],
        );
        self.wall_piece(
            bay,
            [[end[0], bottom], [end[0], top]],
            [[right, bottom], [right, top]],
        );
        for pair in opening.windows(2) {
            let [[u0, low0, high0], [u1, low1, high1]] = [pair[0], pair[1]];
            self.wall_piece(bay, [[u0, bottom], [u0, low0]], [[u1, bottom], [u1, low1]]);
            self.wall_piece(bay, [[u0, high0], [u0, top]], [[u1, high1], [u1, top]]);
            self.reveal(bay, [u0, low0], [u1, low1]);
            self.reveal(bay, [u1, high1], [u0, high0]);
        }
        self.reveal(bay, [start[0], start[2]], [start[0], start[1]]);
        self.reveal(bay, [end[0], end[1]], [end[0], end[2]]);
    }

    /// The glass in a bay's opening, in the middle of the wall; its texture fills the opening's bounding box.
    pub(super) fn pane(&mut self, bay: &Bay) {
        let opening = &bay.opening.0;
        let span = |i: usize| {
            opening
                .iter()
                .map(|point| point[i])
                .fold([f32::MAX, f32::MIN], |[a, b], x| [a.min(x), b.max(x)])
        };
        let ([u_min, u_max], [low, _], [_, high]) = (span(0), span(1), span(2));
        let uv = |[u, v]: [f32; 2]| vec2((u - u_min) / (u_max - u_min), (high - v) / (high - low));
        for pair in opening.windows(2) {
            let [[u0, low0, high0], [u1, low1, high1]] = [pair[0], pair[1]];
            let corners = [[u0, low0], [u1, low1], [u1, high1], [u0, high0]];
            self.quad(
                corners.map(|corner| bay.point(corner, 0.0)),
                corners.map(uv),
            );
        }
    }

    /// Both faces of a piece of wall between two edges, each from below to above.
    fn wall_piece(&mut self, bay: &Bay, left: [[f32; 2]; 2], right: [[f32; 2]; 2]) {
        let outline = [left[0], right[0], right[1], left[1]];
        let half = 0.5 * bay.thickness;
        self.plain_quad(outline.map(|corner| bay.point(corner, half)));
        let [a, b, c, d] = outline.map(|corner| bay.point(corner, -half));
        self.plain_quad([d, c, b, a]);
    }

    /// The inside of the opening along one edge of its outline (counter-clockwise).
    fn reveal(&mut self, bay: &Bay, from: [f32; 2], to: [f32; 2]) {
        let half = 0.5 * bay.thickness;
        self.plain_quad([
            bay.point(from, -half),
            bay.point(from, half),
            bay.point(to, half),
            bay.point(to, -half),
        ]);
    }
}

/// A rectangular piece of an upright wall with one opening, given across (u) and up (v).
pub(super) struct Bay {
    /// World-space position of u = v = 0, in the middle of the wall's thickness.
    pub(super) origin: Vec3,
    /// World-space direction of u, level and of unit length.
    pub(super) across: Vec3,
    /// Lowest and highest (u, v).
    pub(super) rectangle: [[f32; 2]; 2],
    pub(super) opening: Opening,
    pub(super) thickness: f32,
}

impl Bay {
    fn point(&self, [u, v]: [f32; 2], out: f32) -> Vec3 {
        self.origin + u * self.across + v * Vec3::Y + out * self.across.cross(Vec3::Y)
    }
}

/// An opening as (u, lowest v, highest v) from left to right.
pub(super) struct Opening(Vec<[f32; 3]>);

/// Straight pieces of a half circle.
const ARC_PIECES: u32 = 24;

impl Opening {
    /// An opening with level edges.
    pub(super) fn rectangle([left, bottom]: [f32; 2], [right, top]: [f32; 2]) -> Self {
        Self(vec![[left, bottom, top], [right, bottom, top]])
    }

    /// A door or window `2 * half_width` wide that ends in a pointed arch of two arcs; they rise from `springing`
    /// and have their centres `pointedness` half widths beyond the middle (0: a half circle).
    pub(super) fn arched(
        middle: f32,
        half_width: f32,
        [bottom, springing]: [f32; 2],
        pointedness: f32,
    ) -> Self {
        let radius = half_width * (1.0 + pointedness);
        let height = |u: f32| {
            let from_center = u.abs() + half_width * pointedness;
            springing
                + (radius * radius - from_center * from_center)
                    .max(0.0)
                    .sqrt()
        };
        Self(
            across_half_circle(half_width)
                .map(|u| [middle + u, bottom, height(u)])
                .collect(),
        )
    }

    /// A round window.
    pub(super) fn round([u, v]: [f32; 2], radius: f32) -> Self {
        let half_height = |x: f32| (radius * radius - x * x).max(0.0).sqrt();
        Self(
            across_half_circle(radius)
                .map(|x| [u + x, v - half_height(x), v + half_height(x)])
                .collect(),
        )
    }
}

/// From -radius to radius, evenly round a half circle.
fn across_half_circle(radius: f32) -> impl Iterator<Item = f32> {
    (0..=ARC_PIECES).map(move |i| {
        let turn = 0.5 * i as f32 / ARC_PIECES as f32;
        -radius * (TAU * turn).cos()
    })
}
