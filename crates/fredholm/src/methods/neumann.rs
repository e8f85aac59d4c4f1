//! φ_n = Σ_{k ≤ n} A^k f, ‖φ − φ_n‖ ≤ ‖A‖^{n+1}/(1 − ‖A‖) ‖f‖: the Neumann series (paper, §1.2.1, mended).
//!
//! It is that of (I − A)⁻¹, not of (I + A)⁻¹; (1.20) integrates over z in D; and (1.22) lacks the f of
//! f + ∫ m_n(x, y) f(y) dy, which is the partial sum up to A^{n+1}.

use super::degenerate::source_function;
use super::integrals::{images, or_nan, sampled, transform, transform_resolved};
use super::{Approximation, Integrals, Yardstick, operator_norm, radius, spectral_radius};
use crate::equation::{EquationError, Function, Scalar};
use crate::product::Product;
use crate::space::{Basis, Panels, Resolved, resolve};
use std::sync::Arc;

/// The Neumann series of a source f: its terms A^k f on panels that resolve them.
#[derive(Debug)]
pub struct Series<'e, T> {
    product: Arc<Product<'e, 'e, T>>,
    yardstick: Yardstick,
    norm: f64,
    spectral_radius: f64,
    source: Function<'e, f64, T>,
    resolved_source: Resolved<T>,
    panels: Panels,
    /// (A u_j)(x_i) on the panels.
    matrix: Vec<Vec<T>>,
    /// A f at the nodes of the panels.
    first: Vec<T>,
}

/// Panels added to resolve f, A f and A² f.
const MORE_PANELS: usize = 48;

impl<'e, T: Scalar> Series<'e, T> {
    /// Σ_k A^k f for the equation's own source.
    pub fn new(product: &Arc<Product<'e, 'e, T>>, yardstick: Yardstick) -> Result<Self, EquationError> {
        Self::of(product, yardstick, source_function(product.equation()))
    }

    /// Σ_k A^k f for another source f.
    pub fn of(
        product: &Arc<Product<'e, 'e, T>>,
        yardstick: Yardstick,
        source: Function<'e, f64, T>,
    ) -> Result<Self, EquationError> {
        let equation = product.equation();
        let ends = [equation.interval().a(), equation.interval().b()];
        let m = equation.components();
        let resolved_source = resolve(&source, &ends, MORE_PANELS);
        let image = |g: &Resolved<T>, breaks: &[f64]| {
            let value = |a: usize, x: &f64| or_nan(transform_resolved(product, (a, *x), g));
            resolve(&Function::new(m, value), breaks, MORE_PANELS)
        };
        let once = image(&resolved_source, &ends);
        let panels = image(&once, once.breaks()).panels;
        let points = (0..m).flat_map(|a| panels.nodes().iter().map(move |x| (a, *x)));
        let first = points.map(|at| Ok(transform_resolved(product, at, &resolved_source)?.value));
        let first = first.collect::<Result<_, EquationError>>()?;
        let matrix = images(product, &panels, panels.nodes(), Integrals::Accurate)?;
        let (norm, spectral_radius) = (operator_norm(product)?, spectral_radius(equation)?);
        Ok(Self {
            product: product.clone(),
            yardstick,
            norm,
            spectral_radius,
            source,
            resolved_source,
            panels,
            matrix,
            first,
        })
    }

    /// What the error of a partial sum is measured with.
    pub fn yardstick(&self) -> &Yardstick {
        &self.yardstick
    }

    /// ‖A‖∞.
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// max_k |λ_k| over the spectrum of A.
    pub fn spectral_radius(&self) -> f64 {
        self.spectral_radius
    }

    /// Whether it converges whatever its source: the spectral radius is below 1, as far as the digits tell.
    pub fn converges(&self) -> bool {
        self.spectral_radius < 1.0 - 2.0 * radius::TOLERANCE
    }

