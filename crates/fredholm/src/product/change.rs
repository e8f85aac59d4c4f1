//! ∫ g(y) dy = ∫ g(x(t)) x′(t) dt: changes of variable to a finite interval, and to one where ends do not trouble.

use crate::equation::Interval;

/// A map t ↦ x(t) onto the interval of the equation.
///
/// Differences x(t + τ) − x(t) are exact to rounding, however small τ is: singular kernels need them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Change {
    /// x = t on [a, b].
    Identity { a: f64, b: f64 },
    /// x = a + (b − a) t^q / (t^q + (1 − t)^q) on [0, 1]: what behaves like (x − a)^β or (x − a) ln(x − a) at an end becomes
    /// q times as smooth in t (Kress 1990, Sidi 1993).
    Graded { a: f64, b: f64 },
    /// x = a ± (1 − t) / t on (0, 1]: a half-line that begins at a. Infinity is at 0, where doubles are dense.
    HalfLine { a: f64, sign: f64 },
    /// x = (1 − |t|) / t on [−1, 0) and (0, 1]: the whole line, cut at 0, with both infinities where doubles are dense.
    WholeLine,
}

/// q. Less leaves more for the panels to do; more brings nodes so near to the ends that x − a has no digits left
/// (with 16 nodes the nearest is 0.005^q of the interval away).
const GRADING: i32 = 5;

impl Change {
    /// The plain one: finite intervals stay as they are.
    pub(crate) fn plain(interval: Interval) -> Self {
        let (a, b) = (interval.a(), interval.b());
        match (a.is_finite(), b.is_finite()) {
            (true, true) => Self::Identity { a, b },
            (true, false) => Self::HalfLine { a, sign: 1.0 },
            (false, true) => Self::HalfLine { a: b, sign: -1.0 },
            (false, false) => Self::WholeLine,
        }
    }

    /// The one for a finite interval whose ends are singular.
    pub(crate) fn graded(interval: Interval) -> Self {
        match Self::plain(interval) {
            Self::Identity { a, b } => Self::Graded { a, b },
            infinite => infinite,
        }
    }

    /// Where t runs.
    pub(crate) fn range(&self) -> (f64, f64) {
        match *self {
            Self::Identity { a, b } => (a, b),
            Self::Graded { .. } | Self::HalfLine { .. } => (0.0, 1.0),
            Self::WholeLine => (-1.0, 1.0),
        }
    }

    /// How many equal panels there must be, at least: no panel may have an infinity within it.
    pub(crate) fn least_panels(&self) -> usize {
        if *self == Self::WholeLine { 2 } else { 1 }
    }

    /// x(t).
    pub(crate) fn point(&self, t: f64) -> f64 {
        match *self {
            Self::Identity { .. } => t,
            Self::Graded { a, .. } if t == 0.0 => a,
            Self::Graded { b, .. } if t == 1.0 => b,
            // From the nearer end, so that x − a and b − x keep their digits; and never the end itself, where a source
            // like x ln x is not a number.
            Self::Graded { a, b } if t <= 0.5 => {
                (a + (b - a) * (t.powi(GRADING) / denominator(t))).max(a.next_up())
            }
            Self::Graded { a, b } => {
                (b - (b - a) * ((1.0 - t).powi(GRADING) / denominator(t))).min(b.next_down())
            }
            Self::HalfLine { a, sign } => a + sign * ((1.0 - t) / t),
            Self::WholeLine => (1.0 - t.abs()) / t,
        }
    }

    /// |x′(t)|, the weight of dt.
    pub(crate) fn slope(&self, t: f64) -> f64 {
        match *self {
            Self::Identity { .. } => 1.0,
            Self::Graded { a, b } => {
                let ratio = (t * (1.0 - t)).powi(GRADING - 1) / denominator(t).powi(2);
                (b - a) * f64::from(GRADING) * ratio
            }
            Self::HalfLine { .. } | Self::WholeLine => t.powi(-2),
        }
    }

    /// x(t + τ) − x(t), without cancellation.
    pub(crate) fn offset(&self, t: f64, tau: f64) -> f64 {
        let next = t + tau;
        match *self {
            Self::Identity { .. } => tau,
            Self::Graded { a, b } => {
                // u^q − v^q = (u − v) Σ u^k v^(q−1−k) with u = t⁺ (1 − t) and v = t (1 − t⁺), for which u − v is τ.
                let (up, down) = (next * (1.0 - t), t * ((1.0 - t) - tau));
                let (up2, down2) = (up * up, down * down);
                let sum = up2 * up2 + up * down * (up2 + down2) + up2 * down2 + down2 * down2;
                (b - a) * (tau * sum / (denominator(t) * denominator(next)))
            }
            Self::HalfLine { sign, .. } => -sign * (tau / (t * next)),
            Self::WholeLine if (t > 0.0) == (next > 0.0) => -(tau / (t * next)),
            Self::WholeLine => self.point(next) - self.point(t),
        }
    }

    /// The t with x(t) = x.
    pub(crate) fn parameter(&self, x: f64) -> f64 {
        match *self {
            Self::Identity { .. } => x,
            Self::Graded { a, b } => {
                let (from, to) = (x - a, b - x);
                let root = |w: f64| w.powf(1.0 / f64::from(GRADING));
                root(from) / (root(from) + root(to))
            }
            Self::HalfLine { a, sign } => 1.0 / (1.0 + sign * (x - a)),
            Self::WholeLine => (1.0 / (1.0 + x.abs())).max(f64::MIN_POSITIVE).copysign(x),
        }
    }
}

/// t^q + (1 − t)^q.
fn denominator(t: f64) -> f64 {
    t.powi(GRADING) + (1.0 - t).powi(GRADING)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_slopes_and_offsets_belong_together() {
        let changes = [
            Change::Identity { a: 0.1, b: 0.9 },
            Change::Graded { a: -1.0, b: 2.0 },
            Change::HalfLine { a: 1.0, sign: 1.0 },
            Change::HalfLine { a: 1.0, sign: -1.0 },
            Change::WholeLine,
        ];
        for change in changes {
            for t in [-0.4, 0.12, 0.3, 0.5, 0.77].into_iter().filter(|t| *t >= change.range().0) {
                assert!((change.parameter(change.point(t)) - t).abs() < 1e-14, "{change:?}");
                let step = change.point(t + 1e-3) - change.point(t);
                assert!((change.offset(t, 1e-3) / step - 1.0).abs() < 1e-11, "{change:?}");
                // To first order, also where the points themselves are the same double.
                let tiny = change.offset(t, 1e-25).abs() / 1e-25;
                assert!((tiny / change.slope(t) - 1.0).abs() < 1e-14, "{change:?}");
            }
        }
    }
}
