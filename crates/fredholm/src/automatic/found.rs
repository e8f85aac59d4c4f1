//! φ(x) = f(x) + Σ_q κ_q(x) φ_n(y_q): the solution as a function, by Nyström's interpolant (paper, (1.29)).

use super::panels::Panels;
use crate::equation::{Complex64, Equation, EquationError, Function, Interval, Scalar};
use crate::product::{COARSE, Change, POINTS, Product};
use std::sync::Arc;

/// The piecewise polynomials with these values at the panels' nodes, component after component.
#[derive(Debug)]
pub(crate) struct PanelFunction<T> {
    interval: Interval,
    change: Change,
    panels: Arc<Panels>,
    values: Vec<T>,
}

impl<T: Scalar> PanelFunction<T> {
    pub(crate) fn new<S: Scalar>(product: &Product<'_, '_, S>, panels: &Arc<Panels>, values: Vec<T>) -> Self {
        let interval = product.equation().interval();
        Self { interval, change: product.change(), panels: panels.clone(), values }
    }

    fn components(&self) -> usize {
        self.values.len() / (self.panels.len() * COARSE.len())
    }

    fn panel(&self, c: usize, panel: usize) -> &[T] {
        let p = COARSE.len();
        &self.values[(c * self.panels.len() + panel) * p..][..p]
    }

    /// Component c at x; NaN outside the interval.
    fn at(&self, c: usize, x: f64) -> T {
        if !(self.interval.a() <= x && x <= self.interval.b()) {
            return T::from(f64::NAN);
        }
        let t = self.change.parameter(x);
        let (panel, xi) = self.panels.locate(t);
        self.on_panel(c, panel, xi)
    }

    /// Component c on a panel, from −1 to 1.
    pub(crate) fn on_panel(&self, c: usize, panel: usize, xi: f64) -> T {
        COARSE.interpolate(self.panel(c, panel), xi)
    }

    /// Σ_b Σ_q κ_q(x) φ_b(y_q) at x(t), with the κ_q made numbers of φ's kind, and what the rules leave out of ∫ K g with |g| ≤ 1.
    pub(crate) fn transported<S: Scalar>(
        &self,
        product: &Product<'_, '_, S>,
        c: usize,
        t: f64,
        lift: impl Fn(S) -> T,
    ) -> Result<(T, f64), EquationError> {
        let (mut sum, mut error) = (T::ZERO, 0.0);
        let mut weights = [S::ZERO; POINTS];
        for b in 0..self.components() {
            let mut builder = product.builder((c, b), t);
            for panel in 0..self.panels.len() {
                weights.fill(S::ZERO);
                error += builder.panel(self.panels.ends(panel), &COARSE, &mut weights)?.error;
                sum += weights.iter().zip(self.panel(b, panel)).map(|(w, v)| lift(*w) * *v).sum::<T>();
            }
        }
        Ok((sum, error))
    }

    /// f + this, as a function.
    pub(crate) fn after_source<'e>(self, equation: &'e Equation<'_, T>) -> Function<'e, f64, T> {
        Function::new(self.components(), move |c, x| {
            let image = self.at(c, *x);
            // Outside the interval f may be anything.
            if is_nan(image) { image } else { source_or_limit(equation, c, *x) + image }
        })
    }

    /// As a function.
    pub(crate) fn function<'e>(self) -> Function<'e, f64, T> {
        Function::new(self.components(), move |c, x| self.at(c, *x))
    }
}

/// Nyström's interpolant of φ_n. Outside the interval it is NaN.
pub(crate) fn interpolant<'e, 'a: 'e, T: Scalar>(
    product: Arc<Product<'e, 'a, T>>,
    phi: PanelFunction<T>,
) -> Function<'e, f64, T> {
    let components = phi.components();
    let at = move |c: usize, x: &f64| {
        let interval = phi.interval;
        if !(interval.a() <= *x && *x <= interval.b()) {
            return T::from(f64::NAN);
        }
        if x.is_infinite() {
            return phi.at(c, *x);
        }
        source_or_limit(product.equation(), c, *x) + sum_or_limit(&product, &phi, c, *x)
    };
    Function::new(components, at)
}

/// f_c(x); where that is 0/0 or 0 · ln 0, the f_c of the double next to x, inwards.
fn source_or_limit<T: Scalar>(equation: &Equation<'_, T>, c: usize, x: f64) -> T {
    let value = equation.source(c, x);
    if is_nan(value) { equation.source(c, inwards(equation.interval(), x)) } else { value }
}

fn is_nan<T: Scalar>(value: T) -> bool {
    let (re, im) = value.parts();
    re.is_nan() || im.is_nan()
}

/// The double next to x, away from the end of the interval.
fn inwards(interval: Interval, x: f64) -> f64 {
    if x < interval.b() { x.next_up() } else { x.next_down() }
}

/// Σ_b Σ_q κ_q(x) φ_b(y_q); where K(x, y) is 0/0, that of the double next to x; NaN where K is infinite.
fn sum_or_limit<T: Scalar>(product: &Product<'_, '_, T>, phi: &PanelFunction<T>, c: usize, x: f64) -> T {
    let sum = |x: f64| Ok(phi.transported(product, c, product.change().parameter(x), |weight| weight)?.0);
    let has_limit = |y: f64| {
        (0..phi.components()).any(|b| {
            let mut entry = [T::ZERO];
            product.equation().kernel(c, b).row(x, &[y], &[y - x], &mut entry);
            is_nan(entry[0])
        })
    };
    let found = match sum(x) {
        Err(EquationError::KernelNotFinite { y, .. }) if has_limit(y) => sum(inwards(phi.interval, x)),
        found => found,
    };
    found.unwrap_or(T::from(f64::NAN))
}

/// (1/λ) A φ_n, which satisfies A φ = λ φ between the nodes better than φ_n does.
pub(crate) fn eigenfunction<'e, 'a: 'e, T: Scalar>(
    product: Arc<Product<'e, 'a, T>>,
    phi: PanelFunction<Complex64>,
    value: Complex64,
) -> Function<'e, f64, Complex64> {
    let components = phi.components();
    Function::new(components, move |c, x: &f64| {
        let polynomial = phi.at(c, *x);
        if x.is_infinite() || polynomial.re.is_nan() {
            return polynomial;
        }
        let sum = phi.transported(&product, c, product.change().parameter(*x), T::complex);
        sum.map_or(polynomial, |(sum, _)| sum / value)
    })
}
