//! {0, …, n − 1} = τ₁ ∪ τ₂, each cut again: a tree of clusters of points that are near each other (Hackbusch 2015, §5.4).

use rayon::prelude::*;
use std::num::NonZeroU32;
use std::ops::Range;

/// The box low ≤ x ≤ high with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<const D: usize> {
    /// The least coordinates.
    pub low: [f64; D],
    /// The greatest.
    pub high: [f64; D],
}

impl<const D: usize> Bounds<D> {
    /// The box of one point.
    pub fn of_point(point: [f64; D]) -> Self {
        Self { low: point, high: point }
    }

    /// The smallest box that has both.
    pub fn union(mut self, other: &Self) -> Self {
        for d in 0..D {
            self.low[d] = self.low[d].min(other.low[d]);
            self.high[d] = self.high[d].max(other.high[d]);
        }
        self
    }

    /// The length of its diagonal.
    pub fn diameter(&self) -> f64 {
        length((0..D).map(|d| self.high[d] - self.low[d]))
    }

    /// How far apart two boxes are; 0 where they touch or overlap.
    pub fn distance(&self, other: &Self) -> f64 {
        let gap = |d: usize| (self.low[d] - other.high[d]).max(other.low[d] - self.high[d]).max(0.0);
        length((0..D).map(gap))
    }

    /// Its middle.
    pub fn centre(&self) -> [f64; D] {
        std::array::from_fn(|d| self.low[d] + 0.5 * (self.high[d] - self.low[d]))
    }

    /// The axis of the longest side, the first of equals.
    fn longest(&self) -> usize {
        let side = |d: usize| self.high[d] - self.low[d];
        (1..D).fold(0, |best, d| if side(d) > side(best) { d } else { best })
    }

    /// Whether it is a box: finite, and not turned inside out.
    fn is_sound(&self) -> bool {
        self.low.iter().zip(&self.high).all(|(l, h)| l.is_finite() && h.is_finite() && l <= h)
    }
}

fn length(vector: impl Iterator<Item = f64>) -> f64 {
    vector.map(|x| x * x).sum::<f64>().sqrt()
}

/// A cluster of a [`ClusterTree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cluster(u32);

impl Cluster {
    /// Its number, from 0 to [`ClusterTree::len`] − 1: a cluster comes before its children, which are numbered one after the other;
    /// next come all below the first, then all below the second.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A binary tree of clusters of points, or of things that have extent.
///
/// The points are put into an order in which every cluster is a range. A cluster is cut across the longest side of the box of
/// its centres, half of the points to either side: so the tree is as deep as log₂ of n over the leaf, however the points lie, and
/// points that coincide are no exception. It is the same for any number of threads, and points that ascend on a line keep their
/// order.
#[derive(Clone, Debug, PartialEq)]
pub struct ClusterTree<const D: usize> {
    order: Vec<usize>,
    nodes: Vec<Node>,
    bounds: Vec<Bounds<D>>,
}

/// What a walk reads of a cluster, apart from its box and small: walks of a million clusters wait for memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Node {
    /// Its places.
    start: u32,
    end: u32,
    /// The first child; the second is the next node: whoever reads of one reads of the other, mostly. `None` for a leaf.
    child: Option<NonZeroU32>,
}

/// A point that is nowhere.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ClusterError {
    /// A coordinate is infinite or NaN, or the low end of a box is above its high end.
    #[error(
        "point {index} has the box from {low} to {high} along axis {axis}: both must be finite, in this order"
    )]
    NoBox {
        /// Which point.
        index: usize,
        /// Which coordinate, from 0.
        axis: usize,
        /// The low end.
        low: f64,
        /// The high end.
        high: f64,
    },
}

/// Clusters of fewer points are cut by one thread: a microsecond's work for every ten points.
const ALONE: usize = 4096;

