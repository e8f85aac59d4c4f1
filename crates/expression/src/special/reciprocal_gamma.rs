//! 1/Γ(1 + μ) near μ = 0, in the parts that Temme's series take.

use std::f64::consts::PI;

/// The coefficients of the series 1/Γ(1 + μ) = Σ_k c_k μ^k (DLMF 5.7.1).
const COEFFICIENTS: [f64; 24] = [
    1.0,
    0.5772156649015329,
    -0.6558780715202539,
    -0.04200263503409524,
    0.16653861138229148,
    -0.04219773455554433,
    -0.009621971527876973,
    0.0072189432466631,
    -0.0011651675918590652,
    -0.00021524167411495098,
    0.0001280502823881162,
    -2.013485478078824e-05,
    -1.2504934821426706e-06,
    1.133027231981696e-06,
    -2.056338416977607e-07,
    6.116095104481416e-09,
    5.002007644469223e-09,
    -1.18127457048702e-09,
    1.0434267116911005e-10,
    7.782263439905071e-12,
    -3.696805618642206e-12,
    5.100370287454476e-13,
    -2.0583260535665066e-14,
    -5.348122539423018e-15,
];

/// What Temme's series need of an order |μ| ≤ ½.
pub(super) struct ReciprocalGamma {
    /// (1/Γ(1 − μ) − 1/Γ(1 + μ))/2μ.
    pub odd: f64,
    /// (1/Γ(1 − μ) + 1/Γ(1 + μ))/2.
    pub even: f64,
    /// 1/Γ(1 + μ).
    pub plus: f64,
    /// 1/Γ(1 − μ).
    pub minus: f64,
    /// πμ/sin πμ.
    pub reflection: f64,
}

impl ReciprocalGamma {
    pub fn new(order: f64) -> Self {
        let square = order * order;
        let part = |parity: usize| {
            let coefficients = COEFFICIENTS.iter().skip(parity).step_by(2);
            coefficients.rev().fold(0.0, |sum, coefficient| sum * square + coefficient)
        };
        let (even, odd) = (part(0), -part(1));
        let (plus, minus) = (even - order * odd, even + order * odd);
        let angle = PI * order;
        let reflection = if angle.abs() < f64::EPSILON { 1.0 } else { angle / angle.sin() };
        ReciprocalGamma { odd, even, plus, minus, reflection }
    }
}
