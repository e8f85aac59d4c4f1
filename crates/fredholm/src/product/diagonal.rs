//! K(x, x ± u) for u → 0: what a kernel does on its diagonal, found by looking at it.

use super::change::Change;
use super::reference::{COARSE, POINTS, SINGULAR};
use super::row::Sampler;
use crate::equation::{Class, EquationError, LineKernel, Scalar};

/// How the rule must treat the diagonal.
#[derive(Clone, Debug)]
pub(crate) enum Diagonal {
    /// Like any other place.
    Smooth,
    /// As the end of one interval and the beginning of another, K being smooth on either side.
    Broken,
    /// As a singularity.
    Singular(Core),
}

impl Diagonal {
    /// What the class of a kernel asks for.
    pub(crate) fn of(class: Class) -> Self {
        match class {
            Class::Smooth | Class::Periodic | Class::Peaked => Self::Smooth,
            Class::Kink | Class::Jump => Self::Broken,
            Class::Logarithmic => Self::Singular(Core::new(5)),
            // ∫ u^β du becomes ∫ s^(power (1 + β) − 1) ds: at least the fourth power, which 40 nodes do to rounding.
            Class::Algebraic { exponent } => {
                Self::Singular(Core::new((5.0 / (1.0 + exponent)).ceil().clamp(5.0, 100.0) as i32))
            }
        }
    }
}

/// The innermost piece at a singularity: u = s^power on (0, 1), with the nodes of [`SINGULAR`] for s.
#[derive(Clone, Debug)]
pub(crate) struct Core {
    pub(crate) power: i32,
    /// Row by row, the basis polynomials of [`COARSE`] in u at the nodes in s.
    basis: Vec<f64>,
}

impl Core {
    fn new(power: i32) -> Self {
        let u: Vec<f64> =
            SINGULAR.nodes.iter().map(|xi| 2.0 * (0.5 * (1.0 + xi)).powi(power) - 1.0).collect();
        Self { power, basis: COARSE.basis_at_all(&u) }
    }

    /// How much smaller than the panel it must be, in halvings: g is a polynomial in u; in s its degree is `power` times
    /// as high, unless the core is so short that g is all but a line.
    pub(crate) fn levels(&self) -> u32 {
        2 + (self.power as u32).ilog2().saturating_sub(2)
    }

    /// Σ_q w_q K_q g(u_q) as weights of a g given at the nodes of [`COARSE`]; u runs to the left if `mirrored`.
    pub(crate) fn gather<T: Scalar>(&self, kernel: &[T], mirrored: bool) -> [T; POINTS] {
        let mut weights = [T::ZERO; POINTS];
        for ((k, w), basis) in kernel.iter().zip(&SINGULAR.weights).zip(self.basis.chunks_exact(POINTS)) {
            let term = *k * *w;
            weights.iter_mut().zip(basis).for_each(|(weight, l)| *weight += term * *l);
        }
        if mirrored {
            weights.reverse();
        }
        weights
    }
}

/// Where the diagonal is looked at, as parts of the interval: at no place that anybody would choose.
const PLACES: [f64; 5] = [0.1317, 0.3171, 0.5413, 0.7231, 0.9073];

/// A kernel that is smooth on one side of the diagonal shows it at one of these distances, as parts of the interval.
const REACHES: [f64; 5] = [0.08, 1e-2, 1e-3, 1e-4, 1e-5];

/// The class of a kernel: the worst that is seen on its diagonal.
///
/// # Errors
///
/// [`EquationError::Method`] where it cannot be integrated.
pub(crate) fn class<T: Scalar>(kernel: &dyn LineKernel<T>, change: Change) -> Result<Class, EquationError> {
    match seen(kernel, change)? {
        Class::Algebraic { exponent } if exponent < -0.99 => Err(EquationError::Method(format!(
            "the kernel grows like |x − y|^{exponent:.2} towards x = y: it cannot be integrated"
        ))),
        class => Ok(class),
    }
}

/// The worst that is seen of a kernel on its diagonal, whether it can be integrated or not.
pub(crate) fn seen<T: Scalar>(kernel: &dyn LineKernel<T>, change: Change) -> Result<Class, EquationError> {
    let (from, to) = change.range();
    let mut worst = Class::Smooth;
    for place in PLACES {
        let t = from + (to - from) * place;
        let seen = look(&mut Sampler::new(kernel, change, t), to - from)?;
        worst = worse(worst, seen);
    }
    Ok(worst)
}

/// Of two classes, the one that asks for more.
pub(crate) fn worse(one: Class, other: Class) -> Class {
    if severity(other) > severity(one) { other } else { one }
}

fn severity(class: Class) -> f64 {
    match class {
        Class::Smooth | Class::Periodic => 0.0,
        Class::Peaked => 1.0,
        Class::Kink => 2.0,
        Class::Jump => 3.0,
        Class::Algebraic { exponent } if exponent > 0.0 => 5.0 - exponent.min(1.0),
        Class::Logarithmic => 5.0,
        Class::Algebraic { exponent } => 5.0 - exponent,
    }
}

