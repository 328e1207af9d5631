//! The table of costs and errors.

use super::template::Html;
use crate::{
    compare::report::{Report, Row},
    measure::Spread,
};

/// A column of numbers: smaller is better.
struct Column {
    title: &'static str,
    /// Its meaning.
    about: &'static str,
    /// The number that rows are sorted and judged by.
    value: fn(&Row) -> Option<f64>,
    text: fn(&Row) -> String,
}

const COLUMNS: &[Column] = &[
    Column {
        title: "total [ms]",
        about: "median over frames, quartiles in brackets",
        value: |row| Some(row.timing.total().median),
        text: |row| milliseconds(&row.timing.total()),
    },
    Column {
        title: "\u{f7} limit",
        about: "total time as a multiple of reading depth and shadow map once and writing the output once",
        value: |row| row.over_limit,
        text: |row| or_dash(row.over_limit.map(three_digits)),
    },
    Column {
        title: "memory",
        about: "bytes of textures and buffers",
        value: |row| row.timing.bytes.map(|bytes| bytes as f64),
        text: |row| or_dash(row.timing.bytes.map(bytes)),
    },
    Column {
        title: "relMAE",
        about: "mean |a \u{2212} b| / mean(b)",
        value: |row| Some(row.errors.rel_mae),
        text: |row| percent(row.errors.rel_mae),
    },
    Column {
        title: "relRMSE",
        about: "square root of mean (a \u{2212} b)\u{b2} / mean(b)",
        value: |row| Some(row.errors.rel_rmse),
        text: |row| percent(row.errors.rel_rmse),
    },
    Column {
        title: "p99",
        about: "99th percentile of |a \u{2212} b| / mean(b)",
        value: |row| Some(row.errors.p99),
        text: |row| percent(row.errors.p99),
    },
    Column {
        title: "bias",
        about: "mean (a \u{2212} b) / mean(b): positive is too bright",
        value: |row| Some(row.errors.bias.abs()),
        text: |row| signed_percent(row.errors.bias),
    },
    Column {
        title: "steps a ray",
        about: "samples of visibility a ray, over all lights",
        value: |row| row.steps.map(|steps| steps as f64),
        text: |row| or_dash(row.steps.map(|steps| steps.to_string())),
    },
];

pub(super) fn table(report: &Report) -> Html {
    let heads: String = COLUMNS.iter().map(head).collect();
    let rows: String = report.rows.iter().map(|row| line(row, report)).collect();
    Html::trusted(&format!(
        "<thead><tr>{}{}{heads}</tr></thead>\n<tbody>{rows}</tbody>",
        sortable("technique", "the technique and its parameters, by name"),
        "<th scope=\"col\">passes [ms]</th>",
    ))
}

fn head(column: &Column) -> String {
    sortable(column.title, column.about)
}

fn sortable(title: &str, about: &str) -> String {
    let (title, about) = (Html::text(title), Html::text(about));
    format!("<th scope=\"col\"><button type=\"button\" title=\"{about}\">{title}</button></th>")
}

fn line(row: &Row, report: &Report) -> String {
    let cells: String = COLUMNS
        .iter()
        .map(|column| cell(column, row, report))
        .collect();
    let parameters: Vec<String> = row
        .setting
        .parameters
        .iter()
        .map(|(key, value)| format!("{key} {value}"))
        .collect();
    format!(
        "<tr><th scope=\"row\" data-value=\"{label}\">{label}<small>{}</small></th><td class=\"passes\">{}</td>{cells}</tr>\n",
        Html::text(&parameters.join(", ")),
        passes(row),
        label = Html::text(&row.setting.label()),
    )
}

