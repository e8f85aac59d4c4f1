//! A φ = λ φ: eigenvalues and eigenfunctions of the integral operator, with their errors (paper, §1.1.4).
//!
//! On panels, as [`crate::automatic`] solves an equation. The residual of an eigenpair, measured between the nodes and
//! seen by the left eigenvector y, is to first order the error of the eigenvalue: δλ = y (A φ − λ φ) / y φ.

use crate::automatic::discrete::Discrete;
use crate::automatic::found::{self, PanelFunction};
use crate::automatic::panels::{Panels, coarsened, refined};
use crate::equation::{Class, Complex64, Equation, EquationError, Function, Scalar};
use crate::product::{COARSE, Change, FINE, Product};
use crate::second_kind::eigen;
use faer::Mat;
use faer::linalg::solvers::Solve;
use std::sync::Arc;

/// The eigenvalues that were asked for, as far as there are so many.
#[derive(Debug)]
pub struct Spectrum<'e> {
    /// By modulus, descending; fewer than asked for where the others cannot be told from 0.
    pub eigenpairs: Vec<Eigenpair<'e>>,
    /// How many numbers were solved for.
    pub unknowns: usize,
}

/// An eigenvalue with its eigenfunction.
#[derive(Debug)]
pub struct Eigenpair<'e> {
    /// λ.
    pub value: Complex64,
    /// An estimate of the error of λ.
    pub error_estimate: f64,
    /// φ, with max |φ| = 1 at the nodes.
    pub function: Function<'e, f64, Complex64>,
}

/// Unknowns at most: finding all eigenvalues takes some 25 n³ operations.
const UNKNOWNS: usize = 1024;

/// What an error estimate may be too small by: it is the first term of a series, with the left eigenvector of the coarse
/// equation for that of the true one. 2.6 was seen; 10 would tell users of the simplest kernels less than is known.
const SAFETY: f64 = 5.0;

/// The `count` eigenvalues of largest modulus, each to within `tolerance` times the largest of them, if that can be had.
///
/// # Errors
///
/// A kernel that is infinite or NaN where it is sampled, or that cannot be integrated.
pub fn spectrum<'e, 'a: 'e, T: Scalar>(
    equation: &'e Equation<'a, T>,
    count: usize,
    tolerance: f64,
) -> Result<Spectrum<'e>, EquationError> {
    let plain = Product::new(equation, None)?;
    if count == 0 {
        return Ok(Spectrum { eigenpairs: Vec::new(), unknowns: 0 });
    }
    // Eigenfunctions of a singular kernel are singular at the ends.
    let product = match plain.worst_class() {
        Class::Logarithmic | Class::Algebraic { .. } => plain.changed(Change::graded(equation.interval())),
        _ => plain,
    };
    // Twice as many polynomials as functions, the last of which have the most waves.
    let enough = 2 * count.max(1).div_ceil(COARSE.len());
    let mut panels = Panels::equal(product.change().range(), enough);
    let mut best = Pairs::new(&product, panels.clone(), count)?;
    loop {
        let worst = best.contributions.iter().copied().fold(0.0, f64::max);
        let finer = panels.cut(|panel| if best.contributions[panel] >= 0.05 * worst { 2 } else { 1 });
        let unknowns = finer.len() * COARSE.len() * equation.components();
        if best.error() <= tolerance * best.largest() || unknowns > UNKNOWNS {
            return Ok(best.spectrum(product));
        }
        let next = Pairs::new(&product, finer.clone(), count)?;
        if next.error() >= best.error() && best.error() < 1e-10 * best.largest() {
            return Ok(best.spectrum(product));
        }
        (best, panels) = (next, finer);
    }
}

/// Eigenpairs on given panels.
struct Pairs {
    panels: Panels,
    /// (λ, its estimated error, φ at the nodes).
    pairs: Vec<(Complex64, f64, Vec<Complex64>)>,
    /// What each panel's residuals amount to.
    contributions: Vec<f64>,
    unknowns: usize,
}

