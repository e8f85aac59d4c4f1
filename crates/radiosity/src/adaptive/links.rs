//! (F u)_i = Σ_links F(x_i, P) · mean of u over P: collocation at the nodes of patches, in which what is far away, or much
//! alike, is one part, and what is near is seen down to the leaves.

use super::space::Space;
use super::tree::{Node, Tree};
use crate::form_factor::exchange::FromAfar;
use crate::form_factor::outlook::Outlook;
use crate::form_factor::view::{Kept, Seen, View};
use fredholm::operator::{Matrix, Operator};
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// A part of the scene and how much of the light at a point comes from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub node: u32,
    pub factor: f32,
}

/// When a part is seen as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coarseness<'a> {
    /// How far the radiosity on a part is from its mean, of each node, in W/m².
    pub variation: &'a [f64],
    /// The irradiance that a link may be wrong by, in W/m².
    pub tolerance: f64,
    /// The diameter over the distance up to which a part that nothing hides is taken by some points of it.
    pub nearness: f64,
}

impl<'a> Coarseness<'a> {
    /// For links that may be wrong by `tolerance`, in W/m², in a field of some accuracy.
    pub fn new(variation: &'a [f64], tolerance: f64, accuracy: f64) -> Self {
        Self { variation, tolerance, nearness: FromAfar::nearness(NODES * accuracy) }
    }
}

/// Most points have fewer links: a list that grows is copied.
const ROOM: usize = 4096;

/// What the nodes that a part is taken by may be wrong by, as part of the accuracy. Seven nodes take an eighth of the time of
/// Lambert's formula.
const NODES: f64 = 0.01;

/// The way from the faces down to the parts that a point of a face sees as one.
pub(super) struct Descent<'a> {
    pub tree: &'a Tree,
    pub outlook: &'a Outlook,
    pub coarseness: Coarseness<'a>,
    pub point: DVec3,
    pub normal: DVec3,
}

impl Descent<'_> {
    /// The links of the point.
    pub fn links(&self, view: &mut View) -> Vec<Link> {
        let mut links = Vec::with_capacity(ROOM);
        view.go(self.outlook, self.point);
        for (face, hiders) in &self.outlook.seen {
            let polygon = &self.tree.node(*face).polygon;
            if polygon.height_of(self.point) > 0.0
                && let Seen::Behind(kept) = view.enter(polygon, hiders)
            {
                self.descend(*face, &kept, view, &mut links);
                view.leave(&kept);
            }
        }
        links.shrink_to_fit();
        links
    }

    /// The same from links that were found for another field: further down where that is needed now.
    pub fn further(&self, known: Vec<Link>, view: &mut View) -> Vec<Link> {
        let ends = |link: &Link| self.tree.is_leaf(link.node) || self.is_one(link.node);
        if known.iter().all(ends) {
            return known;
        }
        view.go(self.outlook, self.point);
        let mut links = Vec::with_capacity(ROOM.max(2 * known.len()));
        for link in known {
            let part = self.tree.node(link.node);
            if ends(&link) {
                links.push(link);
            } else if let Some(hiders) = self.outlook.hiders_of(part.face)
                && let Seen::Behind(kept) = view.enter(&part.polygon, hiders)
            {
                self.descend(link.node, &kept, view, &mut links);
                view.leave(&kept);
            }
        }
        links
    }

    fn descend(&self, node: u32, hiders: &Kept, view: &mut View, links: &mut Vec<Link>) {
        let whole = self.tree.node(node);
        if self.tree.is_leaf(node) || self.is_one(node) {
            let factor = if hiders.is_empty() && self.is_far(whole) {
                whole.from_afar.factor(self.point, self.normal)
            } else {
                view.factor(self.outlook, &whole.polygon, hiders)
            };
            if factor > 0.0 {
                links.push(Link { node, factor: factor as f32 });
            }
            return;
        }
        for part in whole.parts.clone() {
            if let Seen::Behind(kept) = view.enter_further(&self.tree.node(part).polygon, hiders) {
                self.descend(part, &kept, view, links);
                view.leave(&kept);
            }
        }
    }

    /// Whether a part is so far away, and all of it so high above the horizon, that some points of it will do.
    fn is_far(&self, part: &Node) -> bool {
        let away = part.polygon.centroid() - self.point;
        part.diameter < self.coarseness.nearness * away.length() && away.dot(self.normal) > part.diameter
    }

    /// Whether what is on it may be taken for its mean.
    fn is_one(&self, node: u32) -> bool {
        let variation = self.coarseness.variation[node as usize];
        let part = self.tree.node(node);
        let away = part.polygon.centroid() - self.point;
        let distance = away.length();
        let near = part.diameter / distance;
        // Nearer than its size its factor may be all there is.
        let factor = if near > 1.0 {
            1.0
        } else {
            part.area * away.dot(self.normal).abs() * away.dot(part.polygon.normal()).abs()
                / (PI * distance.powi(4))
        };
        factor * variation * near.min(1.0) <= self.coarseness.tolerance
    }
}

/// What the points of a patch see: its nodes, then its checks.
pub(super) type Looks = Vec<Vec<Link>>;

/// The links of all nodes of the space as an operator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Links<'a> {
    pub tree: &'a Tree,
    pub space: &'a Space,
    /// What each patch of the tree sees.
    pub looks: &'a [Looks],
}

impl Links<'_> {
    /// What arrives at every node of the space, of what is given for every node of the tree.
    pub fn gathered<V: Value>(&self, means: &[V]) -> Vec<V> {
        let Self { space, looks, .. } = self;
        let of_patch = |(k, &patch): (usize, &u32)| {
            let nodes = looks[patch as usize].iter().take(space.range(k).len());
            nodes.map(|links| gathered(links, means))
        };
        space.patches.par_iter().enumerate().flat_map_iter(of_patch).collect()
    }
}

/// Σ_links F u.
pub(super) fn gathered<V: Value>(links: &[Link], means: &[V]) -> V {
    links.iter().fold(V::splat(0.0), |sum, link| sum + means[link.node as usize] * f64::from(link.factor))
}

impl Matrix for Links<'_> {
    fn dim(&self) -> usize {
        self.space.dim()
    }

    /// A planar patch does not see itself.
    fn diagonal(&self, _: usize) -> f64 {
        0.0
    }
}

impl<V: Value> Operator<V> for Links<'_> {
    fn apply(&self, u: &[V], out: &mut [V]) {
        out.copy_from_slice(&self.gathered(&self.space.means(self.tree, u)));
    }
}
