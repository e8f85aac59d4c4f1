//! κ_j(q_i) at the nodes of elements: as a matrix, or one entry at a time for blocks of low rank.

use super::element::{Elements, NODES};
use super::row::{RowBuilder, Rule, Target};
use crate::discretize::Coupling;
use crate::equation::{EquationError, Scalar, between_parts};
use crate::memory;
use crate::plane::PlaneEquation;
use crate::product::{COARSE, POINTS};
use crate::second_kind::Blocks;
use rayon::prelude::*;
use std::sync::Arc;

type Point = [f64; 2];

/// An equation's unknowns.
pub(in crate::plane) struct Layout<'e, 'a, T> {
    pub(super) equation: &'e PlaneEquation<'a, T>,
    pub(super) elements: Arc<Elements>,
    /// K is as |p − q|^exponent, or as ln |p − q| where that is 0.
    pub(super) exponent: f64,
    pub(super) nodes: Vec<Point>,
    /// w_j of ∫ g ≈ Σ_j w_j g(q_j).
    pub(super) weights: Vec<f64>,
}

impl<'e, 'a, T: Scalar> Layout<'e, 'a, T> {
    pub(super) fn new(equation: &'e PlaneEquation<'a, T>, elements: Arc<Elements>, exponent: f64) -> Self {
        let (nodes, weights) = (elements.nodes(), elements.weights());
        Self { equation, elements, exponent, nodes, weights }
    }

    /// The same for another equation on the domain, with a kernel of the same class.
    pub(super) fn of<'f, 'b>(&self, equation: &'f PlaneEquation<'b, T>) -> Layout<'f, 'b, T> {
        Layout::new(equation, self.elements.clone(), self.exponent)
    }

    /// The number of unknowns.
    pub(super) fn dim(&self) -> usize {
        self.nodes.len()
    }

    /// f(q_i).
    pub(super) fn sources(&self) -> Result<Vec<T>, EquationError> {
        self.nodes.iter().map(|p| self.equation.finite_source(*p)).collect()
    }

    fn builder<'k>(&'k self, rule: &'k Rule, i: usize) -> RowBuilder<'k, 'a, T> {
        let element = &self.elements.all[i / NODES];
        let uv = element.cell.at([i % NODES / POINTS, i % POINTS].map(|k| COARSE.nodes[k]));
        let target = Target { p: self.nodes[i], place: Some((element.chart, uv)) };
        RowBuilder::new(self.equation, &self.elements, rule, target)
    }

    /// A, row by row.
    pub(super) fn matrix(&self) -> Result<Vec<T>, EquationError> {
        let (n, rule) = (self.dim(), Rule::new(self.exponent));
        let mut a = vec![T::ZERO; n * n];
        let fill = |(i, row): (usize, &mut [T])| self.builder(&rule, i).row(row);
        let filled: Vec<_> = a.par_chunks_mut(n).enumerate().map(fill).collect();
        // One after another, so that the first error is named however many threads there are.
        filled.into_iter().collect::<Result<(), EquationError>>()?;
        Ok(a)
    }

    /// I − A in blocks of low rank, for solutions to a tolerance: of complex numbers both parts are unknowns, one after the other.
    ///
    /// # Errors
    ///
    /// As [`Blocks::new`], and where the kernel is not finite.
    pub(super) fn blocks(&self, tolerance: f64) -> Result<Blocks, EquationError> {
        let entries = Entries::new(self)?;
        let not_finite = |entry: crate::operator::NotFinite| {
            let [p, q] = [entry.row, entry.column].map(|unknown| self.nodes[unknown / T::PARTS]);
            let mut value = [T::ZERO];
            self.equation.kernel.row(p, &[q], &mut value);
            EquationError::PlaneKernelNotFinite { p, q, value: format!("{:?}", value[0]) }
        };
        let points: Vec<Point> = self.nodes.iter().flat_map(|p| std::iter::repeat_n(*p, T::PARTS)).collect();
        Blocks::new(&entries, &points, (tolerance, memory::limit()), not_finite)
    }
}

