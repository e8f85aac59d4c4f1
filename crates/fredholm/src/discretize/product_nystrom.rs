//! F_ij = κ_j(x_i), the product rule where x_i is near the panel of x_j, and K(x_i, x_j) w_j elsewhere (paper, §1.2.3, remark).

use super::Coupling;
use crate::equation::{Class, Equation, EquationError, Scalar, all_parts, between_parts, of_all_parts};
use crate::operator::NotFinite;
use crate::product::{COARSE, POINTS, Product};
use std::ops::Range;

/// Nyström's method on panels of degree 15 for kernels that may be singular on their diagonal, one entry at a time: for as
/// many unknowns as a hierarchical operator can keep.
///
/// A panel is near as far as it is long. Further away a kernel that is analytic but on the diagonal is integrated by the
/// panel's own 16 nodes to 10⁻²⁰ of its size (5.8⁻³², by Bernstein's ellipse through the nearest singularity); one that is
/// wild elsewhere, as all are towards infinity, needs panels as short as that asks for.
///
/// F is real. The unknowns of a node follow each other: of a system one for each component, and of a complex equation the real and
/// the imaginary part of each.
#[derive(Debug)]
pub struct ProductNystrom<'e, 'a, T> {
    product: Product<'e, 'a, T>,
    /// In the variable t of the product's change, as all that follows.
    breaks: Vec<f64>,
    places: Vec<f64>,
    /// Of ∫ dt.
    weights: Vec<f64>,
    /// x at the places.
    nodes: Vec<f64>,
}

