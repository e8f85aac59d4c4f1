//! The picture of an answer: φ above, the residual below; in the plane, a map.

use super::report::Values;
use crate::plot::{Axis, Curve, Curves, Figure, Map, Panel, Scale};
use crate::problem::{FormulaValue, Number, contains, equally_spaced};
use fredholm::equation::{Answer, Equation, EquationError, Function, Interval};
use fredholm::plane;
use fredholm::product::Product;

/// Steps of a curve: finer than the pixels of the picture are for the eye.
const STEPS: usize = 600;

/// Points where the residual is computed, each an adaptive integral.
const RESIDUALS: usize = 150;

/// Panels of the integral of the residual, at least: φ must look like a polynomial of degree 15 on each, and they are as many as were
/// solved for.
const PANELS: usize = 32;
const DEGREES: usize = 16;

/// The shortest panel at an end is 2⁻²⁵ of the others: there x ln x is a polynomial to rounding of the integral.
const FINEST: i32 = 25;

/// The last break before infinity is 2⁷.
const FARTHEST: i32 = 7;

/// Squares of a map along its longer side.
const SQUARES: f64 = 160.0;

/// What is shown of an infinite interval, when nobody says.
const WINDOW: f64 = 10.0;

/// The part of the interval that is drawn: all of a finite one; of an infinite one what the points asked for span.
pub fn window(interval: Interval, asked: Option<&[f64]>) -> [f64; 2] {
    if interval.is_finite() {
        return [interval.a(), interval.b()];
    }
    if let Some(points) = asked {
        let least = points.iter().copied().fold(f64::INFINITY, f64::min);
        let most = points.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if least < most {
            return [least, most];
        }
    }
    match (interval.a(), interval.b()) {
        (a, _) if a.is_finite() => [a, a + WINDOW],
        (_, b) if b.is_finite() => [b - WINDOW, b],
        _ => [-WINDOW, WINDOW],
    }
}

/// The curves of a function, a line for each component and each part of it.
pub fn curves<T: FormulaValue>(name: &str, function: &Function<'_, f64, T>, [a, b]: [f64; 2]) -> Vec<Curve> {
    let x: Vec<f64> = equally_spaced(a, b, STEPS).collect();
    let values = Values::new(function, &x);
    let components = values.components();
    let mut curves = Vec::new();
    for (c, values) in components.iter().enumerate() {
        let component = if components.len() > 1 { format!(" {}", c + 1) } else { String::new() };
        let parts = values.first().map_or(1, |value| value.parts().len());
        for part in 0..parts {
            let prefix = ["Re ", "Im "][part];
            let name = format!("{}{name}{component}", if parts > 1 { prefix } else { "" });
            let points = x.iter().zip(values).map(|(x, value)| [*x, value.parts()[part]]);
            curves.push(Curve::line(name, points.collect()));
        }
    }
    curves
}

/// φ and the residual.
pub fn on_line<T: FormulaValue>(
    title: &str,
    equation: &Equation<'_, T>,
    answer: &Answer<'_, f64, T>,
    window: [f64; 2],
) -> Result<Figure, EquationError> {
    let solution = &answer.solution;
    let x = Axis { name: "x", scale: Scale::Linear };
    let above = Curves {
        x: x.clone(),
        y: Axis { name: "φ(x)", scale: Scale::Linear },
        curves: without_lone_name(curves("φ", solution, window)),
        height: 380.0,
    };
    let below = Curves {
        x,
        y: Axis { name: "|f + ∫ K φ − φ|", scale: Scale::Decades },
        curves: residuals(equation, answer, window)?,
        height: 260.0,
    };
    Ok(Figure { title: title.to_owned(), panels: vec![Panel::Curves(above), Panel::Curves(below)] })
}

/// A single line needs no legend.
fn without_lone_name(mut curves: Vec<Curve>) -> Vec<Curve> {
    if let [only] = curves.as_mut_slice() {
        only.name.clear();
    }
    curves
}

