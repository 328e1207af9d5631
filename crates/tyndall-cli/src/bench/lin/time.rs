//! Frames timed with reuse and without.

use tyndall::temporal::ReuseMask;

use super::films::{Films, KEPT, film, reuse};
use crate::{
    bench::{
        report::Bench,
        subject::Subject,
        table::{Cell, Table},
    },
    failure::Failure,
    measure::TakeFrame,
};

/// Times a scene's frames without reuse, by what changes, and by the thesis's mask.
pub(super) fn time(
    films: &Films,
    scene: &Subject,
    values: &[&str],
    thesis: &str,
    bench: &Bench,
    report: &dyn Fn(u64, u64),
) -> Result<Vec<Cell>, Failure> {
    let takes = [
        None,
        reuse(ReuseMask::Change, None),
        reuse(ReuseMask::Geometry, Some(KEPT)),
    ];
    let Some((mut film, what)) = film(scene, values, films.size, films.map, &takes, bench)? else {
        return Ok(Vec::new());
    };
    // Pipelines are made with the first frame.
    film.frame(0)?;
    let mut sums = [TakeFrame::default(); 3];
    for number in 1..=films.timed {
        for (sum, frame) in sums.iter_mut().zip(film.frame(number)?) {
            sum.milliseconds += frame.milliseconds / f64::from(films.timed);
            sum.computed += frame.computed / f64::from(films.timed);
        }
        report(number.into(), films.timed.into());
    }
    let [plain, change, geometry] = sums;
    let mut cells = vec![
        Cell::text(scene.name),
        Cell::text(what),
        plain.milliseconds.into(),
    ];
    for take in [change, geometry] {
        cells.extend([
            take.computed.into(),
            take.milliseconds.into(),
            (plain.milliseconds / take.milliseconds).into(),
        ]);
    }
    cells.push(Cell::text(thesis));
    Ok(cells)
}

/// The table of frames timed by one technique.
pub(super) fn times_table(films: &Films, technique: &str, rows: Vec<Vec<Cell>>) -> Table {
    let ([width, height], map, timed) = (films.size, films.map, films.timed);
    Table {
        title: format!("temporal reuse about {technique}"),
        notes: vec![
            format!(
                "{width} x {height} pixels, {map}^2 shadow map; {timed} frames of 60 in a row, those of all three in turn; means of a frame, of the effect's passes alone"
            ),
            "covered: share of the pixels that were computed".to_owned(),
            format!(
                "change: pixels that see a change of depth or shadow map, any number of frames; geometry: the thesis's mask, a full frame every {}",
                KEPT + 1
            ),
        ],
        columns: vec![
            "scene",
            "of",
            "without ms",
            "change: covered",
            "ms",
            "speed-up",
            "geometry: covered",
            "ms ",
            "speed-up ",
            "the thesis's, about hybrid",
        ],
        rows,
    }
}
