//! Numbers in rows, for programs and for people.

use serde::Serialize;
use std::fmt::Write;

/// A table: columns with their units, rows of cells.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Table {
    /// Heads of the columns.
    pub columns: Vec<String>,
    /// As many cells in each as there are columns.
    pub rows: Vec<Vec<Cell>>,
}

/// A cell.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number.
    Number(f64),
    /// A count.
    Count(u64),
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl core::fmt::Display for Cell {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Text(text) => f.write_str(text),
            Self::Count(count) => write!(f, "{count}"),
            Self::Number(number) => f.write_str(&short(*number)),
        }
    }
}

/// A number with three digits that count.
#[must_use]
pub fn short(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 {
        "0".into()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{number:.2e}")
    } else if size >= 100.0 {
        format!("{number:.0}")
    } else {
        let digits = if size >= 10.0 {
            1
        } else if size >= 1.0 {
            2
        } else if size >= 0.1 {
            3
        } else if size >= 0.01 {
            4
        } else {
            5
        };
        format!("{number:.digits$}")
    }
}

impl Table {
    /// A table without rows.
    #[must_use]
    pub fn new(columns: &[&str]) -> Self {
        Self { columns: columns.iter().map(|&column| column.into()).collect(), rows: vec![] }
    }

    /// The table as comma-separated values (RFC 4180), numbers in full.
    #[must_use]
    pub fn csv(&self) -> String {
        let quoted = |text: &str| {
            if text.contains([',', '"', '\n', '\r']) {
                format!("\"{}\"", text.replace('"', "\"\""))
            } else {
                text.into()
            }
        };
        let cell = |cell: &Cell| match cell {
            Cell::Text(text) => quoted(text),
            Cell::Number(number) => format!("{number:?}"),
            Cell::Count(count) => count.to_string(),
        };
        let mut csv = String::new();
        let head: Vec<_> = self.columns.iter().map(|column| quoted(column)).collect();
        let rows = self.rows.iter().map(|row| row.iter().map(cell).collect::<Vec<_>>());
        for line in core::iter::once(head).chain(rows) {
            // Into a string, which takes everything.
            let _ = write!(csv, "{}\r\n", line.join(","));
        }
        csv
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let mut table = Table::new(&["a", "b, c"]);
        table.rows.push(vec!["say \"so\"".into(), 0.1.into()]);
        table.rows.push(vec!["x".into(), 7u64.into()]);
        assert_eq!(table.csv(), "a,\"b, c\"\r\n\"say \"\"so\"\"\",0.1\r\nx,7\r\n");
    }

    #[test]
    fn numbers_are_short() {
        let numbers = [0.0, 1234.5, 12.345, 1.2345, 0.12345, 0.012345, 0.0012345, 1.5e-7, 2e9];
        assert_eq!(
            numbers.map(short),
            ["0", "1234", "12.3", "1.23", "0.123", "0.0123", "0.00123", "1.50e-7", "2.00e9"].map(String::from)
        );
    }
}
