//! Where the solution is wanted: `0:0.1:1`, `0.07,0.31,pi/4`, in the plane `0.1,0.2; 0.3,0.4`.

use super::{Said, constant};
use anyhow::{Result, bail};
use fredholm::equation::Interval;
use fredholm::plane;
use serde::Serialize;

/// Points of an interval or of the plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Points {
    /// x.
    Line(Vec<f64>),
    /// (x, y).
    Plane(Vec<[f64; 2]>),
}

/// The most points: more than anybody reads, less than memory holds.
const MOST: f64 = 1e6;

/// Points of an axis without end, at the scale of 1.
const FAR: [f64; 11] = [0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0];

impl From<Vec<f64>> for Points {
    fn from(points: Vec<f64>) -> Self {
        Self::Line(points)
    }
}

impl From<Vec<[f64; 2]>> for Points {
    fn from(points: Vec<[f64; 2]>) -> Self {
        Self::Plane(points)
    }
}

/// Those that were asked for, or a few that show the solution.
pub fn line_points(at: Option<&Said>, interval: Interval, parameters: &[(String, f64)]) -> Result<Vec<f64>> {
    at.map_or_else(|| Ok(spread(interval)), |said| on_line(said, interval, parameters))
}

/// Those that were asked for, or a few that show the solution.
pub fn plane_points(
    at: Option<&Said>,
    domain: &plane::Domain,
    parameters: &[(String, f64)],
) -> Result<Vec<[f64; 2]>> {
    at.map_or_else(|| Ok(corners_and_middle(domain)), |said| in_plane(said, domain, parameters))
}

impl Points {
    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Self::Line(points) => points.len(),
            Self::Plane(points) => points.len(),
        }
    }

    /// The coordinates of a point: one or two.
    pub fn coordinates(&self, k: usize) -> &[f64] {
        match self {
            Self::Line(points) => std::slice::from_ref(&points[k]),
            Self::Plane(points) => &points[k],
        }
    }

    /// The names of the coordinates.
    pub fn names(&self) -> &'static [&'static str] {
        match self {
            Self::Line(_) => &["x"],
            Self::Plane(_) => &["x", "y"],
        }
    }
}

/// m + 1 points at equal distances, their ends exact.
pub fn equally_spaced(a: f64, b: f64, m: usize) -> impl Iterator<Item = f64> {
    let steps = m as f64;
    (0..=m).map(move |k| (a * (steps - k as f64) + b * k as f64) / steps)
}

fn spread(interval: Interval) -> Vec<f64> {
    let (a, b) = (interval.a(), interval.b());
    match (a.is_finite(), b.is_finite()) {
        (true, true) => equally_spaced(a, b, 10).collect(),
        (true, false) => FAR.iter().map(|t| a + t).collect(),
        (false, true) => FAR.iter().rev().map(|t| b - t).collect(),
        (false, false) => {
            let left = FAR[1..].iter().rev().map(|t| -t);
            left.chain(FAR).filter(|x| x.abs() <= 10.0 && x.abs() != 0.1).collect()
        }
    }
}

fn on_line(said: &Said, interval: Interval, parameters: &[(String, f64)]) -> Result<Vec<f64>> {
    let number = |text: &str| number(said, text, parameters);
    let mut points = Vec::new();
    for part in said.text.split(',') {
        match part.split(':').collect::<Vec<_>>().as_slice() {
            [x] => points.push(number(x)?),
            [from, step, to] => points.extend(range(said, number(from)?, number(step)?, number(to)?)?),
            _ => return Err(said.error(format!("`{part}` is neither a point nor from:step:to"))),
        }
    }
    match points.iter().find(|x| !(interval.a()..=interval.b()).contains(*x)) {
        Some(x) => {
            let (a, b) = (interval.a(), interval.b());
            Err(said.error(format!("the point {x} is outside of the interval from {a} to {b}")))
        }
        None => Ok(points),
    }
}

fn range(said: &Said, from: f64, step: f64, to: f64) -> Result<Vec<f64>> {
    let steps = (to - from) / step;
    if !(0.0..MOST).contains(&steps) {
        return Err(said.error(format!("{from}:{step}:{to} is no range of at most {MOST} points")));
    }
    // A last step that misses the end by rounding alone is meant to reach it.
    let whole = steps.round();
    Ok(match (steps - whole).abs() < 1e-9 * steps.max(1.0) {
        true if whole == 0.0 => vec![from],
        true => equally_spaced(from, to, whole as usize).map(tidy).collect(),
        false => (0..=steps as usize).map(|k| tidy(from + k as f64 * step)).collect(),
    })
}

/// 0.3 for 0.30000000000000004: the decimal that was meant, where one is that near.
fn tidy(x: f64) -> f64 {
    let decimal = format!("{x:.12e}").parse().unwrap_or(x);
    if (decimal - x).abs() <= 4.0 * f64::EPSILON * x.abs() { decimal } else { x }
}

fn in_plane(said: &Said, domain: &plane::Domain, parameters: &[(String, f64)]) -> Result<Vec<[f64; 2]>> {
    let point = |text: &str| -> Result<[f64; 2]> {
        let Some((x, y)) = text.split_once(',') else {
            bail!(said.error(format!("`{text}` is no point of the plane; write x,y; x,y; …")));
        };
        Ok([number(said, x, parameters)?, number(said, y, parameters)?])
    };
    let points = said.text.split(';').map(point).collect::<Result<Vec<_>>>()?;
    match points.iter().find(|p| !contains(domain, p)) {
        Some([x, y]) => Err(said.error(format!("the point {x},{y} is outside of the {domain}"))),
        None => Ok(points),
    }
}

