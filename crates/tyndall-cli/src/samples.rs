//! Seeded numbers.

use rand_pcg::{Pcg32, rand_core::Rng};
use std::ops::RangeInclusive;

/// Any fixed stream; the seed alone tells one list from another.
const STREAM: u64 = 1;

/// `count` points drawn evenly from inside a box of `N` dimensions.
/// The same seed gives the same points on every machine.
pub(crate) fn in_box<const N: usize>(
    seed: u64,
    count: usize,
    ranges: [RangeInclusive<f32>; N],
) -> Vec<[f32; N]> {
    let mut random = Pcg32::new(seed, STREAM);
    let mut draw = |_: usize| -> [f32; N] {
        std::array::from_fn(|i| {
            let (start, end) = (*ranges[i].start(), *ranges[i].end());
            (start + (end - start) * unit(&mut random)).clamp(start, end)
        })
    };
    (0..count).map(&mut draw).collect()
}

/// An f32 of [0, 1), all of whose 24 bits are random.
fn unit(random: &mut Pcg32) -> f32 {
    (random.next_u32() >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_inside_spread_over_the_whole_range_and_follow_the_seed() {
        let ranges = || [-1.0..=2.0, 5.0..=5.5];
        let points = in_box(7, 1000, ranges());
        assert_eq!(points.len(), 1000);
        for (i, range) in ranges().iter().enumerate() {
            assert!(points.iter().all(|p| range.contains(&p[i])));
            let mean = points.iter().map(|p| p[i]).sum::<f32>() / 1000.0;
            let middle = (range.start() + range.end()) / 2.0;
            // Standard error of the mean of 1000 even draws: 0.009 of the range.
            let width = range.end() - range.start();
            assert!((mean - middle).abs() < 0.03 * width, "{mean}");
        }
        assert_eq!(points, in_box(7, 1000, ranges()));
        assert_ne!(points, in_box(8, 1000, ranges()));
    }
}
