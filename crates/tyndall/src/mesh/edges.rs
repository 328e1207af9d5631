//! Edges of a mesh, and the triangles that share them.

use std::collections::HashMap;

use super::error::OccluderError;

/// A welded mesh.
pub(super) struct Edges {
    /// Positions, no two alike.
    pub(super) corners: Vec<[f32; 3]>,
    /// Corners of each triangle.
    pub(super) triangles: Vec<[u32; 3]>,
    /// An edge's two corners, and the third corner of each of its two triangles; [`NONE`] twice where it has one
    /// triangle, or more than two.
    pub(super) edges: Vec<[u32; 4]>,
}

/// No corner.
pub(super) const NONE: u32 = u32::MAX;

impl Edges {
    pub(super) fn new(positions: &[[f32; 3]], indices: &[u32]) -> Result<Self, OccluderError> {
        check(positions, indices)?;
        let (corners, corner_of) = weld(positions);
        let (given, _) = indices.as_chunks::<3>();
        let mut triangles: Vec<[u32; 3]> = given
            .iter()
            .map(|triangle| triangle.map(|i| corner_of[i as usize]))
            .map(|mut triangle| {
                triangle.sort_unstable();
                triangle
            })
            .filter(|[a, b, c]| a != b && b != c)
            .collect();
        triangles.sort_unstable();
        triangles.dedup();
        let edges = edges(&triangles);
        Ok(Self {
            corners,
            triangles,
            edges,
        })
    }
}

impl Edges {
    /// Smallest and largest coordinates; zeros of nothing.
    pub(super) fn bounds(&self) -> [[f32; 3]; 2] {
        let first = self.corners.first().copied().unwrap_or_default();
        self.corners.iter().fold([first; 2], |[least, most], p| {
            [
                [0, 1, 2].map(|k| least[k].min(p[k])),
                [0, 1, 2].map(|k| most[k].max(p[k])),
            ]
        })
    }
}

fn check(positions: &[[f32; 3]], indices: &[u32]) -> Result<(), OccluderError> {
    if !indices.len().is_multiple_of(3) {
        return Err(OccluderError::Indices {
            found: indices.len(),
        });
    }
    let is_finite = |position: &[f32; 3]| position.iter().all(|x| x.is_finite());
    if let Some(index) = positions.iter().position(|p| !is_finite(p)) {
        return Err(OccluderError::Position {
            index,
            found: positions[index],
        });
    }
    match indices.iter().position(|i| *i as usize >= positions.len()) {
        None => Ok(()),
        Some(index) => Err(OccluderError::Index {
            index,
            positions: positions.len(),
            found: indices[index],
        }),
    }
}

/// Distinct positions, and which of them each given one is.
fn weld(positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, Vec<u32>) {
    let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    let mut corners = Vec::new();
    let corner_of = positions
        .iter()
        .map(|position| {
            // -0 + 0 = 0: zeros of both signs are one place.
            let place = position.map(|x| (x + 0.0).to_bits());
            *known.entry(place).or_insert_with(|| {
                corners.push(*position);
                corners.len() as u32 - 1
            })
        })
        .collect();
    (corners, corner_of)
}

fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 4]> {
    let sides = |[a, b, c]: &[u32; 3]| [[*a, *b, *c], [*b, *c, *a], [*a, *c, *b]];
    let mut sides: Vec<[u32; 3]> = triangles.iter().flat_map(sides).collect();
    sides.sort_unstable();
    sides
        .chunk_by(|x, y| x[..2] == y[..2])
        .map(|shared| match *shared {
            [[a, b, c], [_, _, d]] => [a, b, c, d],
            [[a, b, c]] => [a, b, c, NONE],
            _ => [shared[0][0], shared[0][1], NONE, NONE],
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(n: usize) -> Vec<[f32; 3]> {
        (0..n).map(|i| [i as f32, (i * i) as f32, 1.0]).collect()
    }

    #[test]
    fn edges_know_their_triangles() {
        // Two triangles that share an edge; three on one edge; a repeated and a flat one.
        for (name, indices, expected) in [
            (
                "a pair",
                &[0, 1, 2, 2, 1, 3][..],
                &[
                    [0, 1, 2, NONE],
                    [0, 2, 1, NONE],
                    [1, 2, 0, 3],
                    [1, 3, 2, NONE],
                    [2, 3, 1, NONE],
                ][..],
            ),
            (
                "a fin",
                &[0, 1, 2, 0, 1, 3, 1, 0, 4],
                &[
                    [0, 1, NONE, NONE],
                    [0, 2, 1, NONE],
                    [0, 3, 1, NONE],
                    [0, 4, 1, NONE],
                    [1, 2, 0, NONE],
                    [1, 3, 0, NONE],
                    [1, 4, 0, NONE],
                ],
            ),
            (
                "both sides of one triangle, and a flat one",
                &[0, 1, 2, 2, 1, 0, 3, 3, 4],
                &[[0, 1, 2, NONE], [0, 2, 1, NONE], [1, 2, 0, NONE]],
            ),
            ("nothing", &[], &[]),
        ] {
            let mesh = Edges::new(&places(5), indices).expect("a good mesh");
            assert_eq!(mesh.edges, expected, "{name}");
        }
    }

    #[test]
    fn equal_positions_are_one_corner() {
        // A strip of two triangles without shared vertices; one zero is negative.
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, -0.0],
            [1.0, 0.0, -0.0],
            [1.0, 1.0, 0.0],
        ];
        let mesh = Edges::new(&positions, &[0, 1, 2, 3, 4, 5]).expect("a good mesh");
        assert_eq!(mesh.corners.len(), 4);
        let shared = mesh.edges.iter().filter(|edge| edge[3] != NONE).count();
        assert_eq!((mesh.edges.len(), shared), (5, 1));
    }

    #[test]
    fn broken_meshes_are_refused_with_what_was_found() {
        let mut holes = places(3);
        holes[1][2] = f32::NAN;
        for (positions, indices, message) in [
            (
                places(3),
                &[0, 1][..],
                "indices must be three a triangle, found 2",
            ),
            (
                places(3),
                &[0, 1, 3],
                "indices[2] must be below 3, the number of positions, found 3",
            ),
            (
                holes,
                &[0, 1, 2],
                "positions[1] must be finite, found [1.0, 1.0, NaN]",
            ),
        ] {
            let error = Edges::new(&positions, indices).err().expect("refused");
            assert_eq!(error.to_string(), message);
        }
    }
}
