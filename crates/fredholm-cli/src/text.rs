//! Tables as people read them.

use std::fmt::Write;

/// A line per matter: its name, and what there is to say.
pub fn lines(lines: &[(&str, String)]) -> String {
    let mut text = String::new();
    for (name, value) in lines {
        // Writing into a string does not fail.
        let _ = writeln!(text, "  {name:<14}{value}");
    }
    text
}

/// Rows of cells, in columns that are aligned at the right.
pub fn columns(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|row| row.get(c)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|c| width(c).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("   {cell:>width$}"));
        cells.collect::<String>().trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// A part of the whole as a percentage.
pub fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    match percent {
        0.0 => "0 %".to_owned(),
        small if small < 0.001 => format!("{small:.0e} %"),
        _ => format!("{} %", short((percent * 1000.0).round() / 1000.0)),
    }
}

/// A number at its shortest, without the last digits, which rounding makes.
pub fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.11e}").parse().unwrap_or(number);
    match rounded.abs() {
        0.0 => "0".to_owned(),
        1e-4..1e6 => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// How the numbers of a column are written: no more digits than are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// So many behind the point.
    Fixed(usize),
    /// So many behind the point, and an exponent.
    Exponent(usize),
}

/// What people read; all digits are for files.
const MOST_DIGITS: f64 = 10.0;

impl Digits {
    /// For numbers up to `largest` with this error.
    pub fn new(largest: f64, error: f64) -> Self {
        if !(largest > 0.0 && largest.is_finite()) {
            return Self::Fixed(0);
        }
        let magnitude = largest.log10().floor();
        let known = (magnitude - error.max(f64::MIN_POSITIVE).log10().floor()).clamp(2.0, MOST_DIGITS);
        if (-3.0..6.0).contains(&magnitude) {
            Self::Fixed((known - 1.0 - magnitude).max(0.0) as usize)
        } else {
            Self::Exponent(known as usize - 1)
        }
    }

    /// A number with these digits.
    pub fn write(self, number: f64) -> String {
        let text = match self {
            Self::Fixed(digits) => format!("{number:.digits$}"),
            Self::Exponent(digits) => format!("{number:.digits$e}"),
        };
        let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.' | 'e'));
        if is_zero { text.trim_start_matches('-').to_owned() } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_at_the_right() {
        let row = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>();
        let text = columns(&[row(&["x", "φ(x)"]), row(&["0.25", "1"]), row(&["1", ""])]);
        assert_eq!(text, "      x   φ(x)\n   0.25      1\n      1\n");
    }

    #[test]
    fn numbers_are_short() {
        for (number, text) in [(0.1 + 0.2, "0.3"), (0.0, "0"), (-2.5, "-2.5"), (1e-7, "1e-7"), (3e8, "3e8")] {
            assert_eq!(short(number), text);
        }
    }

    #[test]
    fn no_digit_is_shown_that_is_not_known() {
        for (largest, error, number, text) in [
            (1.0, 1e-15, 0.25, "0.250000000"),
            (1.0, 2e-4, 0.25, "0.250"),
            (123.0, 0.5, 99.7, "100"),
            (123.0, 1e9, 99.7, "100"),
            (1e-9, 1e-12, 2.5e-10, "2.50e-10"),
            (3e7, 1.0, -1e7, "-1.000000e7"),
            (1.0, 2e-3, -1e-9, "0.00"),
            (0.0, 0.0, 0.0, "0"),
        ] {
            assert_eq!(Digits::new(largest, error).write(number), text, "{largest} {error}");
        }
    }
}