impl<'e, 'a, T: Scalar> ProductNystrom<'e, 'a, T> {
    /// The operator of an equation or a system on a finite interval, with a panel from each of `breaks` to the next: they ascend
    /// from one end of the interval to the other. The kernels are of a stated class, or each of the one that is seen.
    ///
    /// # Errors
    ///
    /// [`EquationError::Method`] for an infinite interval or breaks that are not of it.
    pub fn new(
        equation: &'e Equation<'a, T>,
        breaks: Vec<f64>,
        class: Option<Class>,
    ) -> Result<Self, EquationError> {
        let interval = equation.interval();
        let ends = (breaks.first(), breaks.last());
        if !interval.is_finite() {
            return Err(EquationError::Method(
                "the product rule on panels that are given takes a finite interval".to_owned(),
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
        Ok(Self::of_panels(Product::new(equation, class)?, breaks))
    }

    /// The same with a rule that is there, on panels in its variable.
    pub(crate) fn of_panels(product: Product<'e, 'a, T>, breaks: Vec<f64>) -> Self {
        let (mut places, mut weights) = (Vec::new(), Vec::new());
        for (low, high) in breaks.windows(2).map(|ends| (ends[0], ends[1])) {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            places.extend(COARSE.nodes.iter().map(|xi| middle + half * xi));
            weights.extend(COARSE.weights.iter().map(|weight| half * weight));
        }
        let nodes = places.iter().map(|t| product.change().point(*t)).collect();
        Self { product, breaks, places, weights, nodes }
    }

    /// x_i, ascending on a finite interval, each of which has [`Self::width`] unknowns.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// How many unknowns a node has: the real numbers in a value of φ.
    pub fn width(&self) -> usize {
        self.product.equation().components() * T::PARTS
    }

    /// Where each unknown is, for a tree of them.
    pub fn points(&self) -> Vec<[f64; 1]> {
        self.places.iter().flat_map(|t| std::iter::repeat_n([*t], self.width())).collect()
    }

    /// The unknowns of a function with these values at the nodes, component after component.
    ///
    /// # Panics
    ///
    /// Unless there is a value for each node and component.
    pub fn unknowns(&self, values: &[T]) -> Vec<f64> {
        assert_eq!(values.len() * T::PARTS, self.dim(), "a value for each node and component");
        all_parts(&transposed(values, self.nodes.len()))
    }

    /// The values at the nodes, component after component, that unknowns stand for.
    ///
    /// # Panics
    ///
    /// Unless there are as many as the operator has.
    pub fn values(&self, unknowns: &[f64]) -> Vec<T> {
        assert_eq!(unknowns.len(), self.dim(), "a number for each unknown");
        transposed(&of_all_parts(unknowns), self.product.equation().components())
    }

    /// Where the kernel is not finite, of an entry that is not.
    pub(crate) fn told(&self, entry: NotFinite) -> EquationError {
        let ((node, a, _), (other, b, _)) = (self.place(entry.row), self.place(entry.column));
        let (t, s, panel) = (self.places[node], self.places[other], other / POINTS);
        let sampled = match self.is_near(t, panel) {
            true => self.near((a, b), t, panel).map(drop),
            false => {
                let (mut y, mut offset, mut value) = ([0.0], [0.0], [T::ZERO]);
                self.product.seen((a, b), t).sample(&[s - t], (&mut y, &mut offset), &mut value)
            }
        };
        let here = || EquationError::KernelNotFinite {
            x: self.nodes[node],
            y: self.nodes[other],
            value: entry.value.to_string(),
        };
        sampled.err().unwrap_or_else(here)
    }

    /// The class of the kernel, of a system's the worst.
    pub fn class(&self) -> Class {
        self.product.worst_class()
    }

    /// The node, the component and the part of an unknown.
    fn place(&self, unknown: usize) -> (usize, usize, usize) {
        let (node, rest) = (unknown / self.width(), unknown % self.width());
        (node, rest / T::PARTS, rest % T::PARTS)
    }

    /// Whether t is nearer to a panel than that is long.
    fn is_near(&self, t: f64, panel: usize) -> bool {
        let (low, high) = (self.breaks[panel], self.breaks[panel + 1]);
        (low - t).max(t - high) < high - low
    }

    /// The weights κ of K_ab for a node at these, told a run at a time with its first one; NaN where the kernel is not finite.
    fn row_of(
        &self,
        node: usize,
        kernel: (usize, usize),
        nodes: Range<usize>,
        mut take: impl FnMut(usize, &[T]),
    ) {
        let t = self.places[node];
        let mut from = nodes.start;
        while from < nodes.end {
            let panel = from / POINTS;
            let mut to = nodes.end.min((panel + 1) * POINTS);
            if self.is_near(t, panel) {
                take(from, &self.near_or_nan(kernel, t, panel)[from % POINTS..][..to - from]);
            } else {
                let most = nodes.end.min(from + CHUNK);
                while to < most && !self.is_near(t, to / POINTS) {
                    to = most.min(to + POINTS);
                }
                take(from, &self.far::<CHUNK>(kernel, t, from..to)[..to - from]);
            }
            from = to;
        }
    }

    /// K_ab(x, x_j) w_j of up to N nodes; NaN where the kernel is not finite.
    fn far<const N: usize>(&self, kernel: (usize, usize), t: f64, nodes: Range<usize>) -> [T; N] {
        let (n, mut tau, mut y, mut offset) = (nodes.len(), [0.0; N], [0.0; N], [0.0; N]);
        let mut values = [T::ZERO; N];
        tau.iter_mut().zip(&self.places[nodes.clone()]).for_each(|(tau, s)| *tau = s - t);
        let seen = self.product.seen(kernel, t);
        match seen.sample(&tau[..n], (&mut y[..n], &mut offset[..n]), &mut values[..n]) {
            Ok(()) => {
                let weights = &self.weights[nodes];
                values.iter_mut().zip(weights).for_each(|(value, weight)| *value = *value * *weight);
                values
            }
            // Alone, so that it is told where it is not finite.
            Err(_) if n > 1 => {
                nodes.zip(&mut values).for_each(|(j, value)| *value = self.far::<1>(kernel, t, j..j + 1)[0]);
                values
            }
            Err(_) => [T::of_parts(f64::NAN, f64::NAN); N],
        }
    }

    /// The rule's weights on a panel.
    fn near(&self, kernel: (usize, usize), t: f64, panel: usize) -> Result<[T; POINTS], EquationError> {
        let mut weights = [T::ZERO; POINTS];
        let ends = (self.breaks[panel], self.breaks[panel + 1]);
        self.product.builder(kernel, t).panel(ends, &COARSE, &mut weights)?;
        Ok(weights)
    }

    /// The same; NaN where the kernel is not finite.
    fn near_or_nan(&self, kernel: (usize, usize), t: f64, panel: usize) -> [T; POINTS] {
        self.near(kernel, t, panel).unwrap_or([T::of_parts(f64::NAN, f64::NAN); POINTS])
    }
}

/// The columns of a matrix, one after another, of rows of so many numbers.
fn transposed<T: Copy>(rows: &[T], width: usize) -> Vec<T> {
    (0..width).flat_map(|column| rows[column..].iter().step_by(width).copied()).collect()
}

/// Nodes that the kernel is asked for at once.
const CHUNK: usize = 64;

impl<T: Scalar> Coupling for ProductNystrom<'_, '_, T> {
    fn dim(&self) -> usize {
        self.nodes.len() * self.width()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let ((node, a, p), (other, b, q)) = (self.place(i), self.place(j));
        let (t, panel) = (self.places[node], other / POINTS);
        let weight = match self.is_near(t, panel) {
            true => self.near_or_nan((a, b), t, panel)[other % POINTS],
            false => self.far::<1>((a, b), t, other..other + 1)[0],
        };
        between_parts(weight, p, q)
    }

    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        let (width, end) = (self.width(), from + row.len());
        let (node, a, p) = self.place(i);
        for b in 0..self.product.equation().components() {
            self.row_of(node, (a, b), from / width..end.div_ceil(width), |first, weights| {
                for q in 0..T::PARTS {
                    let columns = (first * width + b * T::PARTS + q..end).step_by(width);
                    for (j, weight) in columns.zip(weights).filter(|(j, _)| *j >= from) {
                        row[j - from] = between_parts(*weight, p, q);
                    }
                }
            });
        }
    }
}
