//! Pixels that reuse leaves stale.

use tyndall::temporal::{Reuse, ReuseMask};

use super::films::{Films, KEPT, film, reuse};
use crate::{
    bench::{
        report::Bench,
        subject::{self, Subject},
        table::{Cell, Table},
    },
    failure::Failure,
};

/// Pixels of a take that differ from the frame computed from nothing.
#[derive(Clone, Copy, Default)]
struct Left {
    covered: f64,
    stale: u64,
    most: u64,
    frames: u64,
    error: f64,
}

impl Left {
    fn add(&mut self, kept: &[f32], fresh: &[f32]) {
        let (kept, _) = kept.as_chunks::<4>();
        let (fresh, _) = fresh.as_chunks::<4>();
        let light = |pixel: &[f32; 4]| [pixel[0], pixel[1], pixel[2]].map(f64::from);
        let mean = fresh.iter().flat_map(light).sum::<f64>() / (3 * fresh.len().max(1)) as f64;
        let differ = |(a, b): &(&[f32; 4], &[f32; 4])| a.map(f32::to_bits) != b.map(f32::to_bits);
        let stale: Vec<_> = kept.iter().zip(fresh).filter(differ).collect();
        let errors = stale.iter().flat_map(|(a, b)| {
            let (a, b) = (light(a), light(b));
            [0, 1, 2].map(|k| (a[k] - b[k]).abs())
        });
        self.error = errors.fold(self.error, |most, error| most.max(error / mean));
        self.stale += stale.len() as u64;
        self.most = self.most.max(stale.len() as u64);
        self.frames += u64::from(!stale.is_empty());
    }
}

/// Compares every frame by each mask with the frame computed from nothing.
pub(super) fn compare(
    films: &Films,
    scene: &Subject,
    bench: &Bench,
    report: &dyn Fn(u64, u64),
) -> Result<Vec<Vec<Cell>>, Failure> {
    let masks = [
        ("change", reuse(ReuseMask::Change, None)),
        (
            "geometry, full every 4",
            reuse(ReuseMask::Geometry, Some(KEPT)),
        ),
        ("geometry", reuse(ReuseMask::Geometry, None)),
    ];
    let takes: Vec<Option<Reuse>> = std::iter::once(None).chain(masks.map(|m| m.1)).collect();
    let size = films.compared_size;
    let Some((mut film, _)) = film(scene, &[], size, films.map, &takes, bench)? else {
        return Ok(Vec::new());
    };
    let mut left = [Left::default(); 3];
    for number in 0..films.compared {
        let frames = film.frame(number)?;
        let outputs = film.outputs()?;
        for (k, left) in left.iter_mut().enumerate() {
            left.add(&outputs[k + 1], &outputs[0]);
            left.covered += frames[k + 1].computed / f64::from(films.compared);
        }
        report(u64::from(number) + 1, films.compared.into());
    }
    let row = |((name, _), left): (&(&str, _), &Left)| {
        vec![
            Cell::text(*name),
            left.covered.into(),
            Cell::Count(left.stale),
            Cell::Count(left.most),
            Cell::Count(left.frames),
            left.error.into(),
        ]
    };
    Ok(masks.iter().zip(&left).map(row).collect())
}

/// The table of stale pixels.
pub(super) fn left_table(films: &Films, rows: Vec<Vec<Cell>>) -> Table {
    let ([width, height], compared) = (films.compared_size, films.compared);
    Table {
        title: format!("what is left stale, {}", subject::DONUTS.name),
        notes: vec![
            format!(
                "{width} x {height} pixels, {compared} frames, each against the frame computed from nothing, bit by bit"
            ),
            "largest error: of a channel of a pixel, over the mean of the picture".to_owned(),
        ],
        columns: vec![
            "mask",
            "covered",
            "stale pixels",
            "most in a frame",
            "frames with any",
            "largest error",
        ],
        rows,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_counted_bit_by_bit() {
        let fresh = [1.0, 2.0, 3.0, 0.5, 1.0, 2.0, 3.0, 0.5];
        let mut kept = fresh;
        let mut left = Left::default();
        left.add(&kept, &fresh);
        assert_eq!((left.stale, left.frames, left.error), (0, 0, 0.0));
        kept[5] = 3.0;
        left.add(&kept, &fresh);
        left.add(&kept, &fresh);
        assert_eq!((left.stale, left.most, left.frames), (2, 1, 2));
        assert_eq!(left.error, 0.5);
        kept[5] = 2.0_f32.next_up();
        let mut left = Left::default();
        left.add(&kept, &fresh);
        assert_eq!(left.stale, 1);
    }
}
