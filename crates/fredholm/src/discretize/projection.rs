//! Projection on the broken space P0: F_ij = coefficient i of P_n(∫_{e_j} K(·, y) dy) (paper, §1.4, §3.3).

use super::Coupling;
use crate::kernel::Kernel;
use crate::space::{Element, Space};

/// P_n = interpolation at the nodes: F_ij = ∫_{e_j} K(x_i, y) dy (paper, §1.4.2; (3.3) with i and j in their right places).
#[derive(Clone, Debug)]
pub struct Collocation<K, P> {
    kernel: K,
    space: Space<P>,
}

/// P_n = orthogonal projection, the mean over each element: F_ij = 1/|e_i| ∫_{e_i} ∫_{e_j} K(x, y) dy dx
/// (paper, §1.4.4, (3.5)).
#[derive(Clone, Debug)]
pub struct Galerkin<K, P> {
    kernel: K,
    space: Space<P>,
}

impl<P: Sync, K: Kernel<P>> Collocation<K, P> {
    /// The kernel collocated at the nodes of the space's elements, integrated by their rules.
    pub fn new(kernel: K, space: Space<P>) -> Self {
        Self { kernel, space }
    }
}

impl<P: Sync, K: Kernel<P>> Galerkin<K, P> {
    /// The kernel averaged and integrated by the rules of the space's elements.
    pub fn new(kernel: K, space: Space<P>) -> Self {
        Self { kernel, space }
    }
}

/// ∫_e K(x, y) dy by the element's rule.
fn integral<P>(kernel: &impl Kernel<P>, x: &P, element: &Element<P>) -> f64 {
    element.quadrature.integrate(|y| kernel.at(x, y))
}

impl<P: Sync, K: Kernel<P>> Coupling for Collocation<K, P> {
    fn dim(&self) -> usize {
        self.space.elements.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        integral(&self.kernel, &self.space.elements[i].node, &self.space.elements[j])
    }
}

impl<P: Sync, K: Kernel<P>> Coupling for Galerkin<K, P> {
    fn dim(&self) -> usize {
        self.space.elements.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let test = &self.space.elements[i].quadrature;
        let measure: f64 = test.weights.iter().sum();
        test.integrate(|x| integral(&self.kernel, x, &self.space.elements[j])) / measure
    }
}