fn number(said: &Said, text: &str, parameters: &[(String, f64)]) -> Result<f64> {
    let value = constant(&Said { text: text.trim().to_owned(), ..said.clone() }, parameters)?;
    if value.is_finite() { Ok(value) } else { Err(said.error(format!("`{}` is not finite", text.trim()))) }
}

/// Whether the domain has the point, its boundary included within rounding.
pub fn contains(domain: &plane::Domain, [x, y]: &[f64; 2]) -> bool {
    const ROUNDING: f64 = 1e-12;
    match domain {
        plane::Domain::Rectangle { x0, x1, y0, y1 } => (x0..=x1).contains(&x) && (y0..=y1).contains(&y),
        plane::Domain::Disk { centre, radius } => {
            (x - centre[0]).hypot(y - centre[1]) <= radius * (1.0 + ROUNDING)
        }
        plane::Domain::Triangle([a, b, c]) => {
            let twice = |p: &[f64; 2], q: &[f64; 2], r: &[f64; 2]| {
                (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
            };
            let (point, area) = ([*x, *y], twice(a, b, c));
            [(a, b), (b, c), (c, a)].iter().all(|(p, q)| twice(p, q, &point) / area >= -ROUNDING)
        }
    }
}

fn corners_and_middle(domain: &plane::Domain) -> Vec<[f64; 2]> {
    match *domain {
        plane::Domain::Rectangle { x0, x1, y0, y1 } => {
            let row = |y: f64| equally_spaced(x0, x1, 2).map(move |x| [x, y]);
            equally_spaced(y0, y1, 2).flat_map(row).collect()
        }
        plane::Domain::Triangle([a, b, c]) => {
            let mean = |points: &[[f64; 2]]| {
                [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64)
            };
            vec![a, b, c, mean(&[a, b]), mean(&[b, c]), mean(&[c, a]), mean(&[a, b, c])]
        }
        plane::Domain::Disk { centre: [x, y], radius } => {
            let ring = |r: f64| [[x + r, y], [x, y + r], [x - r, y], [x, y - r]];
            [[x, y]].into_iter().chain(ring(0.5 * radius)).chain(ring(radius)).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> Result<Vec<f64>> {
        line_points(Some(&Said::option("at", text)), Interval::new(0.0, 1.0)?, &[])
    }

    #[test]
    fn points_are_single_or_in_steps() -> Result<()> {
        assert_eq!(line("0:0.1:0.3")?, [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(line("0.07, 1/4,0:0.3:1")?, [0.07, 0.25, 0.0, 0.3, 0.6, 0.9]);
        assert_eq!(line("1:-0.5:0")?, [1.0, 0.5, 0.0]);
        assert_eq!(line("0.5:1:0.5")?, [0.5]);
        Ok(())
    }

    #[test]
    fn ranges_of_decimals_have_their_digits() -> Result<()> {
        assert_eq!(line("0:pi/8:1")?[1], std::f64::consts::FRAC_PI_8);
        assert_eq!(line("0:0.1:1")?, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
        Ok(())
    }

    #[test]
    fn what_is_no_point_is_told() {
        for (text, word) in [
            ("1.5", "outside"),
            ("0:0:1", "no range"),
            ("0:-0.1:1", "no range"),
            ("0:1e-9:1", "no range"),
            ("0:1", "neither"),
            ("", "empty"),
            ("nan", "unknown name"),
            ("i", "no real number"),
            ("inf", "not finite"),
            ("0,", "empty"),
        ] {
            let message = line(text).map_or_else(|error| error.to_string(), |points| format!("{points:?}"));
            assert!(message.starts_with("--at: ") && message.contains(word), "{text}: {message}");
        }
    }

    #[test]
    fn points_of_the_plane_are_pairs() -> Result<()> {
        let triangle = "triangle 0 0 0 1 1 0".parse()?;
        let points = |text| plane_points(Some(&Said::option("at", text)), &triangle, &[]);
        assert_eq!(points("0.1,0.2; 1/2,0.5")?, [[0.1, 0.2], [0.5, 0.5]]);
        assert!(points("0.1").is_err() && points("0.6,0.5").is_err());
        Ok(())
    }

    #[test]
    fn every_domain_has_points_of_its_own() -> Result<()> {
        for text in ["rectangle 1 2 3 5", "triangle 0 0 0.3 1 1 0.1", "disk 0.1 0.2 3"] {
            let domain: plane::Domain = text.parse()?;
            let points = plane_points(None, &domain, &[])?;
            assert!(points.len() > 6 && points.iter().all(|p| contains(&domain, p)), "{points:?}");
        }
        let inf = f64::INFINITY;
        for (a, b) in [(0.0, 1.0), (2.0, inf), (-inf, 3.0), (-inf, inf)] {
            let points = line_points(None, Interval::new(a, b)?, &[])?;
            assert!(points.is_sorted() && points.iter().all(|x| (a..=b).contains(x)), "{points:?}");
        }
        Ok(())
    }
}
