//! Halton's sequence (1960), which fills the unit square evenly however many of its points are taken.

/// Point `index` of the sequence in bases 2 and 3, each coordinate in (0, 1).
pub(crate) fn halton(index: u32) -> [f64; 2] {
    [2, 3].map(|base| radical_inverse(index + 1, base))
}

/// The digits of `index` in this base, mirrored about the point.
fn radical_inverse(mut index: u32, base: u32) -> f64 {
    let (mut sum, mut place) = (0.0, 1.0);
    while index > 0 {
        place /= f64::from(base);
        sum += place * f64::from(index % base);
        index /= base;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_first_points_are_the_known_ones() {
        let known = [
            [1.0 / 2.0, 1.0 / 3.0],
            [1.0 / 4.0, 2.0 / 3.0],
            [3.0 / 4.0, 1.0 / 9.0],
            [1.0 / 8.0, 4.0 / 9.0],
            [5.0 / 8.0, 7.0 / 9.0],
            [3.0 / 8.0, 2.0 / 9.0],
        ];
        for (i, expected) in known.iter().enumerate() {
            let found = halton(i as u32);
            assert!(
                (0..2).all(|k| (found[k] - expected[k]).abs() < 1e-15),
                "{i}"
            );
        }
    }

    /// Each box of 1/16 by 1/27 holds one of the 2^4 3^3 points after the first.
    #[test]
    fn every_elementary_box_holds_one_point() {
        let mut counts = [0; 16 * 27];
        for i in 0..432 {
            let [x, y] = halton(i);
            // Places on a box's border are rounded to either side.
            counts[(x * 16.0) as usize * 27 + (y * 27.0 + 1e-9) as usize] += 1;
        }
        assert_eq!(counts, [1; 432]);
    }
}
