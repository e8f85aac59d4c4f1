//! û on a finer mesh, without solving again: H at the new nodes is gathered from what the old mesh sends, Nyström's interpolant
//! (1.29), and between them it is a polynomial again.

use super::field::Field;
use super::links::{Coarseness, gathered};
use super::refine::{kept, residuals, rough};
use super::space::Space;
use super::tree::Tree;
use fredholm::value::Value;
use rayon::prelude::*;

/// Points on a patch from which on it is worth to cut it: so many look at the scene from its parts.
const WORTH: f64 = 50.0;

impl<V: Value> Field<'_, V> {
    /// The same answer, quicker to be looked at in so many points: patches on which light is no polynomial, and is gathered at
    /// every point, are cut, for on most of their parts it is one.
    pub fn for_points(mut self, count: usize) -> Self {
        let area: f64 = self.domain.faces().iter().map(|face| face.area()).sum();
        loop {
            let is_worth_it = |patch: &u32| self.tree.node(*patch).area / area * count as f64 > WORTH;
            let rough: Vec<u32> = self.cuttable().filter(is_worth_it).collect();
            if rough.is_empty() {
                return self;
            }
            self = self.cut(&rough);
        }
    }

    /// Patches that are rough, but not because something stands on them, nor stand for a curve, whose light is no polynomial.
    fn cuttable(&self) -> impl Iterator<Item = u32> + '_ {
        let is_flat = |patch: &u32| !self.domain.faces()[self.tree.node(*patch).face as usize].is_curved();
        let patches = self.space.patches.iter().copied().filter(is_flat);
        patches.filter(|&patch| self.rough[patch as usize] && !self.space.is_holed(patch))
    }

    fn cut(mut self, patches: &[u32]) -> Self {
        self.domain.cut(&mut self.tree, patches);
        self.space = Space::new(self.domain, &self.tree);
        self.direct = self.domain.direct_at_leaves(&self.tree, self.direct);
        // The old leaves go on to send what they sent: they are seen as one, for all of their parts send the same.
        inherit(&self.tree, &mut self.sent);
        inherit(&self.tree, &mut self.radiosity);
        inherit(&self.tree, &mut self.variation);
        let coarseness = Coarseness::new(&self.variation, self.tolerance, self.accuracy);
        self.looks = self.domain.looks(&self.tree, coarseness, kept(self.looks, &self.tree, patches));
        let at_nodes = |(k, &patch): (usize, &u32)| {
            let (nodes, sent) = (self.space.range(k).len(), &self.sent);
            self.looks[patch as usize][..nodes].iter().map(|links| gathered(links, sent))
        };
        self.values = self.space.patches.par_iter().enumerate().flat_map_iter(at_nodes).collect();
        self.smooth = self.space.means(&self.tree, &self.values);
        self.residuals = residuals(&self);
        self.rough = rough(&self, self.accuracy);
        self
    }
}

/// Gives parts that are new what the whole has.
fn inherit<T: Copy>(tree: &Tree, values: &mut Vec<T>) {
    let old = values.len();
    values.resize(tree.nodes.len(), values[0]);
    for (k, node) in tree.nodes.iter().enumerate() {
        node.parts
            .clone()
            .filter(|&part| part as usize >= old)
            .for_each(|part| values[part as usize] = values[k]);
    }
}
