//! The functions and constants that a formula may name.

use crate::operation::{Binary, Unary};
use std::f64::consts::{E, PI};
use std::sync::LazyLock;

/// What a function of the language is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Meaning {
    Unary(Unary),
    Binary(Binary),
    /// Two arguments or more, combined from the left.
    Fold(Binary),
    If,
}

/// A function of the language: its name with the arguments' names, what it is, a line of help.
#[derive(Debug)]
pub(crate) struct Function {
    pub signature: &'static str,
    pub meaning: Meaning,
    pub help: &'static str,
}

impl Function {
    pub fn name(&self) -> &'static str {
        self.signature.split('(').next().unwrap_or(self.signature)
    }

    /// The number of arguments, in words, and whether `count` is right.
    pub fn arity(&self, count: usize) -> (&'static str, bool) {
        match self.meaning {
            Meaning::Unary(_) => ("one argument", count == 1),
            Meaning::Binary(_) => ("two arguments", count == 2),
            Meaning::Fold(_) => ("two arguments or more", count >= 2),
            Meaning::If => ("three arguments", count == 3),
        }
    }
}

/// The function of that name.
pub(crate) fn function(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name() == name)
}

/// The constant of that name.
pub(crate) fn constant(name: &str) -> Option<f64> {
    match name {
        "pi" | "π" => Some(PI),
        "e" => Some(E),
        _ => None,
    }
}

/// The functions of the language: each as it is called, with its meaning in a line.
///
/// ```
/// assert!(expression::functions().iter().any(|(call, meaning)| *call == "ellipk(k)" && !meaning.is_empty()));
/// ```
pub fn functions() -> &'static [(&'static str, &'static str)] {
    static LIST: LazyLock<Vec<(&str, &str)>> =
        LazyLock::new(|| FUNCTIONS.iter().map(|f| (f.signature, f.help)).collect());
    &LIST
}

const fn unary(signature: &'static str, operation: Unary, help: &'static str) -> Function {
    Function { signature, meaning: Meaning::Unary(operation), help }
}

const fn binary(signature: &'static str, operation: Binary, help: &'static str) -> Function {
    Function { signature, meaning: Meaning::Binary(operation), help }
}

const fn fold(signature: &'static str, operation: Binary, help: &'static str) -> Function {
    Function { signature, meaning: Meaning::Fold(operation), help }
}

static FUNCTIONS: [Function; 46] = [
    unary("abs(z)", Unary::Abs, "absolute value, modulus"),
    unary("sign(x)", Unary::Sign, "-1, 0 or 1"),
    unary("floor(x)", Unary::Floor, "largest integer not above x"),
    unary("ceil(x)", Unary::Ceil, "smallest integer not below x"),
    binary("mod(a,b)", Binary::Mod, "a - b*floor(a/b), with the sign of b"),
    fold("min(a,b,…)", Binary::Min, "the smallest"),
    fold("max(a,b,…)", Binary::Max, "the largest"),
    Function { signature: "if(c,a,b)", meaning: Meaning::If, help: "a where the condition c holds, else b" },
    unary("exp(z)", Unary::Exp, "e^z"),
    unary("ln(z)", Unary::Ln, "natural logarithm"),
    unary("log(z)", Unary::Ln, "natural logarithm, as ln"),
    unary("log10(z)", Unary::Log10, "logarithm to base 10"),
    unary("sqrt(z)", Unary::Sqrt, "square root"),
    unary("cbrt(x)", Unary::Cbrt, "real cube root"),
    unary("sin(z)", Unary::Sin, "sine, of radians"),
    unary("cos(z)", Unary::Cos, "cosine"),
    unary("tan(z)", Unary::Tan, "tangent"),
    unary("asin(z)", Unary::Asin, "inverse sine"),
    unary("acos(z)", Unary::Acos, "inverse cosine"),
    unary("atan(z)", Unary::Atan, "inverse tangent"),
    binary("atan2(y,x)", Binary::Atan2, "angle of the point (x, y), in (-pi, pi]"),
    unary("sinh(z)", Unary::Sinh, "hyperbolic sine"),
    unary("cosh(z)", Unary::Cosh, "hyperbolic cosine"),
    unary("tanh(z)", Unary::Tanh, "hyperbolic tangent"),
    unary("asinh(z)", Unary::Asinh, "inverse hyperbolic sine"),
    unary("acosh(z)", Unary::Acosh, "inverse hyperbolic cosine"),
    unary("atanh(z)", Unary::Atanh, "inverse hyperbolic tangent"),
    unary("erf(x)", Unary::Erf, "error function, 2/sqrt(pi) ∫_0^x exp(-t^2) dt"),
    unary("erfc(x)", Unary::Erfc, "1 - erf(x), without cancellation"),
    unary("gamma(x)", Unary::Gamma, "gamma function; gamma(n+1) = n!"),
    unary("lgamma(x)", Unary::LnGamma, "ln |gamma(x)|"),
    binary("besselj(n,x)", Binary::BesselJ, "Bessel function J_n(x), n real"),
    binary("bessely(n,x)", Binary::BesselY, "Bessel function Y_n(x), n real, x > 0"),
    binary("besseli(n,x)", Binary::BesselI, "modified Bessel function I_n(x), n real"),
    binary("besselk(n,x)", Binary::BesselK, "modified Bessel function K_n(x), n real, x > 0"),
    binary(
        "expint(n,x)",
        Binary::ExpInt,
        "exponential integral E_n(x) = ∫_1^∞ exp(-x*t)/t^n dt, n = 0, 1, 2, …",
    ),
    unary("ei(x)", Unary::Ei, "exponential integral Ei(x) = -∫_-x^∞ exp(-t)/t dt, the principal value"),
    unary(
        "ellipk(k)",
        Unary::EllipK,
        "complete elliptic integral of the modulus k, ∫_0^(pi/2) 1/sqrt(1-k^2*sin(t)^2) dt",
    ),
    unary(
        "ellipe(k)",
        Unary::EllipE,
        "complete elliptic integral of the modulus k, ∫_0^(pi/2) sqrt(1-k^2*sin(t)^2) dt",
    ),
    unary("li2(x)", Unary::Li2, "dilogarithm -∫_0^x ln|1-t|/t dt: the real part where x > 1"),
    unary("real(z)", Unary::Real, "real part"),
    unary("imag(z)", Unary::Imag, "imaginary part"),
    unary("conj(z)", Unary::Conj, "complex conjugate"),
    unary("arg(z)", Unary::Arg, "angle of z, in (-pi, pi]"),
    unary("re(z)", Unary::Real, "real part, as real"),
    unary("im(z)", Unary::Imag, "imaginary part, as imag"),
];
