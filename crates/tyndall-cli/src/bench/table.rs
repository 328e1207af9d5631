//! Tables: as text for people, as JSON for programs.

use std::fmt;

use serde_json::{Map, Value, json};

use crate::measure::Spread;

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cell {
    /// Words.
    Text(String),
    /// A number, shown with three digits.
    Number(f64),
    /// Milliseconds, shown as the median and the quartiles.
    Time(Spread),
    /// A count.
    Count(u64),
    /// Not measured.
    Empty,
}

/// A table with a title and what must be known to read it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    pub(super) title: String,
    pub(super) notes: Vec<String>,
    pub(super) columns: Vec<&'static str>,
    pub(super) rows: Vec<Vec<Cell>>,
}

impl Cell {
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// Mebibytes.
    pub(super) fn mebibytes(bytes: Option<u64>) -> Self {
        bytes.map_or(Self::Empty, |bytes| {
            Self::Number(bytes as f64 / f64::from(1 << 20))
        })
    }

    fn to_json(&self) -> Value {
        match self {
            Self::Text(text) => json!(text),
            Self::Number(number) => json!(number),
            Self::Time(Spread {
                lower,
                median,
                upper,
            }) => {
                json!({ "lower_quartile": lower, "median": median, "upper_quartile": upper })
            }
            Self::Count(count) => json!(count),
            Self::Empty => Value::Null,
        }
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(cell: Option<T>) -> Self {
        cell.map_or(Self::Empty, Into::into)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<Spread> for Cell {
    fn from(time: Spread) -> Self {
        Self::Time(time)
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => f.write_str(text),
            Self::Number(number) => f.write_str(&three_digits(*number)),
            Self::Time(Spread {
                lower,
                median,
                upper,
            }) => {
                let [lower, median, upper] = [lower, median, upper].map(|x| three_digits(*x));
                write!(f, "{median} [{lower}, {upper}]")
            }
            Self::Count(count) => write!(f, "{count}"),
            Self::Empty => f.write_str("-"),
        }
    }
}

impl Table {
    /// As JSON: rows are objects by column.
    pub(super) fn to_json(&self) -> Value {
        let row = |row: &Vec<Cell>| {
            let cells = self.columns.iter().zip(row);
            let cells = cells.map(|(column, cell)| ((*column).to_owned(), cell.to_json()));
            Value::Object(cells.collect::<Map<_, _>>())
        };
        json!({
            "title": self.title,
            "notes": self.notes,
            "rows": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        let header = self.columns.iter().map(|column| (*column).to_owned());
        let mut lines = vec![header.collect::<Vec<_>>()];
        lines.extend(
            self.rows
                .iter()
                .map(|row| row.iter().map(Cell::to_string).collect()),
        );
        let width = |column: usize| {
            let cells = lines.iter().filter_map(|line| line.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        for line in &lines {
            let cells = line.iter().zip(&widths);
            let line: Vec<String> = cells
                .map(|(cell, width)| format!("{cell:<width$}"))
                .collect();
            writeln!(f, "  {}", line.join("  ").trim_end())?;
        }
        self.notes
            .iter()
            .try_for_each(|note| writeln!(f, "  * {note}"))
    }
}

/// A number with three significant digits; exponents only for what is very small or large.
fn three_digits(number: f64) -> String {
    let magnitude = number.abs();
    if number == 0.0 || !number.is_finite() {
        format!("{number}")
    } else if !(1e-3..1e6).contains(&magnitude) {
        format!("{number:.2e}")
    } else {
        let decimals = (2 - magnitude.log10().floor() as i32).max(0) as usize;
        format!("{number:.decimals$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (number, text) in [
            (0.0, "0"),
            (1.0, "1.00"),
            (-0.012345, "-0.0123"),
            (123.4, "123"),
            (12345.6, "12346"),
            (1.234e-5, "1.23e-5"),
            (1.234e7, "1.23e7"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(three_digits(number), text);
        }
    }

    #[test]
    fn columns_are_aligned_and_json_has_every_cell() {
        let spread = Spread {
            lower: 1.0,
            median: 2.0,
            upper: 3.0,
        };
        let table = Table {
            title: "T".to_owned(),
            notes: vec!["n".to_owned()],
            columns: vec!["a", "long", "c"],
            rows: vec![
                vec![Cell::text("wider"), Cell::Count(7), Cell::Empty],
                vec![Cell::text("x"), spread.into(), Cell::Number(0.5)],
            ],
        };
        let expected = "\
T
  a      long               c
  wider  7                  -
  x      2.00 [1.00, 3.00]  0.500
  * n
";
        assert_eq!(table.to_string(), expected);
        let json = table.to_json();
        assert_eq!(json["rows"][0]["long"], 7);
        assert_eq!(json["rows"][0]["c"], Value::Null);
        assert_eq!(json["rows"][1]["long"]["median"], 2.0);
    }
}
