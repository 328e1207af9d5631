//! Sums up a glass map by blocks: most of a map holds no tint, or one, and a walk passes over it block by block.

use glam::DVec3;
use rayon::prelude::*;

use crate::{inputs::GlassMap, physics::reals};

/// Blocks of a glass map; the twin of the light volumes' `panes.wesl`.
#[derive(Clone, Debug, Default)]
pub(super) struct Panes {
    /// Blocks a face.
    pub(super) size: [u32; 2],
    /// Face by face, row by row.
    blocks: Vec<Block>,
}

/// Depths are 1 nearest to the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    /// The farthest layer that tints; 1 where there is none.
    farthest: f64,
    /// The nearest layer that tints; 0 where there is none.
    nearest: f64,
    /// Behind all of the glass; `None` where texels differ.
    tint: Option<DVec3>,
}

impl Block {
    const CLEAR: Self = Self {
        farthest: 1.0,
        nearest: 0.0,
        tint: Some(DVec3::ONE),
    };

    /// The glass of one texel, layer by layer.
    fn of_layers(layers: impl Iterator<Item = (f64, DVec3)>) -> Self {
        layers
            .filter(|(depth, tint)| *depth > 0.0 && *tint != DVec3::ONE)
            .fold(Self::CLEAR, |all, (depth, tint)| Self {
                farthest: all.farthest.min(depth),
                nearest: all.nearest.max(depth),
                tint: all.tint.map(|before| before * tint),
            })
    }

    fn unite(self, other: Self) -> Self {
        Self {
            farthest: self.farthest.min(other.farthest),
            nearest: self.nearest.max(other.nearest),
            tint: self.tint.filter(|_| self.tint == other.tint),
        }
    }

    /// The tint of all of a ray's stretch over the block; `None` where the block cannot tell. `margins` are >= 0 where
    /// light that has passed this depth reaches the stretch's start, and its end: what lies between follows.
    pub(super) fn tint_of(&self, margins: impl Fn(f64) -> [f64; 2]) -> Option<DVec3> {
        let is_before = || margins(self.nearest).iter().all(|m| *m >= 0.0);
        if self.tint == Some(DVec3::ONE) || is_before() {
            return Some(DVec3::ONE);
        }
        let is_behind = || margins(self.farthest).iter().all(|m| *m < 0.0);
        self.tint.filter(|_| is_behind())
    }
}

impl Panes {
    /// Texels a side of a block.
    const BLOCK: u32 = 16;

    /// `near_is_one` turns a depth of the map's own convention.
    pub(super) fn new(glass: &GlassMap, near_is_one: impl Fn(f32) -> f64 + Sync) -> Self {
        // Blocks must end where texels do.
        let block = if glass.size.iter().all(|n| n % Self::BLOCK == 0) {
            Self::BLOCK
        } else {
            1
        };
        let [width, height] = glass.size.map(|n| n as usize);
        let (layers, plane) = (glass.layers.max(1) as usize, width * height);
        let size = glass.size.map(|n| n / block);
        let texel = |face: usize, texel: usize| {
            let layer = |layer: usize| {
                let [r, g, b, depth] = glass.texels[(face * layers + layer) * plane + texel];
                (near_is_one(depth), reals([r, g, b]))
            };
            Block::of_layers((0..layers).map(layer))
        };
        let block = block as usize;
        let row = |(i, row): (usize, &mut [Block])| {
            let (face, first) = (i / size[1] as usize, i % size[1] as usize * block);
            for (column, united) in row.iter_mut().enumerate() {
                let rows = first..first + block;
                let texels =
                    rows.flat_map(|y| (0..block).map(move |x| y * width + column * block + x));
                let all = texels.map(|at| texel(face, at)).reduce(Block::unite);
                *united = all.unwrap_or(Block::CLEAR);
            }
        };
        let faces = glass.texels.len() / (plane * layers);
        let mut blocks = vec![Block::CLEAR; faces * size[0] as usize * size[1] as usize];
        blocks
            .par_chunks_mut(size[0] as usize)
            .enumerate()
            .for_each(row);
        Self { size, blocks }
    }

    /// A block of a face.
    pub(super) fn block(&self, face: usize, block: usize) -> &Block {
        &self.blocks[face * self.size[0] as usize * self.size[1] as usize + block]
    }
}