fn look<T: Scalar>(sampler: &mut Sampler<'_, T>, length: f64) -> Result<Class, EquationError> {
    for part in REACHES {
        let reach = part * length;
        let right = look_between(sampler, 0.0, reach)?;
        let left = look_between(sampler, 0.0, -reach)?;
        if right.resolved && left.resolved {
            // As long as one side, so that what is smooth is resolved here if it was there.
            let across = look_between(sampler, -0.5 * reach, 0.5 * reach)?;
            return Ok(match across.resolved {
                true if part == REACHES[0] => Class::Smooth,
                true => Class::Peaked,
                // A bend leaves the two nodes next to the diagonal about as far apart as their neighbours; a jump does not.
                false if (right.nearest - left.nearest).modulus() > 0.05 * across.span => Class::Jump,
                false => Class::Kink,
            });
        }
    }
    let right = exponent(sampler, length)?;
    let left = exponent(sampler, -length)?;
    let exponent = right.min(left);
    Ok(match exponent {
        // Differences that stay the same from one distance to its quarter.
        _ if exponent.abs() < 0.02 => Class::Logarithmic,
        // Steep at a scale below all reaches, but flat below that.
        _ if exponent > 1.5 => Class::Peaked,
        _ if (exponent - 1.0).abs() < 0.02 => Class::Kink,
        exponent => Class::Algebraic { exponent },
    })
}

/// What is seen of K between two distances from the diagonal.
struct Look<T> {
    resolved: bool,
    /// At the node nearest to the first distance.
    nearest: T,
    /// The largest difference of two values.
    span: f64,
}

fn look_between<T: Scalar>(
    sampler: &mut Sampler<'_, T>,
    from: f64,
    to: f64,
) -> Result<Look<T>, EquationError> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let tau: Vec<f64> = COARSE.nodes.iter().map(|xi| middle + half * xi).collect();
    let mut values = vec![T::ZERO; tau.len()];
    sampler.sample(&tau, &mut values)?;
    let largest = values.iter().map(|value| value.modulus()).fold(0.0, f64::max);
    let span = values.iter().map(|value| (*value - values[0]).modulus()).fold(0.0, f64::max);
    // A bend of 10⁻¹² of K is nobody's; a smooth kernel with large arguments has errors of some 10⁻¹⁴.
    let resolved = COARSE.unresolved(&values) <= 1e-13 * largest;
    Ok(Look { resolved, nearest: values[0], span })
}

/// β, when K is const + u^β for u → 0: differences at distances that shrink by 4 shrink by 4^β.
fn exponent<T: Scalar>(sampler: &mut Sampler<'_, T>, length: f64) -> Result<f64, EquationError> {
    // From 10⁻³ to 10⁻⁹ of the interval: nearer, x and y of a kernel that takes no offset have too few digits in common.
    let tau: Vec<f64> = (0..11).map(|k| 1e-3 * length * 0.25_f64.powi(k)).collect();
    let mut values = vec![T::ZERO; tau.len()];
    sampler.sample(&tau, &mut values)?;
    let largest = values.iter().map(|value| value.modulus()).fold(0.0, f64::max);
    let differences: Vec<f64> = values.windows(2).map(|v| (v[1] - v[0]).modulus()).collect();
    let mut rates =
        differences.windows(2).filter(|d| d[1] > 1e-11 * largest).map(|d| -(d[1] / d[0]).log(4.0));
    // The nearest are the truest; where all differences are rounding, K is flat.
    Ok(rates.next_back().unwrap_or(f64::INFINITY))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn class_of(kernel: impl Fn(f64, f64) -> f64 + Sync + Send) -> Class {
        class(&kernel, Change::Identity { a: 0.0, b: 1.0 }).unwrap()
    }

    #[test]
    fn kernels_are_told_apart() {
        assert_eq!(class_of(|x, y| (x + 1.0) * (-x * y).exp()), Class::Smooth);
        assert_eq!(class_of(|x, y| 0.01 / (1e-4 + (x - y).powi(2))), Class::Peaked);
        assert_eq!(class_of(|x, y| x.min(y) * (1.0 - x.max(y))), Class::Kink);
        assert_eq!(class_of(|x, y| (x - y).abs().powi(3)), Class::Kink);
        assert_eq!(class_of(|x, y| if y < x { x * y } else { 0.0 }), Class::Jump);
        assert_eq!(class_of(|x, y| (x - y).abs().ln() * (x * y).cos() + 3.0), Class::Logarithmic);
        for exponent in [-0.5, -1.0 / 3.0, -0.8, 0.5] {
            let Class::Algebraic { exponent: found } = class_of(|x, y| (x - y).abs().powf(exponent)) else {
                panic!("exponent {exponent} was not seen");
            };
            assert!((found - exponent).abs() < 0.01, "{exponent} was seen as {found}");
        }
        let abel = class_of(|x, y| if y < x { 0.0 } else { (y - x).sqrt().recip() });
        assert!(matches!(abel, Class::Algebraic { exponent } if (exponent + 0.5).abs() < 0.01), "{abel:?}");
    }

    #[test]
    fn what_cannot_be_integrated_is_told() {
        let kernel = |x: f64, y: f64| (x - y).abs().powf(-1.2);
        let error = class(&kernel, Change::Identity { a: 0.0, b: 1.0 }).unwrap_err();
        assert!(error.to_string().contains("|x − y|^-1.20"), "{error}");
    }
}