impl<const D: usize> ClusterTree<D> {
    /// Clusters of points, down to leaves of at most `leaf` of them (at least 1).
    ///
    /// # Errors
    ///
    /// [`ClusterError`] where a coordinate is not finite.
    pub fn new(points: &[[f64; D]], leaf: usize) -> Result<Self, ClusterError> {
        let boxes: Vec<_> = points.iter().map(|point| Bounds::of_point(*point)).collect();
        Self::of_boxes(&boxes, leaf)
    }

    /// Clusters of things that have extent, as elements and patches do: cut by their centres, bounded by their boxes.
    ///
    /// # Errors
    ///
    /// [`ClusterError`] where a box is not finite, or inside out.
    pub fn of_boxes(boxes: &[Bounds<D>], leaf: usize) -> Result<Self, ClusterError> {
        if let Some(index) = boxes.iter().position(|bounds| !bounds.is_sound()) {
            return Err(no_box(index, &boxes[index]));
        }
        let leaf = leaf.max(1);
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        let clusters = if boxes.is_empty() { 0 } else { 1 + below(boxes.len(), leaf) };
        let mut nodes = vec![Node::default(); clusters];
        let mut bounds = vec![Bounds::of_point([0.0; D]); clusters];
        if let (Some((root, nodes)), Some((whole, bounds))) =
            (nodes.split_first_mut(), bounds.split_first_mut())
        {
            let centres: Vec<_> = boxes.iter().map(Bounds::centre).collect();
            let cutting = Cutting { boxes, centres: &centres, leaf };
            cutting.cut((0, 1), &mut order, (root, whole), (nodes, bounds));
        }
        Ok(Self { order, nodes, bounds })
    }

    /// How many clusters there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no cluster, since there is no point.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The cluster of all points; `None` if there are none.
    pub fn root(&self) -> Option<Cluster> {
        (!self.is_empty()).then_some(Cluster(0))
    }

    /// The points in the order in which clusters are ranges: `order()[k]` is the number of the point at place k.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// The places of a cluster's points in [`Self::order`].
    pub fn range(&self, cluster: Cluster) -> Range<usize> {
        let Node { start, end, .. } = self.nodes[cluster.index()];
        start as usize..end as usize
    }

    /// The numbers of a cluster's points.
    pub fn members(&self, cluster: Cluster) -> &[usize] {
        &self.order[self.range(cluster)]
    }

    /// The box of a cluster's points, with their extent.
    pub fn bounds(&self, cluster: Cluster) -> &Bounds<D> {
        &self.bounds[cluster.index()]
    }

    /// The two parts of a cluster; `None` for a leaf.
    pub fn children(&self, cluster: Cluster) -> Option<[Cluster; 2]> {
        self.nodes[cluster.index()].child.map(|first| [0, 1].map(|k| Cluster(first.get() + k)))
    }

    /// All clusters, parents before their children.
    pub fn top_down(&self) -> impl DoubleEndedIterator<Item = Cluster> + ExactSizeIterator + use<D> {
        (0..self.len()).map(|k| Cluster(k as u32))
    }

    /// All clusters, children before their parents: the way in which sums over clusters are made.
    pub fn bottom_up(&self) -> impl DoubleEndedIterator<Item = Cluster> + ExactSizeIterator + use<D> {
        self.top_down().rev()
    }

    /// The clusters that are not cut, in the order of their ranges: a second child, which has no fewer points, is no leaf unless the first is.
    pub fn leaves(&self) -> impl Iterator<Item = Cluster> + '_ {
        self.top_down().filter(|cluster| self.nodes[cluster.index()].child.is_none())
    }
}

fn no_box<const D: usize>(index: usize, bounds: &Bounds<D>) -> ClusterError {
    let sound = |d: &usize| Bounds { low: [bounds.low[*d]], high: [bounds.high[*d]] }.is_sound();
    let axis = (0..D).find(|d| !sound(d)).unwrap_or(0);
    ClusterError::NoBox { index, axis, low: bounds.low[axis], high: bounds.high[axis] }
}

/// How many clusters are below one of n points: their halves are known before they are cut.
fn below(n: usize, leaf: usize) -> usize {
    if n <= leaf { 0 } else { 2 + below(n / 2, leaf) + below(n - n / 2, leaf) }
}