fn residuals<T: FormulaValue>(
    equation: &Equation<'_, T>,
    answer: &Answer<'_, f64, T>,
    [a, b]: [f64; 2],
) -> Result<Vec<Curve>, EquationError> {
    let product = Product::new(equation, None)?;
    let solution = &answer.solution;
    let breaks = breaks(equation.interval(), PANELS.max(answer.unknowns / DEGREES));
    let x: Vec<f64> = equally_spaced(a, b, RESIDUALS).collect();
    // Zero has no logarithm; where rounding makes it, the line would fall out of the picture.
    let least = f64::EPSILON / 16.0 * Values::new(solution, &x).largest();
    let residual = |c: usize, x: f64| -> Result<[f64; 2], EquationError> {
        let mut residual = equation.source(c, x) - solution.component(c, &x);
        for d in 0..equation.components() {
            residual += product.row((c, d), x, &breaks)?.apply(|y| solution.component(d, &y));
        }
        Ok([x, residual.modulus().max(least)])
    };
    let curve = |c: usize| {
        let points = x.iter().map(|x| residual(c, *x)).collect::<Result<_, _>>()?;
        let name = if equation.components() > 1 { format!("equation {}", c + 1) } else { String::new() };
        Ok(Curve::line(name, points))
    };
    (0..equation.components()).map(curve).collect()
}

/// Panels on which φ is taken for a polynomial of degree 15: equal ones, towards finite ends ever shorter and towards
/// infinity ever longer ones.
fn breaks(interval: Interval, count: usize) -> Vec<f64> {
    let (a, b) = (interval.a(), interval.b());
    let scale = if interval.is_finite() { (b - a) / count as f64 } else { 1.0 };
    let octaves = |from: i32, to: i32| (from..=to).map(move |k| scale * f64::from(k).exp2());
    let mut breaks = vec![a, b];
    match (a.is_finite(), b.is_finite()) {
        (true, true) => {
            breaks.extend(equally_spaced(a, b, count));
            breaks.extend(octaves(-FINEST, -1).flat_map(|t| [a + t, b - t]));
        }
        (true, false) => breaks.extend(octaves(-FINEST, FARTHEST).map(|t| a + t)),
        (false, true) => breaks.extend(octaves(-FINEST, FARTHEST).map(|t| b - t)),
        (false, false) => breaks.extend(octaves(-FARTHEST, FARTHEST).flat_map(|t| [-t, t])),
    }
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

/// φ as a map, or two of a complex φ.
pub fn in_plane<T: FormulaValue>(
    title: &str,
    domain: &plane::Domain,
    solution: &Function<'_, [f64; 2], T>,
) -> Figure {
    let (x, y) = bounds(domain);
    let square = (x[1] - x[0]).max(y[1] - y[0]) / SQUARES;
    let centres = |[least, most]: [f64; 2]| -> Vec<f64> {
        let count = ((most - least) / square).ceil();
        (0..count as usize).map(|k| least + (most - least) * (k as f64 + 0.5) / count).collect()
    };
    let across = centres(x);
    let value = |x: f64, y: f64| contains(domain, &[x, y]).then(|| solution.at(&[x, y]).number());
    let values: Vec<Vec<Option<Number>>> =
        centres(y).iter().map(|y| across.iter().map(|x| value(*x, *y)).collect()).collect();
    let parts = values.iter().flatten().flatten().next().map_or(1, |value| value.parts().len());
    let map = |part: usize| {
        let shown = |value: &Option<Number>| value.map_or(f64::NAN, |value| value.parts()[part]);
        let title = if parts > 1 { ["Re φ", "Im φ"][part] } else { "φ" };
        let values = values.iter().map(|row| row.iter().map(shown).collect()).collect();
        Panel::Map(Map { title: title.to_owned(), values, x, y })
    };
    Figure { title: title.to_owned(), panels: (0..parts).map(map).collect() }
}

/// The rectangle around a domain.
fn bounds(domain: &plane::Domain) -> ([f64; 2], [f64; 2]) {
    match *domain {
        plane::Domain::Rectangle { x0, x1, y0, y1 } => ([x0, x1], [y0, y1]),
        plane::Domain::Disk { centre: [x, y], radius: r } => ([x - r, x + r], [y - r, y + r]),
        plane::Domain::Triangle(corners) => {
            let axis = |k: usize| {
                let values = corners.map(|corner| corner[k]);
                [
                    values.iter().copied().fold(f64::INFINITY, f64::min),
                    values.into_iter().fold(f64::NEG_INFINITY, f64::max),
                ]
            };
            (axis(0), axis(1))
        }
    }
}
