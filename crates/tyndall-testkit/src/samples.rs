//! Seeded inputs for comparing a function with its twin.

use rand_pcg::{Pcg32, rand_core::Rng};
use std::ops::RangeInclusive;

/// Any fixed stream; the seed alone tells one list from another.
const STREAM: u64 = 1;

/// Every corner of a box of `N` dimensions, then `count` points drawn evenly from inside it.
/// The same seed gives the same points on every machine.
pub fn in_box<const N: usize>(
    seed: u64,
    count: usize,
    ranges: [RangeInclusive<f32>; N],
) -> Vec<[f32; N]> {
    let corner = |bits: usize| -> [f32; N] {
        std::array::from_fn(|i| match bits >> i & 1 {
            0 => *ranges[i].start(),
            _ => *ranges[i].end(),
        })
    };
    let mut random = Pcg32::new(seed, STREAM);
    let mut draw = |_: usize| -> [f32; N] {
        std::array::from_fn(|i| {
            let (start, end) = (*ranges[i].start(), *ranges[i].end());
            (start + (end - start) * unit(&mut random)).clamp(start, end)
        })
    };
    let corners = (0..1_usize << N).map(corner);
    corners.chain((0..count).map(&mut draw)).collect()
}

/// An f32 of [0, 1), all of whose 24 bits are random.
fn unit(random: &mut Pcg32) -> f32 {
    (random.next_u32() >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_come_first_and_all_points_are_inside() {
        let points = in_box(7, 1000, [-1.0..=2.0, 5.0..=5.5]);
        assert_eq!(points.len(), 1004);
        assert_eq!(
            points[..4],
            [[-1.0, 5.0], [2.0, 5.0], [-1.0, 5.5], [2.0, 5.5]]
        );
        assert!(
            points
                .iter()
                .all(|p| (-1.0..=2.0).contains(&p[0]) && (5.0..=5.5).contains(&p[1]))
        );
    }

    #[test]
    fn points_spread_over_the_whole_range_and_follow_the_seed() {
        let points = in_box(7, 1000, [0.0..=1.0]);
        let mean = points.iter().map(|p| p[0]).sum::<f32>() / points.len() as f32;
        // Standard error of the mean of 1000 even draws: 0.009.
        assert!((mean - 0.5).abs() < 0.03, "{mean}");
        assert_eq!(points, in_box(7, 1000, [0.0..=1.0]));
        assert_ne!(points, in_box(8, 1000, [0.0..=1.0]));
    }
}
