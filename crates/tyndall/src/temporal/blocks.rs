//! The pyramid of blocks of shadow-map texels, finest level first.

use crate::{gpu::scope::LightScope, shader::constant};

/// A light's shadow map in blocks.
pub(super) struct Pyramid {
    /// Texels of a face; 0 where there is no map.
    pub(super) map: [u32; 2],
    /// 0 where there is no map.
    pub(super) faces: u32,
    /// Blocks of each level's side, finest first; none without a map.
    pub(super) levels: Vec<[u32; 2]>,
}

impl Pyramid {
    pub(super) fn new(scope: &LightScope<'_>) -> Self {
        let map = scope.inputs.shadow_map.map(|map| map.texture().size());
        let map = map.map_or([0; 2], |size| [size.width, size.height]);
        let faces = if map == [0; 2] {
            0
        } else {
            scope.light.faces()
        };
        Self {
            map,
            faces,
            levels: levels(map),
        }
    }

    /// Texels of all faces.
    pub(super) fn texels(&self) -> u64 {
        u64::from(self.map[0]) * u64::from(self.map[1]) * u64::from(self.faces)
    }

    /// Blocks of all levels and faces.
    pub(super) fn blocks(&self) -> u64 {
        let of_level = |[columns, rows]: &[u32; 2]| u64::from(*columns) * u64::from(*rows);
        self.levels.iter().map(of_level).sum::<u64>() * u64::from(self.faces)
    }
}

/// Blocks of each level's side, finest first; none without a map.
pub(super) fn levels(map: [u32; 2]) -> Vec<[u32; 2]> {
    if map.contains(&0) {
        return Vec::new();
    }
    let side = constant("BLOCKS_SIDE");
    let mut levels = vec![map.map(|n| n.div_ceil(side))];
    while let Some(last) = levels.last().filter(|last| **last != [1; 2]) {
        levels.push(last.map(|n| n.div_ceil(2)));
    }
    levels
}
