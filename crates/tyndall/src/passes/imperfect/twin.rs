//! The shaders' twins, in f64 and texel by texel.

use glam::{DVec2, DVec3};

/// The place on the map of a direction in a sample's frame, z >= 0.
pub(crate) fn place(local: DVec3) -> DVec2 {
    let p = local.truncate() / (local.x.abs() + local.y.abs() + local.z);
    0.5 + 0.5 * DVec2::new(p.x + p.y, p.x - p.y)
}

/// The unit direction of a place.
pub(crate) fn direction(place: DVec2) -> DVec3 {
    let q = 2.0 * place - 1.0;
    let p = 0.5 * DVec2::new(q.x + q.y, q.x - q.y);
    p.extend(1.0 - p.x.abs() - p.y.abs()).normalize()
}

/// The index of the texel of a map of `side`^2 at a place.
pub(crate) fn texel(side: usize, place: DVec2) -> usize {
    let [x, y] = (place * side as f64)
        .to_array()
        .map(|x| (x as usize).min(side - 1));
    y * side + x
}

/// Points in a sample's frame with their radii, onto an empty map.
pub(crate) fn splat(side: usize, points: impl Iterator<Item = (DVec3, f64)>) -> Vec<Option<f64>> {
    let mut map: Vec<Option<f64>> = vec![None; side * side];
    for (local, radius) in points.filter(|(local, _)| local.z > 0.0) {
        let distance = local.length();
        let texels = 0.5 * radius / distance * side as f64 / std::f64::consts::TAU.sqrt();
        let reach = texels.min(3.0) as i64;
        let middle = texel(side, place(local)) as i64;
        let side = side as i64;
        for (y, x) in (0..side * side).map(|i| (i / side, i % side)) {
            if (x - middle % side).abs() <= reach && (y - middle / side).abs() <= reach {
                let held = &mut map[(y * side + x) as usize];
                *held = Some(held.map_or(distance, |d: f64| d.min(distance)));
            }
        }
    }
    map
}

/// The mean of those of four cells that are about as near as the nearest; `None` of less than two.
fn mean(cells: [Option<f64>; 4]) -> Option<f64> {
    let held: Vec<f64> = cells.iter().flatten().copied().collect();
    let nearest = held.iter().copied().fold(f64::INFINITY, f64::min);
    let near: Vec<f64> = held
        .iter()
        .copied()
        .filter(|d| *d <= 1.1 * nearest)
        .collect();
    (held.len() >= 2).then(|| near.iter().sum::<f64>() / near.len() as f64)
}

/// Half as many cells a side.
fn pull(side: usize, fine: &[Option<f64>]) -> Vec<Option<f64>> {
    let half = side.div_ceil(2);
    let at = |x: usize, y: usize| (x < side && y < side).then(|| fine[y * side + x]).flatten();
    let cell = |i: usize| {
        let (x, y) = (2 * (i % half), 2 * (i / half));
        mean([at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)])
    };
    (0..half * half).map(cell).collect()
}

/// The map with its holes filled from blocks of two and of four texels a side.
pub(crate) fn pull_push(side: usize, map: &[Option<f64>]) -> Vec<Option<f64>> {
    let twos = pull(side, map);
    let half = side.div_ceil(2);
    let fours = pull(half, &twos);
    let filled = |i: usize| {
        let (x, y) = (i % side, i / side);
        let two = twos[y / 2 * half + x / 2];
        map[i].or(two).or(fours[y / 4 * half.div_ceil(2) + x / 4])
    };
    (0..side * side).map(filled).collect()
}
