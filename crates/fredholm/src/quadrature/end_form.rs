//! q_{k+1} = q_k + d_{k+1}, d_{k+1} = c_k d_k − e_k t q_k: the recurrence (4.14) seen from an end of the interval.
//!
//! There q is the polynomial divided by its value at the end and t the distance from the end. The textbook's form loses
//! near an end what this one keeps, the *relative* accuracy of t and of the weights; with n = 5000 that is 8 digits.

use std::array::from_fn;

/// Nodes worked on at once: the recurrence is a chain, and eight of them fill the vector units.
const LANES: usize = 8;
type Lanes = [f64; LANES];

/// q is kept below 2^300 by taking out 2^300 as often as needed: Laguerre's polynomials exceed all numbers.
const HUGE: f64 = 2.037_035_976_334_486e90;
/// A step multiplies q by 4n at most: sixteen of them leave 1e90 · (4n)^16 finite up to n = 5e12.
const STEPS_BETWEEN_CHECKS: usize = 16;

/// The polynomial q of degree n: its recurrence and its differential equation A q″ + B q′ + N q = 0, with
/// A = t (a₀ − a₁ t), B = b₀ − b₁ t and A q′ = g_d d + g_q t q.
#[derive(Clone, Debug)]
pub(super) struct EndForm {
    recurrence: Vec<[f64; 2]>,
    pub(super) a: [f64; 2],
    b: [f64; 2],
    eigenvalue: f64,
    derivative: [f64; 2],
}

/// A root t > 0 of q and 2^`exponent` `weight` = A / (A q′)², to which the Gauss weight is proportional.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root {
    pub(super) t: f64,
    pub(super) weight: f64,
    pub(super) exponent: i32,
}

impl EndForm {
    /// P_n^(α, β) at x = 1 − t.
    pub(super) fn jacobi(n: usize, alpha: f64, beta: f64) -> Self {
        let (degree, sum) = (n as f64, alpha + beta);
        Self {
            recurrence: (0..n).map(|k| jacobi_step(k as f64, alpha, beta)).collect(),
            a: [2.0, 1.0],
            b: [2.0 * alpha + 2.0, sum + 2.0],
            eigenvalue: degree * (degree + sum + 1.0),
            derivative: [2.0 * degree * (degree + beta) / (2.0 * degree + sum), -degree],
        }
    }

    /// L_n^(α) at t.
    pub(super) fn laguerre(n: usize, alpha: f64) -> Self {
        let step = |k: f64| [k / (k + alpha + 1.0), 1.0 / (k + alpha + 1.0)];
        Self {
            recurrence: (0..n).map(|k| step(k as f64)).collect(),
            a: [1.0, 0.0],
            b: [alpha + 1.0, 1.0],
            eigenvalue: n as f64,
            derivative: [n as f64, 0.0],
        }
    }

    /// The roots nearest to the guesses, to rounding, which must be near enough for Newton's method.
    pub(super) fn roots(&self, guesses: &[f64]) -> Vec<Root> {
        let mut roots = Vec::with_capacity(guesses.len());
        for chunk in guesses.chunks(LANES) {
            // Lanes left over repeat the last guess.
            let found = self.polish(from_fn(|k| chunk[k.min(chunk.len() - 1)]));
            roots.extend_from_slice(&found[..chunk.len()]);
        }
        roots
    }

    /// Halley's method, which costs no more than Newton's since the equation gives q″.
    fn polish(&self, mut t: Lanes) -> [Root; LANES] {
        let mut slope = [0.0; LANES];
        let mut exponent = [0; LANES];
        // Guesses from the formulae take two steps, those from eigenvalues one; eight are there for what is hard.
        for _ in 0..8 {
            let (q, d, scale) = self.evaluate(&t);
            exponent = scale;
            let mut far = false;
            for k in 0..LANES {
                let step = self.step(t[k], q[k], d[k]);
                far |= step.far;
                (t[k], slope[k]) = (t[k] + step.delta, step.slope);
            }
            if !far {
                break;
            }
        }
        from_fn(|k| Root {
            t: t[k],
            weight: self.leading(t[k]) / (slope[k] * slope[k]),
            exponent: -2 * exponent[k],
        })
    }

    /// A(t).
    fn leading(&self, t: f64) -> f64 {
        t * (self.a[0] - self.a[1] * t)
    }

    fn step(&self, t: f64, q: f64, d: f64) -> Step {
        let (a, b) = (self.leading(t), self.b[0] - self.b[1] * t);
        let slope = self.derivative[0] * d + self.derivative[1] * t * q;
        let q1 = slope / a;
        let newton = -q / q1;
        let q2 = -(b * q1 + self.eigenvalue * q) / a;
        let delta = newton / (1.0 + 0.5 * newton * q2 / q1);
        // (A q′)′ = (A′ − B) q′ − N q carries A q′ to the root; what that leaves out is the square of the phase.
        let turn = (self.a[0] - 2.0 * self.a[1] * t - b) * q1 - self.eigenvalue * q;
        // The phase by which the root was missed: its cube is what Halley leaves, its square is lost in the weight.
        let far = delta * delta * self.eigenvalue.max(1.0) > 1e-16 * a.abs();
        Step { delta, slope: slope + delta * turn, far }
    }

    /// (q, d, e) after n steps: the polynomial is 2^e q, its last difference 2^e d.
    fn evaluate(&self, t: &Lanes) -> (Lanes, Lanes, [i32; LANES]) {
        let (mut q, mut d, mut exponent) = ([1.0; LANES], [0.0; LANES], [0; LANES]);
        for steps in self.recurrence.chunks(STEPS_BETWEEN_CHECKS) {
            for [c, e] in steps {
                for k in 0..LANES {
                    d[k] = c * d[k] - e * t[k] * q[k];
                    q[k] += d[k];
                }
            }
            for k in 0..LANES {
                if q[k].abs() + d[k].abs() > HUGE {
                    (q[k], d[k], exponent[k]) = (q[k] / HUGE, d[k] / HUGE, exponent[k] + 300);
                }
            }
        }
        (q, d, exponent)
    }
}

struct Step {
    delta: f64,
    slope: f64,
    far: bool,
}

/// [c_k, e_k] of Jacobi's polynomials.
fn jacobi_step(k: f64, alpha: f64, beta: f64) -> [f64; 2] {
    if k == 0.0 {
        return [0.0, (alpha + beta + 2.0) / (2.0 * (1.0 + alpha))];
    }
    let (sum, below) = (2.0 * k + alpha + beta, (k + 1.0 + alpha) * (k + alpha + beta + 1.0));
    [k * (k + beta) * (sum + 2.0) / (below * sum), (sum + 1.0) * (sum + 2.0) / (2.0 * below)]
}
