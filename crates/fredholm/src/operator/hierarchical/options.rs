//! ε, η, the size of a leaf, the memory that may be taken; and what can go wrong.

use super::cluster::ClusterError;
use crate::memory;
use crate::operator::NotFinite;

/// How F is to be kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// ε: ‖F − F̃‖ ≤ ε ‖F‖ in the Frobenius norm, and so in each far block.
    pub tolerance: f64,
    /// η: a block is far where the smaller of its clusters is at most η times as large as the gap between them.
    pub eta: f64,
    /// The most unknowns of a cluster that is not cut any more.
    pub leaf: usize,
    /// The most bytes that may be taken.
    pub memory: u64,
}

impl Default for Options {
    /// ε = 10⁻¹⁰, η = 2, 64 unknowns, as many bytes as [`memory::limit`] says.
    ///
    /// With η = 1 a line has the same blocks, and a sphere takes half as much memory again; with ½ a line does so too. Leaves of
    /// 32 take a fifth less memory on a line and as much on a sphere, and longer to make and to apply; leaves of 128 take half
    /// as much again and a quarter.
    fn default() -> Self {
        Self { tolerance: 1e-10, eta: 2.0, leaf: 64, memory: memory::limit() }
    }
}

/// Least and greatest ε: below, sums of singular values are rounding.
const TOLERANCES: [f64; 2] = [1e-14, 0.5];

impl Options {
    pub(super) fn check(&self) -> Result<(), HierarchicalError> {
        let Self { tolerance, eta, .. } = *self;
        if !(TOLERANCES[0]..=TOLERANCES[1]).contains(&tolerance) {
            return Err(HierarchicalError::Tolerance { tolerance });
        }
        if !(eta > 0.0 && eta.is_finite()) {
            return Err(HierarchicalError::Eta { eta });
        }
        Ok(())
    }
}

/// Why there is no hierarchical operator.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HierarchicalError {
    /// A tolerance that cannot be met, or means nothing.
    #[error("a tolerance of {tolerance} cannot be had: take one from 1e-14 to 0.5")]
    Tolerance {
        /// As it was given.
        tolerance: f64,
    },
    /// No number that says what is far.
    #[error("η = {eta} does not say what is far: take a number above 0, as 2")]
    Eta {
        /// As it was given.
        eta: f64,
    },
    /// A place for each unknown is needed.
    #[error("{points} points for {unknowns} unknowns: each needs one")]
    Sizes {
        /// How many points were given.
        points: usize,
        /// The coupling's size.
        unknowns: usize,
    },
    /// A point is nowhere.
    #[error(transparent)]
    Point(#[from] ClusterError),
    /// An entry is infinite or NaN.
    #[error(transparent)]
    Entry(#[from] NotFinite),
    /// More memory is needed than may be taken.
    #[error(
        "{unknowns} unknowns take {:.3} GB kept hierarchically, and {:.3} GB are allowed: take a larger tolerance than {tolerance:e} or \
         fewer unknowns; if the kernel is not smooth away from the diagonal, do not keep F at all (`OnTheFly`)",
        *needed as f64 / 1e9,
        *allowed as f64 / 1e9
    )]
    Memory {
        /// n.
        unknowns: usize,
        /// ε.
        tolerance: f64,
        /// Bytes, an estimate.
        needed: u64,
        /// Bytes.
        allowed: u64,
    },
}