fn cell(column: &Column, row: &Row, report: &Report) -> String {
    let value = (column.value)(row);
    let values = || report.rows.iter().filter_map(column.value);
    let best = values().fold(f64::INFINITY, f64::min);
    let is_best = value == Some(best) && values().any(|other| other > best);
    let (class, mark) = if is_best {
        let mark = " <span title=\"best of the column\">\u{25c6}</span>";
        (" class=\"best\"", mark)
    } else {
        ("", "")
    };
    let sort = value.unwrap_or(f64::INFINITY);
    let text = Html::text(&(column.text)(row));
    format!("<td data-value=\"{sort}\"{class}>{text}{mark}</td>")
}

fn passes(row: &Row) -> String {
    let timing = &row.timing;
    let place = format!(
        "{}, {} frames, wall clock {}",
        timing.place.name(),
        timing.frames,
        milliseconds(&timing.wall)
    );
    let line = |(name, time): &(String, Spread)| {
        let (name, time) = (Html::text(name), milliseconds(time));
        format!("<li><code>{name}</code> {time}</li>")
    };
    let lines: String = timing.passes.iter().map(line).collect();
    format!("<ul>{lines}</ul><small>{place}</small>")
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "\u{2013}".to_owned())
}

pub(super) fn milliseconds(time: &Spread) -> String {
    let [lower, median, upper] = [time.lower, time.median, time.upper].map(three_digits);
    format!("{median} ({lower}\u{2013}{upper})")
}

fn bytes(bytes: u64) -> String {
    match bytes {
        0..1024 => format!("{bytes} B"),
        1024..1_048_576 => format!("{} KiB", three_digits(bytes as f64 / 1024.0)),
        _ => format!("{} MiB", three_digits(bytes as f64 / 1_048_576.0)),
    }
}

pub(super) fn percent(share: f64) -> String {
    format!("{} %", three_digits(100.0 * share))
}

fn signed_percent(share: f64) -> String {
    let sign = match share {
        s if s > 0.0 => "+",
        s if s < 0.0 => "\u{2212}",
        _ => "",
    };
    format!("{sign}{}", percent(share.abs()))
}

/// Three significant digits, without an exponent between 1e-4 and 1e6.
fn three_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string().replace("inf", "\u{221e}");
    }
    let exponent = value.abs().log10().floor() as i32;
    match exponent {
        -4..=2 => format!("{value:.*}", (2 - exponent) as usize),
        3..=5 => format!("{value:.0}"),
        _ => format!("{value:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1234.5, "1234"),
            (99.96, "100.0"),
            (12.345, "12.3"),
            (0.001_234_5, "0.00123"),
            (1.5e-7, "1.50e-7"),
            (f64::INFINITY, "\u{221e}"),
        ] {
            assert_eq!(three_digits(value), text);
        }
        assert_eq!(signed_percent(-0.05), "\u{2212}5.00 %");
        assert_eq!(signed_percent(0.001), "+0.100 %");
        assert_eq!(bytes(1023), "1023 B");
        assert_eq!(bytes(3 << 20), "3.00 MiB");
    }

    #[test]
    fn the_best_of_a_column_is_marked_and_unknown_counts_are_not() {
        let mut report = fixture::report();
        report.rows[1].errors.bias = -1e-9;
        report.rows[0].steps = None;
        let bias = COLUMNS.iter().find(|c| c.title == "bias").unwrap();
        let steps = COLUMNS.iter().find(|c| c.title == "steps a ray").unwrap();
        for (row, best) in report.rows.iter().zip([false, true, false]) {
            let cell = cell(bias, row, &report);
            assert_eq!(cell.contains("best"), best, "{cell}");
        }
        assert!(!cell(steps, &report.rows[0], &report).contains("best"));
    }

    #[test]
    fn names_from_outside_are_escaped() {
        let mut report = fixture::report();
        report.rows[0].setting.technique = "<b>".to_owned();
        report.rows[0].timing.passes[0].0 = "a & b".to_owned();
        let table = table(&report).to_string();
        assert!(table.contains("&lt;b&gt;") && !table.contains("<b>"));
        assert!(table.contains("a &amp; b"));
    }
}