struct Cutting<'a, const D: usize> {
    boxes: &'a [Bounds<D>],
    centres: &'a [[f64; D]],
    leaf: usize,
}

impl<const D: usize> Cutting<'_, D> {
    /// Cuts the points `order`, which begin at place `first`, of a node and its box, into those below, the first of which is number
    /// `number`.
    fn cut(
        &self,
        (first, number): (usize, usize),
        order: &mut [usize],
        (node, whole): (&mut Node, &mut Bounds<D>),
        (nodes, bounds): (&mut [Node], &mut [Bounds<D>]),
    ) {
        let n = order.len();
        let [start, end] = [first, first + n].map(|place| place as u32);
        *node = Node { start, end, child: None };
        let (Some(([one, other], nodes)), Some(([left, right], bounds))) =
            (nodes.split_first_chunk_mut(), bounds.split_first_chunk_mut())
        else {
            order.sort_unstable();
            *whole = union(order.iter().map(|i| self.boxes[*i]));
            return;
        };
        node.child = NonZeroU32::new(number as u32);
        self.halve(order);
        let half = n / 2;
        let size = below(half, self.leaf);
        let (some, others) = order.split_at_mut(half);
        let ((nodes, next_nodes), (bounds, next_bounds)) =
            (nodes.split_at_mut(size), bounds.split_at_mut(size));
        let number = number + 2;
        let mut cut_one = || self.cut((first, number), some, (one, left), (nodes, bounds));
        let mut cut_other = || {
            let place = (first + half, number + size);
            self.cut(place, others, (other, right), (next_nodes, next_bounds));
        };
        if n < ALONE {
            (cut_one(), cut_other())
        } else {
            rayon::join(cut_one, cut_other)
        };
        *whole = left.union(right);
    }

    /// Brings the half that comes first along the longest side to the front; of equals the one with the lesser number.
    fn halve(&self, order: &mut [usize]) {
        let centres = |i: &usize| Bounds::of_point(self.centres[*i]);
        let axis = match order.len() < ALONE {
            true => union(order.iter().map(centres)).longest(),
            // A union is the same in any order.
            false => (order.par_chunks(ALONE).map(|part| union(part.iter().map(centres))))
                .reduce_with(|one, other| one.union(&other))
                .map_or(0, |bounds| bounds.longest()),
        };
        let key = |i: usize| self.centres[i][axis];
        order.select_nth_unstable_by(order.len() / 2, |i, j| key(*i).total_cmp(&key(*j)).then(i.cmp(j)));
    }
}

