//! ∫ K(x, y) g(y) dy = Σ_q κ_q(x) g(y_q): the quadrature rule that varies with x (paper, §1.2.3, remark).
//!
//! For each x the interval is cut until K(x, ·) is resolved on every piece: at the diagonal, where Green's functions have
//! their bend, geometrically towards a peak, and with a change of variable into a singularity. What is integrated with
//! K is only asked to be a polynomial on panels, so that a handful of unknowns is enough where K is wild but φ is not.

mod change;
pub(crate) mod diagonal;
mod reference;
mod row;

pub(crate) use change::Change;
pub(crate) use diagonal::Diagonal;
pub(crate) use reference::{COARSE, FINE, POINTS, Reference, SINGULAR};
pub(crate) use row::{OnPanel, RowBuilder, Seen};

use crate::equation::{Class, Equation, EquationError, Scalar};

/// The rule for an equation, which knows what each of its kernels does on the diagonal.
#[derive(Clone, Debug)]
pub struct Product<'e, 'a, T> {
    equation: &'e Equation<'a, T>,
    change: Change,
    classes: Vec<Class>,
    /// What the classes ask for.
    diagonals: Vec<Diagonal>,
}

/// The nodes y_q and weights κ_q of the rule for one x; the kernel is in the weights.
#[derive(Clone, Debug)]
pub struct Row<T> {
    /// y_q.
    pub nodes: Vec<f64>,
    /// κ_q.
    pub weights: Vec<T>,
    /// An estimate of the rule's error for |g| ≤ 1.
    pub error: f64,
}

impl<T: Scalar> Row<T> {
    /// Σ_q κ_q g(y_q).
    pub fn apply(&self, g: impl Fn(f64) -> T) -> T {
        self.nodes.iter().zip(&self.weights).map(|(y, weight)| *weight * g(*y)).sum()
    }
}

impl<'e, 'a, T: Scalar> Product<'e, 'a, T> {
    /// The rule for the kernels of an equation, all of a stated class or each of the class that is seen.
    pub fn new(equation: &'e Equation<'a, T>, class: Option<Class>) -> Result<Self, EquationError> {
        Self::with_change(equation, Change::plain(equation.interval()), class)
    }

    pub(crate) fn with_change(
        equation: &'e Equation<'a, T>,
        change: Change,
        stated: Option<Class>,
    ) -> Result<Self, EquationError> {
        let m = equation.components();
        let found = |k: usize| match stated {
            Some(Class::Algebraic { exponent }) if exponent.is_nan() || exponent <= -1.0 => {
                Err(EquationError::Method(format!(
                    "|x − y|^{exponent} cannot be integrated: state an exponent above −1"
                )))
            }
            Some(class) => Ok(class),
            None => diagonal::class(equation.kernel(k / m, k % m), change),
        };
        Ok(Self::of_classes(equation, change, (0..m * m).map(found).collect::<Result<_, _>>()?))
    }

    fn of_classes(equation: &'e Equation<'a, T>, change: Change, classes: Vec<Class>) -> Self {
        let diagonals = classes.iter().map(|class| Diagonal::of(*class)).collect();
        Self { equation, change, classes, diagonals }
    }

    /// The same classes, in another variable.
    pub(crate) fn changed(&self, change: Change) -> Self {
        Self::of_classes(self.equation, change, self.classes.clone())
    }

    /// The rule for the adjoint of the equation, in the same variable.
    pub(crate) fn adjoint<'f, 'b>(&self, adjoint: &'f Equation<'b, T>) -> Product<'f, 'b, T> {
        let m = adjoint.components();
        let classes = (0..m * m).map(|k| self.class(k % m, k / m)).collect();
        Product::of_classes(adjoint, self.change, classes)
    }

    /// The equation.
    pub fn equation(&self) -> &'e Equation<'a, T> {
        self.equation
    }

    pub(crate) fn change(&self) -> Change {
        self.change
    }

    /// The class of K_ab.
    pub fn class(&self, a: usize, b: usize) -> Class {
        self.classes[a * self.equation.components() + b]
    }

    /// The worst class of all kernels.
    pub fn worst_class(&self) -> Class {
        self.classes.iter().copied().fold(Class::Smooth, diagonal::worse)
    }

    /// The rule for K_ab(x, ·), good to rounding for every g that is a polynomial of degree ≤ 15 from one of the
    /// `breaks` to the next; they ascend from one end of the interval to the other. Its nodes are the same for every x.
    pub fn row(&self, (a, b): (usize, usize), x: f64, breaks: &[f64]) -> Result<Row<T>, EquationError> {
        let mut builder = self.builder((a, b), self.change.parameter(x));
        let mut row = Row { nodes: Vec::new(), weights: Vec::new(), error: 0.0 };
        for ends in breaks.windows(2) {
            let (t, next) = (self.change.parameter(ends[0]), self.change.parameter(ends[1]));
            let (low, high) = (t.min(next), t.max(next));
            let nodes = COARSE.nodes.iter().map(|xi| 0.5 * ((high + low) + (high - low) * xi));
            row.nodes.extend(nodes.map(|t| self.change.point(t)));
            let start = row.weights.len();
            row.weights.resize(row.nodes.len(), T::ZERO);
            row.error += builder.panel((low, high), &COARSE, &mut row.weights[start..])?.error;
        }
        Ok(row)
    }

    /// K_ab, seen from t.
    pub(crate) fn seen(&self, (a, b): (usize, usize), t: f64) -> Seen<'_, T> {
        Seen::new(self.equation.kernel(a, b), self.change, t)
    }

    pub(crate) fn builder(&self, (a, b): (usize, usize), t: f64) -> RowBuilder<'_, T> {
        let diagonal = &self.diagonals[a * self.equation.components() + b];
        RowBuilder::new(self.equation.kernel(a, b), self.change, diagonal, t)
    }
}