    /// The terms f, A f, A² f, … at the nodes of the panels, component by component.
    pub(super) fn terms(&self) -> impl Iterator<Item = Vec<T>> + '_ {
        let m = self.product.equation().components();
        let points = (0..m).flat_map(|a| self.panels.nodes().iter().map(move |x| (a, x)));
        let f = points.map(|(a, x)| self.source.component(a, x)).collect();
        let images = std::iter::successors(Some(self.first.clone()), |term| Some(self.apply(term)));
        std::iter::once(f).chain(images)
    }

    /// The sizes ‖A^k f‖∞ for k = 0, 1, …
    pub fn sizes(&self) -> impl Iterator<Item = f64> + '_ {
        self.terms().map(|term| largest(&term))
    }

    /// A on values at the nodes.
    fn apply(&self, values: &[T]) -> Vec<T> {
        let dot = |line: &Vec<T>| line.iter().zip(values).map(|(entry, value)| *entry * *value).sum();
        self.matrix.iter().map(dot).collect()
    }

    /// ‖A‖^{n+1}/(1 − ‖A‖) ‖f‖, a bound of ‖φ − φ_n‖∞; `None` where ‖A‖ ≥ 1.
    pub fn remainder(&self, n: usize) -> Option<f64> {
        let norm = self.norm;
        // n beyond i32 leaves nothing of a power below 1, and only such are taken.
        let power = norm.powi(i32::try_from(n + 1).unwrap_or(i32::MAX));
        (norm < 1.0).then(|| power / (1.0 - norm) * self.resolved_source.scale)
    }

    /// φ_n = f + A (f + A f + … + A^{n−1} f). `unknowns` is n.
    pub fn partial_sum(self, n: usize) -> Approximation<'e, T> {
        let equation = self.product.equation();
        let (product, m) = (self.product.clone(), equation.components());
        let mut sum = vec![T::ZERO; self.first.len()];
        let mut term = self.first.clone();
        for k in 1..n {
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += *term);
            if k + 1 < n {
                term = self.apply(&term);
            }
        }
        let later = self.panels;
        let (source, first) = (self.source, self.resolved_source);
        let value = move |a: usize, x: &f64| {
            let f = source.component(a, x);
            match n {
                0 => f,
                1 => f + or_nan(transform_resolved(&product, (a, *x), &first)),
                _ => {
                    let early = or_nan(transform_resolved(&product, (a, *x), &first));
                    f + early + or_nan(transform(&product, (a, *x), &later, &sum))
                }
            }
        };
        Approximation {
            solution: Function::new(m, value),
            breaks: vec![equation.interval().a(), equation.interval().b()],
            unknowns: n,
            condition: self.yardstick.condition(),
        }
    }
}

pub(super) fn largest<T: Scalar>(values: &[T]) -> f64 {
    values.iter().map(|value| value.modulus()).fold(0.0, f64::max)
}

/// k_0 = K, k_{n+1}(x, y) = ∫ K(x, z) k_n(z, y) dz: the kernel of A^{n+1} (paper, (1.19)–(1.20)).
#[derive(Clone, Copy, Debug)]
pub struct IteratedKernel<'p, 'e, T> {
    product: &'p Product<'e, 'e, T>,
    n: usize,
}

/// k_n of the equation's kernel.
pub fn iterated_kernel<'p, 'e, T: Scalar>(
    product: &'p Product<'e, 'e, T>,
    n: usize,
) -> IteratedKernel<'p, 'e, T> {
    IteratedKernel { product, n }
}

impl<T: Scalar> IteratedKernel<'_, '_, T> {
    /// k_n(x, y).
    pub fn at(&self, x: f64, y: f64) -> Result<T, EquationError> {
        self.component((0, 0), x, y)
    }

    /// The entry (a, b) of k_n(x, y) for a system.
    pub fn component(&self, (a, b): (usize, usize), x: f64, y: f64) -> Result<T, EquationError> {
        self.column(b, x, y).map(|column| column[self.n][a])
    }

    /// m_n(x, y) = Σ_{k ≤ n} k_k(x, y), (1.21): φ_{n+1} = f + ∫ m_n f.
    pub fn sum(&self, x: f64, y: f64) -> Result<T, EquationError> {
        Ok(self.column(0, x, y)?.iter().map(|k| k[0]).sum())
    }

    /// k_0(x, y) … k_n(x, y), of each the components a of column b.
    fn column(&self, b: usize, x: f64, y: f64) -> Result<Vec<Vec<T>>, EquationError> {
        let (product, equation) = (self.product, self.product.equation());
        let (m, interval) = (equation.components(), equation.interval());
        let direct = |c: usize, z: f64| sampled(equation, (c, b), z, &[y]).map(|k| k[0]);
        let mut kernels = vec![(0..m).map(|c| direct(c, x)).collect::<Result<Vec<_>, _>>()?];
        // K(·, y) may bend or jump at y.
        let mut breaks = vec![interval.a(), y, interval.b()];
        breaks.dedup();
        let start = Function::new(m, |c, z: &f64| direct(c, *z).unwrap_or(T::from(f64::NAN)));
        let mut before = resolve(&start, &breaks, MORE_PANELS);
        for k in 1..=self.n {
            let values = (0..m).map(|a| Ok(transform_resolved(product, (a, x), &before)?.value));
            kernels.push(values.collect::<Result<Vec<_>, EquationError>>()?);
            if k < self.n {
                let last = before.clone();
                let next = |a: usize, z: &f64| or_nan(transform_resolved(product, (a, *z), &last));
                before = resolve(&Function::new(m, next), &breaks, MORE_PANELS);
            }
        }
        Ok(kernels)
    }
}