/// The smallest box that has all of at least one.
fn union<const D: usize>(boxes: impl Iterator<Item = Bounds<D>>) -> Bounds<D> {
    let nothing = Bounds { low: [f64::INFINITY; D], high: [f64::NEG_INFINITY; D] };
    boxes.fold(nothing, |all, bounds| all.union(&bounds))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a spiral that is flattened, in no order.
    fn spiral(n: usize) -> Vec<[f64; 3]> {
        let point = |k: usize| {
            let t = (k * 7919 % n) as f64 / n as f64;
            [4.0 * t * (20.0 * t).cos(), 4.0 * t * (20.0 * t).sin(), 0.1 * t]
        };
        (0..n).map(point).collect()
    }

    #[test]
    fn every_point_is_in_one_leaf_and_every_cluster_is_its_children() {
        for (n, leaf) in [(1, 1), (2, 1), (1000, 1), (1001, 32), (20_000, 7), (5, 64), (3, 0)] {
            let points = spiral(n);
            let tree = ClusterTree::new(&points, leaf).unwrap();
            let mut sorted = tree.order().to_vec();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..n));
            assert_eq!(tree.range(tree.root().unwrap()), 0..n);
            let mut next = 0;
            for leaf_cluster in tree.leaves() {
                let range = tree.range(leaf_cluster);
                assert!(range.start == next && range.len() <= leaf.max(1));
                next = range.end;
            }
            assert_eq!(next, n);
            for cluster in tree.top_down() {
                let inside = |i: &usize| tree.bounds(cluster).distance(&Bounds::of_point(points[*i])) == 0.0;
                assert!(tree.members(cluster).iter().all(inside));
                if let Some([one, other]) = tree.children(cluster) {
                    assert!(one > cluster && other.index() == one.index() + 1 && other.index() < tree.len());
                    let (all, first, second) = (tree.range(cluster), tree.range(one), tree.range(other));
                    assert_eq!((all.start, first.end, all.end), (first.start, second.start, second.end));
                    assert!(second.len() - first.len() <= 1);
                    assert_eq!(*tree.bounds(cluster), tree.bounds(one).union(tree.bounds(other)));
                }
            }
        }
    }

    #[test]
    fn no_points_no_cluster() {
        let tree = ClusterTree::<2>::new(&[], 8).unwrap();
        assert!(tree.is_empty() && tree.root().is_none() && tree.leaves().next().is_none());
    }

    #[test]
    fn halves_lie_on_either_side_of_the_longest_one() {
        let points = spiral(4000);
        let tree = ClusterTree::new(&points, 4).unwrap();
        for cluster in tree.top_down() {
            let Some(parts) = tree.children(cluster) else { continue };
            let axis = tree.bounds(cluster).longest();
            let [one, other] = parts.map(|part| tree.bounds(part));
            assert!(one.high[axis] <= other.low[axis], "{one:?} {other:?}");
        }
    }

    #[test]
    fn what_has_extent_is_bounded_with_it() {
        let boxes: Vec<_> = (0..64)
            .map(|k| Bounds { low: [f64::from(k) - 0.75, -f64::from(k)], high: [f64::from(k) + 0.75, 0.0] })
            .collect();
        let tree = ClusterTree::of_boxes(&boxes, 8).unwrap();
        for cluster in tree.bottom_up() {
            let range = tree.range(cluster);
            let (low, high) = (range.start as f64 - 0.75, range.end as f64 - 0.25);
            assert_eq!((tree.bounds(cluster).low[0], tree.bounds(cluster).high[0]), (low, high));
        }
    }

    #[test]
    fn points_that_ascend_keep_their_order_and_points_that_coincide_are_cut() {
        let line: Vec<[f64; 1]> = (0..10_000).map(|k| [f64::from(k).sqrt()]).collect();
        let tree = ClusterTree::new(&line, 30).unwrap();
        assert!(tree.order().iter().copied().eq(0..10_000));
        let one_place = ClusterTree::new(&[[1.0, 2.0]; 10_000], 30).unwrap();
        assert!(one_place.leaves().all(|leaf| one_place.range(leaf).len() <= 30));
        assert!(one_place.order().iter().copied().eq(0..10_000));
    }

    #[test]
    fn the_same_tree_for_any_number_of_threads() {
        let points = spiral(30_000);
        let trees = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| ClusterTree::new(&points, 10).unwrap())
        });
        assert!(trees[0] == trees[1] && trees[0] == trees[2]);
    }

    #[test]
    fn boxes_know_their_diameter_and_distance() {
        let (one, other) =
            (Bounds { low: [0.0, 0.0], high: [3.0, 4.0] }, Bounds { low: [6.0, 8.0], high: [7.0, 9.0] });
        assert_eq!((one.diameter(), one.distance(&other), other.distance(&one)), (5.0, 5.0, 5.0));
        assert_eq!(one.distance(&Bounds { low: [2.0, -1.0], high: [5.0, 1.0] }), 0.0);
    }

    #[test]
    fn a_point_that_is_nowhere_is_told_with_its_place() {
        let told = ClusterTree::new(&[[0.0, 1.0], [2.0, f64::NAN]], 8).unwrap_err();
        assert!(matches!(told, ClusterError::NoBox { index: 1, axis: 1, .. }), "{told}");
        let inside_out = Bounds { low: [1.0], high: [0.0] };
        let told = ClusterTree::of_boxes(&[inside_out], 8).unwrap_err();
        assert_eq!(told, ClusterError::NoBox { index: 0, axis: 0, low: 1.0, high: 0.0 });
    }
}
