//! Plots as SVG: error against time, and the legends of the error pictures.

use std::ops::Range;

use plotters::{
    prelude::{
        Cartesian2d, ChartBuilder, ChartContext, Circle, Color, DashedLineSeries,
        DrawingAreaErrorKind, EmptyElement, IntoDrawingArea, IntoLogRange, IntoTextStyle,
        LineSeries, LogCoord, PathElement, RGBColor, Rectangle, SVGBackend, SeriesLabelPosition,
        TRANSPARENT, Text,
    },
    style::text_anchor::{HPos, Pos, VPos},
};

use super::{
    error_map::{ErrorMap, FLOOR},
    report::Report,
};
use crate::measure::PictureError;

/// Width and height of a plot \[pixels].
const SIZE: (u32, u32) = (640, 440);
/// Width and height of a legend \[pixels].
const LEGEND: (u32, u32) = (560, 64);
/// Colours that are told apart by all common kinds of colour vision (Okabe & Ito 2008), on light and on dark paper.
const SERIES: &[RGBColor] = &[
    RGBColor(213, 94, 0),
    RGBColor(0, 134, 209),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(176, 124, 0),
    RGBColor(122, 111, 240),
];
/// Colour of lines and text, which the page replaces in its dark mode.
const INK: RGBColor = RGBColor(0, 0, 0);

/// Why there is no plot.
#[derive(Debug, thiserror::Error)]
#[error("cannot plot: {0}")]
pub struct PlotError(String);

type Failed = DrawingAreaErrorKind<std::io::Error>;

impl From<Failed> for PlotError {
    fn from(error: Failed) -> Self {
        Self(error.to_string())
    }
}

/// The error that is plotted over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// relMAE.
    RelMae,
    /// 99th percentile.
    P99,
}

impl ErrorKind {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::RelMae => "relMAE",
            Self::P99 => "99th percentile",
        }
    }

    /// Its name in files.
    pub fn file_stem(self) -> &'static str {
        match self {
            Self::RelMae => "relmae",
            Self::P99 => "p99",
        }
    }

    fn of(self, errors: &PictureError) -> f64 {
        match self {
            Self::RelMae => errors.rel_mae,
            Self::P99 => errors.p99,
        }
    }
}

/// Error against median time on logarithmic axes, a line a technique, a mark a setting. Rows that have no place on such
/// axes, whose error or time is zero or infinite, are left out.
///
/// # Errors
/// [`PlotError`] where the plotting library fails.
pub fn error_against_time(report: &Report, kind: ErrorKind) -> Result<String, PlotError> {
    let series = series(report, kind);
    let points = || series.iter().flat_map(|series| &series.points);
    let times = decades(points().map(|point| point.time));
    let ends = times.clone();
    let floor = report.floor.as_ref().map(|errors| 100.0 * kind.of(errors));
    let floor = floor.filter(|error| is_placed(*error));
    let errors = decades(points().map(|point| point.error).chain(floor));
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(40)
            .x_label_area_size(52)
            .y_label_area_size(84)
            .build_cartesian_2d(times.log_scale(), errors.log_scale())?;
        chart
            .configure_mesh()
            .axis_style(INK)
            .bold_line_style(INK.mix(0.16))
            .light_line_style(INK.mix(0.05))
            .label_style(("sans-serif", 18))
            .axis_desc_style(("sans-serif", 19))
            .x_desc("median time [ms]")
            .y_desc(format!("{} [%]", kind.name()))
            .x_label_formatter(&number)
            .y_label_formatter(&number)
            .draw()?;
        if let Some(floor) = floor {
            draw_floor(&mut chart, ends, floor)?;
        }
        for (series, color) in series.iter().zip(SERIES.iter().cycle()) {
            draw_series(&mut chart, series, *color)?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .label_font(("sans-serif", 18))
            .background_style(TRANSPARENT)
            .border_style(TRANSPARENT)
            .draw()?;
        area.present()?;
    }
    Ok(svg)
}

/// A chart with logarithmic axes.
type LogChart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

/// A dashed line from end to end at the error of the converged shadow map \[percent].
fn draw_floor(chart: &mut LogChart<'_, '_>, ends: Range<f64>, floor: f64) -> Result<(), Failed> {
    let line = [(ends.start, floor), (ends.end, floor)];
    let style = INK.mix(0.6).stroke_width(1);
    chart
        .draw_series(DashedLineSeries::new(line, 6, 4, style))?
        .label("converged shadow map")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], INK.mix(0.6)));
    Ok(())
}

/// A technique's line, its marks and their labels.
fn draw_series(
    chart: &mut LogChart<'_, '_>,
    series: &Series<'_>,
    color: RGBColor,
) -> Result<(), Failed> {
    let positions = || series.points.iter().map(|point| (point.time, point.error));
    let mark = |position| Circle::new(position, 4, color.filled());
    chart
        .draw_series(LineSeries::new(positions(), color.stroke_width(2)))?
        .label(&series.name)
        .legend(move |(x, y)| Circle::new((x + 8, y), 5, color.filled()));
    chart.draw_series(positions().map(mark))?;
    let font = ("sans-serif", 16).into_text_style(chart.plotting_area());
    let font = font.color(&color).pos(Pos::new(HPos::Left, VPos::Bottom));
    chart.draw_series(series.points.iter().map(|point| {
        let offset = Text::new(point.label.to_owned(), (7, -3), font.clone());
        EmptyElement::at((point.time, point.error)) + offset
    }))?;
    Ok(())
}

