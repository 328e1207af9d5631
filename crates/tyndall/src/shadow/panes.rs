//! Sums up a glass map by blocks, and these by larger ones: most of a map holds no tint, or one, and a walk passes over it
//! block by block.

use glam::DVec3;
use rayon::prelude::*;

use crate::{inputs::GlassMap, physics::reals};

/// Blocks of a glass map, the largest first: each level is made of the next one's. None where texels do not fill blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct Panes {
    levels: Vec<Level>,
}

/// Blocks of one size.
#[derive(Clone, Debug)]
pub(super) struct Level {
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
    /// `near_is_one` turns a depth of the map's own convention.
    pub(super) fn new(glass: &GlassMap, near_is_one: impl Fn(f32) -> f64 + Sync) -> Self {
        let plane = glass.size[0] as usize * glass.size[1] as usize;
        let layers = glass.layers as usize;
        let texel = |texel: usize| {
            let (face, place) = (texel / plane, texel % plane);
            let layer = |layer: usize| {
                let [r, g, b, depth] = glass.texels[(face * layers + layer) * plane + place];
                (near_is_one(depth), reals([r, g, b]))
            };
            Block::of_layers((0..layers).map(layer))
        };
        let faces = glass.texels.len() / (plane * layers).max(1);
        let mut levels: Vec<Level> = Vec::new();
        let mut next = Level::over(faces, glass.size, texel);
        while let Some(level) = next {
            next = Level::over(faces, level.size, |block| level.blocks[block]);
            levels.push(level);
        }
        levels.reverse();
        Self { levels }
    }

    /// A level, 0 that of the largest blocks; `None` past that of the smallest.
    pub(super) fn level(&self, level: usize) -> Option<&Level> {
        self.levels.get(level)
    }
}

impl Level {
    /// Parts a side of a block.
    const PARTS: usize = 4;

    /// Blocks over parts, so many a face, numbered face by face, row by row. `None` where they do not end where parts do.
    fn over(faces: usize, parts: [u32; 2], part: impl Fn(usize) -> Block + Sync) -> Option<Self> {
        let [width, height] = parts.map(|n| n as usize);
        if width == 0 || [width, height].iter().any(|n| n % Self::PARTS != 0) {
            return None;
        }
        let row_of_blocks = |row: usize| {
            (0..width / Self::PARTS).map(move |column| (Self::PARTS * row, Self::PARTS * column))
        };
        let unite = |(row, column): (usize, usize)| {
            let rows = row..row + Self::PARTS;
            let parts = rows.flat_map(|y| (0..Self::PARTS).map(move |x| y * width + column + x));
            parts.map(&part).reduce(Block::unite)
        };
        let rows = (0..faces * height / Self::PARTS).into_par_iter();
        Some(Self {
            size: [width, height].map(|n| (n / Self::PARTS) as u32),
            blocks: rows
                .flat_map_iter(row_of_blocks)
                .filter_map(unite)
                .collect(),
        })
    }

    /// A block of a face.
    pub(super) fn block(&self, face: usize, block: usize) -> &Block {
        &self.blocks[face * self.size[0] as usize * self.size[1] as usize + block]
    }
}
