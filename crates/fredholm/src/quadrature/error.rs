//! What can be wrong with a request for a rule or an integral.

/// Why there is no rule, or no integral.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuadratureError {
    /// The number of points, or the rank, is one that the rule does not have.
    #[error("{rule}: {given} points or panels; give {least} to {most}")]
    Size {
        /// The rule.
        rule: &'static str,
        /// What was asked for.
        given: usize,
        /// The least that makes sense.
        least: usize,
        /// The most that can be had to rounding.
        most: usize,
    },
    /// An exponent of a weight for which the weight has no integral, or one beyond the range of numbers.
    #[error("{rule}: the exponent {given} of the weight must lie above −1 and not above {most}")]
    Exponent {
        /// The rule.
        rule: &'static str,
        /// What was asked for.
        given: f64,
        /// The most for which the weight's integral is a number.
        most: f64,
    },
    /// An interval, triangle or disk that is none.
    #[error("{what} is {given}; {expected}")]
    Domain {
        /// What is wrong.
        what: &'static str,
        /// Its value.
        given: f64,
        /// What to give instead.
        expected: &'static str,
    },
    /// A degree for which there is no rule.
    #[error(
        "a symmetric rule of degree {degree} on the triangle is not known here; the most is {most}, or take the conical rule"
    )]
    Degree {
        /// What was asked for.
        degree: usize,
        /// The highest degree in the table.
        most: usize,
    },
    /// The function is not a finite number somewhere.
    #[error("the {what} is {value} at {at}; it must be a finite number inside the domain")]
    NotFinite {
        /// Integrand or weight.
        what: &'static str,
        /// The point.
        at: f64,
        /// What was found there.
        value: f64,
    },
    /// A weight that is negative somewhere, or zero everywhere.
    #[error("the weight is {value} at {at}; a weight is positive or zero, and not zero everywhere")]
    Weight {
        /// The point.
        at: f64,
        /// What was found there.
        value: f64,
    },
    /// The moments of a weight did not settle.
    #[error(
        "the moments of the weight differ by {change:e} from one refinement to the next, with {nodes} nodes; where it \
         is singular at an end that is not 0, move that end to 0, or integrate it by a rule of your own"
    )]
    Moments {
        /// The last relative change.
        change: f64,
        /// Nodes of the finest discretisation.
        nodes: usize,
    },
    /// A rule that does not integrate constants, or is too good to be told from an exact one.
    #[error(
        "no order up to {most} for an interval of length {length} and weights that add up to {weights}: they must be \
         equal, and the order at most that"
    )]
    Order {
        /// b − a.
        length: f64,
        /// Σ w.
        weights: f64,
        /// The highest order that was looked for.
        most: usize,
    },
}