/// The colours of an error picture with their numbers.
///
/// # Errors
/// [`PlotError`] where the plotting library fails.
pub fn legend(map: ErrorMap) -> Result<String, PlotError> {
    let (from, to) = (*map.decades().start(), *map.decades().end());
    let colors = map.ramp(LEGEND.0 as usize / 2);
    let width = (to - from) / colors.len() as f64;
    let swatch = |(index, [r, g, b]): (usize, [u8; 3])| {
        let left = from + index as f64 * width;
        // Two wide, under its neighbour: edges between pixels leave no seam.
        let right = (left + 2.0 * width).min(to);
        Rectangle::new([(left, 0.0), (right, 1.0)], RGBColor(r, g, b).filled())
    };
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, LEGEND).into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin(4)
            .margin_left(36)
            .margin_right(36)
            .x_label_area_size(28)
            .build_cartesian_2d(from..to, 0.0..1.0)?;
        chart.draw_series(colors.into_iter().enumerate().map(swatch))?;
        chart
            .configure_mesh()
            .disable_mesh()
            .disable_y_axis()
            .axis_style(INK)
            .label_style(("sans-serif", 18))
            .x_labels((to - from) as usize + 1)
            .x_label_formatter(&|decade| tick(*decade))
            .draw()?;
        area.present()?;
    }
    Ok(svg)
}

/// The error that a decade of an error picture stands for.
fn tick(decade: f64) -> String {
    let percent = 100.0 * FLOOR * 10.0_f64.powf(decade.abs());
    let sign = match decade {
        d if d > 0.0 => "+",
        d if d < 0.0 => "\u{2212}",
        _ => "\u{2264} ",
    };
    format!("{sign}{} %", number(&percent))
}

/// A power of ten, or what is between, without a tail of digits.
fn number(value: &f64) -> String {
    let digits = (-value.abs().log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}

/// A technique's line.
struct Series<'a> {
    /// The technique and where it ran.
    name: String,
    points: Vec<Point<'a>>,
}

/// A technique's setting.
struct Point<'a> {
    /// Milliseconds.
    time: f64,
    /// Percent.
    error: f64,
    label: &'a str,
}

fn series(report: &Report, kind: ErrorKind) -> Vec<Series<'_>> {
    let mut all: Vec<Series<'_>> = Vec::new();
    for row in &report.rows {
        let point = Point {
            time: row.timing.total().median,
            error: 100.0 * kind.of(&row.errors),
            label: row.setting.varied.as_ref().map_or("", |(_, value)| value),
        };
        if !is_placed(point.time) || !is_placed(point.error) {
            continue;
        }
        let name = format!("{} ({})", row.setting.technique, row.timing.place.name());
        match all.iter_mut().find(|series| series.name == name) {
            Some(series) => series.points.push(point),
            None => all.push(Series {
                name,
                points: vec![point],
            }),
        }
    }
    all
}

/// Whether a logarithmic axis has a place for it.
fn is_placed(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

/// The decades that hold all values, at least one; 1 to 10 where there is none.
fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return 1.0..10.0;
    }
    let low = low.log10().floor();
    let high = high.log10().ceil().max(low + 1.0);
    // A little more at both ends, or rounding costs the axis its first label.
    let power = |exponent: f64| 10.0_f64.powf(exponent);
    power(low) * (1.0 - 1e-6)..power(high) * (1.0 + 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture;

    #[test]
    fn ranges_are_whole_decades() {
        for (values, range) in [
            (&[0.02, 3.0][..], 0.01..10.0),
            (&[1.0], 1.0..10.0),
            (&[10.0, 20.0], 10.0..100.0),
            (&[], 1.0..10.0),
        ] {
            let found = decades(values.iter().copied());
            for (found, expected) in [(found.start, range.start), (found.end, range.end)] {
                assert!((found / expected - 1.0).abs() < 2e-6, "{found} {expected}");
            }
        }
    }

    #[test]
    fn numbers_have_as_many_digits_as_they_need() {
        for (value, text) in [(0.001, "0.001"), (0.1, "0.1"), (1.0, "1"), (1000.0, "1000")] {
            assert_eq!(number(&value), text);
        }
        assert_eq!(tick(0.0), "\u{2264} 0.01 %");
        assert_eq!(tick(-4.0), "\u{2212}100 %");
        assert_eq!(tick(2.0), "+1 %");
    }

    #[test]
    fn lines_join_settings_of_a_technique_and_leave_out_what_has_no_place() {
        let mut report = fixture::report();
        report.rows[0].errors.rel_mae = f64::INFINITY;
        report.rows[1].errors.p99 = 0.0;
        for (kind, out) in [(ErrorKind::RelMae, 0), (ErrorKind::P99, 1)] {
            let series = series(&report, kind);
            let found: usize = series.iter().map(|s| s.points.len()).sum();
            assert_eq!(found, report.rows.len() - 1);
            let label = report.rows[out].setting.varied.as_ref().unwrap().1.as_str();
            let mut labels = series[0].points.iter().map(|p| p.label);
            assert!(labels.all(|l| l != label));
        }
    }

    #[test]
    fn plots_hold_every_mark_and_say_their_units() {
        let report = fixture::report();
        let svg = error_against_time(&report, ErrorKind::RelMae).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("median time [ms]"));
        let marks = svg.matches("<circle").count();
        let techniques = series(&report, ErrorKind::RelMae).len();
        assert_eq!(marks, report.rows.len() + techniques);
        let mut nothing = report;
        nothing.rows.clear();
        assert!(error_against_time(&nothing, ErrorKind::P99).is_ok());
    }

    #[test]
    fn legends_give_every_decade_its_number() {
        for (map, labels) in [(ErrorMap::Magnitude, 5), (ErrorMap::Signed, 9)] {
            let svg = legend(map).unwrap();
            assert_eq!(svg.matches(" %").count(), labels, "{map:?}");
        }
    }
}
