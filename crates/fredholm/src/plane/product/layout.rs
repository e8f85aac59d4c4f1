//! κ_j(q_i) at the nodes of elements: as a matrix, or one entry at a time for blocks of low rank.

use super::element::{Elements, NODES};
use super::row::{RowBuilder, Rule, Target};
use crate::discretize::Coupling;
use crate::equation::{EquationError, Scalar};
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
}

impl Layout<'_, '_, f64> {
    /// I − A in blocks of low rank, for solutions to a tolerance.
    ///
    /// # Errors
    ///
    /// As [`Blocks::new`], and where the kernel is not finite.
    pub(super) fn blocks(&self, tolerance: f64) -> Result<Blocks, EquationError> {
        let entries = Entries::new(self)?;
        let not_finite = |entry: crate::operator::NotFinite| EquationError::PlaneKernelNotFinite {
            p: self.nodes[entry.row],
            q: self.nodes[entry.column],
            value: entry.value.to_string(),
        };
        let memory = memory::limit();
        Blocks::new(&entries, &self.nodes, (tolerance, memory), not_finite)
    }
}

/// The entries of A: K(q_i, q_j) w_j where the element of q_j is far from q_i, and where it is near what was found for it as a whole.
struct Entries<'l, 'e, 'a> {
    layout: &'l Layout<'e, 'a, f64>,
    /// By row: the near elements, ascending, each with its weights.
    near: Vec<Vec<(u32, Box<[f64]>)>>,
}

impl<'l, 'e, 'a> Entries<'l, 'e, 'a> {
    fn new(layout: &'l Layout<'e, 'a, f64>) -> Result<Self, EquationError> {
        let rule = Rule::new(layout.exponent);
        let elements = 0..layout.elements.all.len();
        let near_of = |i: usize| {
            let builder = layout.builder(&rule, i);
            elements.clone().filter(|k| builder.is_near(*k)).collect::<Vec<usize>>()
        };
        let near: Vec<Vec<usize>> = (0..layout.dim()).into_par_iter().map(near_of).collect();
        let (bytes, limit) = (near.iter().map(Vec::len).sum::<usize>() as u64 * BYTES, memory::limit() / 2);
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
                let mut weights = vec![0.0; NODES].into_boxed_slice();
                builder.element(k, &mut weights).map(|()| (k as u32, weights))
            };
            near.into_iter().map(weights).collect()
        };
        let found: Vec<_> = near.into_par_iter().enumerate().map(weights_of).collect();
        Ok(Self { layout, near: found.into_iter().collect::<Result<_, _>>()? })
    }
}

/// What a node keeps for an element that is near.
const BYTES: u64 = 8 * NODES as u64 + 32;

impl Coupling for Entries<'_, '_, '_> {
    fn dim(&self) -> usize {
        self.layout.dim()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let near = &self.near[i];
        match near.binary_search_by_key(&((j / NODES) as u32), |(element, _)| *element) {
            Ok(k) => near[k].1[j % NODES],
            Err(_) => {
                let mut entry = [0.0];
                self.layout.equation.kernel.row(self.layout.nodes[i], &self.layout.nodes[j..=j], &mut entry);
                entry[0] * self.layout.weights[j]
            }
        }
    }
}