impl Pairs {
    fn new<T: Scalar>(
        product: &Product<'_, '_, T>,
        panels: Panels,
        count: usize,
    ) -> Result<Self, EquationError> {
        let coarse = Discrete::assemble(product, &panels, &COARSE)?;
        let fine = Discrete::assemble(product, &panels, &FINE)?;
        let failed = || EquationError::Method("the eigenvalue iteration did not converge".to_owned());
        let all = sorted_eigen(coarse.n, &coarse.a).ok_or_else(failed)?;
        let largest = all.first().map_or(0.0, |(value, _)| value.norm());
        let wanted = all.iter().take(count).take_while(|(value, _)| value.norm() > 1e-14 * largest).count();
        let left = left_eigenvectors(&coarse, &all, wanted).ok_or_else(failed)?;
        let norms = fine.panel_norms(panels.len(), &FINE);
        let norm: f64 = norms.iter().sum();
        let mut contributions = vec![0.0; panels.len()];
        let mut pairs = Vec::new();
        for (k, (value, vector)) in all.into_iter().take(wanted).enumerate() {
            let size = modulus(&vector);
            let phi: Vec<Complex64> = refined(&vector);
            let iterated: Vec<Complex64> =
                complex_apply(&fine, &phi).into_iter().map(|v| v / value).collect();
            for (j, (old, new)) in phi.chunks(FINE.len()).zip(iterated.chunks(FINE.len())).enumerate() {
                let residual: Vec<Complex64> = old.iter().zip(new).map(|(old, new)| new - old).collect();
                let panel = j % panels.len();
                let share = modulus(&residual) / size * norms[panel];
                contributions[panel] = f64::max(contributions[panel], share);
            }
            let again = complex_apply(&fine, &iterated);
            let change: Vec<Complex64> =
                again.iter().zip(&iterated).map(|(new, old)| new - value * old).collect();
            let change = coarsened(&change);
            let seen: Complex64 = (0..coarse.n).map(|i| left[(k, i)] * change[i]).sum();
            let condition = (0..coarse.n).map(|i| left[(k, i)].norm()).sum::<f64>() * size;
            let rounding = 8.0 * f64::EPSILON * norm * condition;
            // What rounding alone could have made of 0 is no eigenvalue: those of a nilpotent A are √ε.
            if rounding < value.norm() {
                let error = SAFETY * seen.norm() + rounding;
                pairs.push((value, error, vector.iter().map(|v| v / size).collect()));
            }
        }
        Ok(Self { panels, pairs, contributions, unknowns: coarse.n })
    }

    fn error(&self) -> f64 {
        self.pairs
            .iter()
            .map(|(_, error, _)| *error)
            .fold(0.0, |m: f64, x| if x > m || x.is_nan() { x } else { m })
    }

    fn largest(&self) -> f64 {
        self.pairs.first().map_or(0.0, |(value, ..)| value.norm())
    }

    fn spectrum<'e, 'a: 'e, T: Scalar>(self, product: Product<'e, 'a, T>) -> Spectrum<'e> {
        let (panels, product) = (Arc::new(self.panels), Arc::new(product));
        let eigenpair = |(value, error_estimate, phi)| {
            let phi = PanelFunction::new(&product, &panels, phi);
            Eigenpair { value, error_estimate, function: found::eigenfunction(product.clone(), phi, value) }
        };
        Spectrum { eigenpairs: self.pairs.into_iter().map(eigenpair).collect(), unknowns: self.unknowns }
    }
}

/// Eigenvalues, by modulus, with their vectors.
fn sorted_eigen<T: Scalar>(n: usize, a: &[T]) -> Option<Vec<(Complex64, Vec<Complex64>)>> {
    let mut all = eigen(n, a)?;
    all.sort_by(|one, other| other.0.norm().total_cmp(&one.0.norm()).then(other.0.im.total_cmp(&one.0.im)));
    Some(all)
}

/// Row by row, the left eigenvectors y_k with y_k v_l = δ_kl for the eigenvectors v_l of the eigenvalues that are wanted.
///
/// Not from the inverse of all v_l: of an operator of low rank most belong to 0, and need not be independent.
fn left_eigenvectors<T: Scalar>(
    a: &Discrete<T>,
    right: &[(Complex64, Vec<Complex64>)],
    wanted: usize,
) -> Option<Mat<Complex64>> {
    let n = a.n;
    // Eigenvalues of one modulus belong together.
    let same = |k: usize| right[k].0.norm() >= (1.0 - 1e-6) * right[k - 1].0.norm();
    let kept = (wanted..n).take_while(|k| *k > 0 && same(*k)).last().map_or(wanted, |k| k + 1);
    let transposed: Vec<T> = (0..n * n).map(|k| a.a[(k % n) * n + k / n]).collect();
    let left = sorted_eigen(n, &transposed)?;
    let products = Mat::from_fn(kept, kept, |k, l| {
        left[k].1.iter().zip(&right[l].1).map(|(y, v)| y * v).sum::<Complex64>()
    });
    Some(products.partial_piv_lu().solve(Mat::from_fn(kept, n, |k, i| left[k].1[i])))
}

fn modulus(values: &[Complex64]) -> f64 {
    values.iter().map(|v| v.norm()).fold(0.0, f64::max)
}

/// A u for a complex u.
fn complex_apply<T: Scalar>(a: &Discrete<T>, u: &[Complex64]) -> Vec<Complex64> {
    a.a.chunks(a.n).map(|row| row.iter().zip(u).map(|(a, u)| a.complex() * u).sum()).collect()
}
