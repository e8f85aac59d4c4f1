//! The kernel K(x, y) of the integral operator (Kφ)(x) = ∫ K(x, y) φ(y) dy (paper, §1.1.1).

/// A real kernel on pairs of points. Closures `Fn(&P, &P) -> f64` are kernels.
pub trait Kernel<P>: Sync {
    /// K(x, y); a kernel that is singular at x = y returns the value that its quadrature rule should use there.
    fn at(&self, x: &P, y: &P) -> f64;

    /// Whether K(x, y) = K(y, x) for all x and y: the operator is its own adjoint, and half of F need be computed.
    fn is_symmetric(&self) -> bool {
        false
    }
}

impl<P, K: Fn(&P, &P) -> f64 + Sync> Kernel<P> for K {
    fn at(&self, x: &P, y: &P) -> f64 {
        self(x, y)
    }
}
