//! F_ij = κ_j(x_i), the product rule where x_i is near the panel of x_j, and K(x_i, x_j) w_j elsewhere (paper, §1.2.3, remark).

use super::Coupling;
use crate::equation::{Class, Equation, EquationError};
use crate::product::{COARSE, POINTS, Product};
use std::ops::Range;

/// Nyström's method on panels of degree 15 for a kernel that may be singular on its diagonal, one entry at a time: for as
/// many unknowns as a hierarchical operator can keep.
///
/// A panel is near as far as it is long. Further away a kernel that is analytic but on the diagonal is integrated by the
/// panel's own 16 nodes to 10⁻²⁰ of its size (5.8⁻³², by Bernstein's ellipse through the nearest singularity); one that is
/// wild elsewhere needs panels as short as that asks for.
#[derive(Debug)]
pub struct ProductNystrom<'e, 'a> {
    product: Product<'e, 'a, f64>,
    breaks: Vec<f64>,
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl<'e, 'a> ProductNystrom<'e, 'a> {
    /// The operator of one real equation on a finite interval, with a panel from each of `breaks` to the next: they ascend
    /// from one end of the interval to the other. The kernel is of a stated class, or of the one that is seen.
    ///
    /// # Errors
    ///
    /// [`EquationError::Method`] for a system, an infinite interval or breaks that are not of it.
    pub fn new(
        equation: &'e Equation<'a, f64>,
        breaks: Vec<f64>,
        class: Option<Class>,
    ) -> Result<Self, EquationError> {
        let interval = equation.interval();
        let ends = (breaks.first(), breaks.last());
        if equation.components() != 1 || !interval.is_finite() {
            return Err(EquationError::Method(
                "the product rule on panels takes one equation on a finite interval".to_owned(),
            ));
        }
        if ends != (Some(&interval.a()), Some(&interval.b())) || !breaks.is_sorted_by(|low, high| low < high)
        {
            return Err(EquationError::Method(format!(
                "panels are from break to break: these must ascend from {} to {}",
                interval.a(),
                interval.b()
            )));
        }
        let (mut nodes, mut weights) = (Vec::new(), Vec::new());
        for (low, high) in breaks.windows(2).map(|ends| (ends[0], ends[1])) {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            nodes.extend(COARSE.nodes.iter().map(|xi| middle + half * xi));
            weights.extend(COARSE.weights.iter().map(|weight| half * weight));
        }
        Ok(Self { product: Product::new(equation, class)?, breaks, nodes, weights })
    }

    /// x_i, ascending.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The class of the kernel.
    pub fn class(&self) -> Class {
        self.product.class(0, 0)
    }

    /// Whether x is nearer to a panel than that is long.
    fn is_near(&self, x: f64, panel: usize) -> bool {
        let (low, high) = (self.breaks[panel], self.breaks[panel + 1]);
        (low - x).max(x - high) < high - low
    }

    /// K(x_i, x_j) w_j.
    fn far(&self, x: f64, columns: Range<usize>, row: &mut [f64]) {
        let y = &self.nodes[columns.clone()];
        let mut offsets = [0.0; CHUNK];
        let parts = row.chunks_mut(CHUNK).zip(y.chunks(CHUNK)).zip(self.weights[columns].chunks(CHUNK));
        for ((entries, y), weights) in parts {
            offsets.iter_mut().zip(y).for_each(|(offset, y)| *offset = y - x);
            self.product.equation().kernel(0, 0).row(x, y, &offsets[..y.len()], entries);
            entries.iter_mut().zip(weights).for_each(|(entry, weight)| *entry *= weight);
        }
    }

    /// The rule's weights on a panel; NaN where the kernel is not finite.
    fn near(&self, x: f64, panel: usize) -> [f64; POINTS] {
        let mut weights = [0.0; POINTS];
        let ends = (self.breaks[panel], self.breaks[panel + 1]);
        match self.product.builder((0, 0), x).panel(ends, &COARSE, &mut weights) {
            Ok(_) => weights,
            Err(_) => [f64::NAN; POINTS],
        }
    }
}

/// Columns that the kernel is asked for at once.
const CHUNK: usize = 256;

impl Coupling for ProductNystrom<'_, '_> {
    fn dim(&self) -> usize {
        self.nodes.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let (x, panel) = (self.nodes[i], j / POINTS);
        if self.is_near(x, panel) {
            return self.near(x, panel)[j % POINTS];
        }
        let mut entry = [0.0];
        self.far(x, j..j + 1, &mut entry);
        entry[0]
    }

    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        let (x, end) = (self.nodes[i], from + row.len());
        self.far(x, from..end, row);
        for panel in from / POINTS..end.div_ceil(POINTS) {
            if self.is_near(x, panel) {
                let weights = self.near(x, panel);
                for j in (POINTS * panel).max(from)..(POINTS * (panel + 1)).min(end) {
                    row[j - from] = weights[j % POINTS];
                }
            }
        }
    }
}
