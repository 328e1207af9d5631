//! Hammersley's points (1960), which fill the unit square evenly, whatever their number.

/// Point `index` of `count`: even along the first side, Van der Corput's sequence along the second, each coordinate in [0, 1).
pub(crate) fn hammersley(index: u32, count: u32) -> [f64; 2] {
    let even = (f64::from(index) + 0.5) / f64::from(count);
    // The bits of the index, mirrored about the point.
    let mirrored = f64::from(index.reverse_bits()) / 4_294_967_296.0;
    [even, mirrored]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_first_points_are_the_known_ones() {
        let found = [0, 1, 2, 3].map(|i| hammersley(i, 4));
        let known = [[0.125, 0.0], [0.375, 0.5], [0.625, 0.25], [0.875, 0.75]];
        assert_eq!(found, known);
    }

    /// Each box of 2^-k by 2^(k - 8) holds one of 256 points.
    #[test]
    fn every_elementary_box_holds_one_point() {
        for columns in [1_u32, 2, 4, 16, 64, 256] {
            let mut counts = [0; 256];
            for i in 0..256 {
                let [x, y] = hammersley(i, 256);
                let rows = 256 / columns;
                let [column, row] = [x * f64::from(columns), y * f64::from(rows)].map(|p| p as u32);
                counts[(column * rows + row) as usize] += 1;
            }
            assert_eq!(counts, [1; 256], "{columns}");
        }
    }
}