/// The entries of A: K(q_i, q_j) w_j where the element of q_j is far from q_i, and where it is near what was found for it as a whole.
struct Entries<'l, 'e, 'a, T> {
    layout: &'l Layout<'e, 'a, T>,
    /// By row: the near elements, ascending, each with its weights.
    near: Vec<Vec<(u32, Box<[T]>)>>,
}

impl<'l, 'e, 'a, T: Scalar> Entries<'l, 'e, 'a, T> {
    fn new(layout: &'l Layout<'e, 'a, T>) -> Result<Self, EquationError> {
        let rule = Rule::new(layout.exponent);
        let elements = 0..layout.elements.all.len();
        let near_of = |i: usize| {
            let builder = layout.builder(&rule, i);
            elements.clone().filter(|k| builder.is_near(*k)).collect::<Vec<usize>>()
        };
        let near: Vec<Vec<usize>> = (0..layout.dim()).into_par_iter().map(near_of).collect();
        let count: usize = near.iter().map(Vec::len).sum();
        let (bytes, limit) = ((count * (NODES * size_of::<T>() + LISTED)) as u64, memory::limit() / 2);
        if bytes > limit {
            return Err(EquationError::Method(format!(
                "{} unknowns take {} MB for what is near, and {} MB may be taken: allow fewer, or take a larger tolerance",
                layout.dim(),
                bytes >> 20,
                limit >> 20
            )));
        }
        let weights_of = |(i, near): (usize, Vec<usize>)| -> Result<Vec<_>, EquationError> {
            let mut builder = layout.builder(&rule, i);
            let weights = |k: usize| {
                let mut weights = vec![T::ZERO; NODES].into_boxed_slice();
                builder.element(k, &mut weights).map(|()| (k as u32, weights))
            };
            near.into_iter().map(weights).collect()
        };
        let found: Vec<_> = near.into_par_iter().enumerate().map(weights_of).collect();
        Ok(Self { layout, near: found.into_iter().collect::<Result<_, _>>()? })
    }
}

/// Bytes that a node keeps for an element that is near, besides its weights.
const LISTED: usize = 32;

impl<T: Scalar> Coupling for Entries<'_, '_, '_, T> {
    fn dim(&self) -> usize {
        self.layout.dim() * T::PARTS
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let (p, q) = (i % T::PARTS, j % T::PARTS);
        let (i, j) = (i / T::PARTS, j / T::PARTS);
        let near = &self.near[i];
        let weight = match near.binary_search_by_key(&((j / NODES) as u32), |(element, _)| *element) {
            Ok(k) => near[k].1[j % NODES],
            Err(_) => {
                let Layout { equation, nodes, weights, .. } = self.layout;
                let mut entry = [T::ZERO];
                equation.kernel.row(nodes[i], &nodes[j..=j], &mut entry);
                entry[0] * weights[j]
            }
        };
        between_parts(weight, p, q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::{Complex64, all_parts, of_all_parts};
    use crate::plane::Domain;
    use crate::second_kind::SecondKind;

    #[test]
    fn blocks_of_complex_numbers_solve_what_their_matrix_does() {
        let z = Complex64::new(0.1, -0.3);
        let kernel =
            |p: Point, q: Point| z * (p[0] - q[0]).hypot(p[1] - q[1]).ln() + Complex64::new(p[0], q[1]);
        let source = |[x, y]: Point| Complex64::new(x + y, x * y);
        let equation = PlaneEquation::new(Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap(), kernel, source);
        let layout = Layout::new(&equation, Arc::new(Elements::new(equation.domain, 0.0)), 0.0);
        let source = layout.sources().unwrap();
        let expected = SecondKind::new(layout.dim(), &layout.matrix().unwrap()).solve(&source);
        let found: Vec<Complex64> = of_all_parts(&layout.blocks(1e-8).unwrap().solve(&all_parts(&source)));
        let off = found.iter().zip(&expected).map(|(one, other)| (one - other).norm()).fold(0.0, f64::max);
        assert!(found.len() == layout.dim() && off < 1e-8, "{off:e} of {} unknowns", found.len());
    }
}
