//! Maps of coloured glass by ray casting.

use tyndall::{
    cpu::{GlassMap, Progress},
    frame::{Emitter, ShadowProjection},
};

use super::{
    map_rays::MapRays,
    tracer::{GlassHit, Tracer},
};
use crate::view::Ray;

/// Layers of a glass map: the most panes of tinted glass, one behind the other, that tint what is behind them.
pub const GLASS_LAYERS: u32 = 4;

impl Tracer {
    /// The tinted glass that light passes before the first opaque surface: at each texel's centre up to `layers` panes,
    /// nearest to the light first. Panes beyond that many are left out, and so are layers that are empty everywhere, but for
    /// the first. `None` where the scene has no tinted glass.
    pub fn glass_map(
        &self,
        emitter: &Emitter,
        projection: &ShadowProjection,
        size: [u32; 2],
        layers: u32,
        progress: Progress<'_>,
    ) -> Option<GlassMap> {
        if !self.has_tinted_glass() {
            return None;
        }
        let rays = MapRays::new(emitter, projection, size);
        let empty = [1.0, 1.0, 1.0, rays.far_value()];
        let [width, height] = size.map(|n| n as usize);
        // Layer by layer, as many as the row needs.
        let row_of_layers = |row: usize| {
            let (mut held, mut panes) = (Vec::new(), Vec::new());
            for (column, texel) in rays.row(row).enumerate() {
                self.find_panes(&texel.ray, texel.length, &mut panes);
                for (layer, pane) in panes.iter().take(layers as usize).enumerate() {
                    let [r, g, b] = pane.tint.as_vec3().to_array();
                    let first = layer * width;
                    held.resize(held.len().max(first + width), empty);
                    held[first + column] = [r, g, b, rays.stored_depth(&texel, pane.distance)];
                }
            }
            held
        };
        let rows = rays.map_rows(progress, row_of_layers);
        let most = rows.iter().map(|row| row.len() / width).max();
        let layers = most.unwrap_or(0).max(1);
        let mut texels = vec![empty; rays.face_count() * layers * height * width];
        for (row, held) in rows.iter().enumerate() {
            for (layer, held) in held.chunks_exact(width).enumerate() {
                let first = ((row / height * layers + layer) * height + row % height) * width;
                texels[first..first + width].copy_from_slice(held);
            }
        }
        Some(GlassMap {
            size,
            layers: layers as u32,
            texels,
        })
    }

    /// Finds the tinted glass in front of the first opaque surface, nearest first.
    fn find_panes(&self, ray: &Ray, length: f64, panes: &mut Vec<GlassHit>) {
        panes.clear();
        self.glass(ray, [0.0, length], panes);
        if !panes.is_empty() {
            if let Some(blocker) = self.closest(ray, [0.0, length]) {
                panes.retain(|pane| pane.distance < blocker.distance);
            }
            panes.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3, vec3};

    use super::*;
    use crate::{
        scene::{Blocking, Scene},
        test_scenes::{SUN_OVERHEAD, map_from_above, material, opaque, quad, scene},
    };

    #[test]
    fn glass_is_listed_from_the_light_up_to_the_first_blocker() {
        let layer = |height: f32| quad(vec3(-1.0, height, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z);
        let heights = [0.5, 2.0, 1.5, -0.5];
        let mut panes: Scene = scene(
            &heights.iter().flat_map(|&h| layer(h)).collect::<Vec<_>>(),
            |_| Vec2::ZERO,
            material(
                Blocking::Transmissive { transmission: 0.5 },
                [1.0, 0.5, 0.25, 1.0],
            ),
            None,
        );
        let mut floor = opaque(&layer(0.0));
        let mut mesh = floor.meshes.remove(0);
        mesh.primitives[0].material = 1;
        panes.materials.push(floor.materials.remove(0));
        panes.meshes[0].primitives.extend(mesh.primitives);
        let tracer = Tracer::new(&panes);
        for (layers, expected) in [(4, vec![0.75, 0.625, 0.375]), (2, vec![0.75, 0.625])] {
            let map = tracer
                .glass_map(
                    &SUN_OVERHEAD,
                    &map_from_above(true),
                    [4, 4],
                    layers,
                    &|_, _| (),
                )
                .unwrap();
            assert_eq!(map.layers as usize, expected.len(), "no layer is empty");
            assert_eq!(map.texels.len(), 16 * expected.len());
            for (layer, expected) in expected.into_iter().enumerate() {
                // A texel over the panes, on their diagonal: no pane counts twice there.
                let [r, g, b, depth] = map.texels[16 * layer + 10];
                assert!((depth - expected).abs() < 1e-6, "layer {layer}: {depth}");
                assert_eq!([r, g, b], [0.5, 0.25, 0.125]);
                assert_eq!(
                    map.texels[16 * layer],
                    [1.0, 1.0, 1.0, 0.0],
                    "beside the panes"
                );
            }
        }
        let no_glass = Tracer::new(&opaque(&layer(0.0)));
        assert_eq!(
            no_glass.glass_map(&SUN_OVERHEAD, &map_from_above(true), [4, 4], 4, &|_, _| ()),
            None
        );
    }
}
