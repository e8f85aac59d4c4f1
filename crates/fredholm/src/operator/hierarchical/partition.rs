//! {1, …, n}² = ∪ τ × σ with min(diam τ, diam σ) ≤ η dist(τ, σ), or small (Hackbusch 2015, §5.5; Bebendorf 2008, §1.3).

use super::cluster::{Cluster, ClusterTree};

/// A block τ × σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) rows: Cluster,
    pub(super) columns: Cluster,
    /// Whether the clusters are far enough apart for a smooth kernel to be of low rank there.
    pub(super) far: bool,
}

/// The coarsest blocks that are far, or both of whose clusters are leaves.
pub(super) fn partition<const D: usize>(tree: &ClusterTree<D>, eta: f64) -> Vec<Pair> {
    let mut pairs = Vec::new();
    if let Some(root) = tree.root() {
        divide(tree, eta, (root, root), &mut pairs);
    }
    pairs
}

fn divide<const D: usize>(
    tree: &ClusterTree<D>,
    eta: f64,
    (rows, columns): (Cluster, Cluster),
    pairs: &mut Vec<Pair>,
) {
    let (one, other) = (tree.bounds(rows), tree.bounds(columns));
    let distance = one.distance(other);
    let far = distance > 0.0 && one.diameter().min(other.diameter()) <= eta * distance;
    match parts(tree, rows, columns) {
        Some(parts) if !far => parts.into_iter().for_each(|part| divide(tree, eta, part, pairs)),
        _ => pairs.push(Pair { rows, columns, far }),
    }
}

/// The parts of a block: those of the clusters that have parts. `None` where neither has.
pub(super) fn parts<const D: usize>(
    tree: &ClusterTree<D>,
    rows: Cluster,
    columns: Cluster,
) -> Option<Vec<(Cluster, Cluster)>> {
    let of = |cluster| tree.children(cluster).map_or(vec![cluster], |children| children.to_vec());
    let (above, beside) = (of(rows), of(columns));
    let parts = above.iter().flat_map(|one| beside.iter().map(|other| (*one, *other))).collect();
    (above.len() + beside.len() > 2).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_the_matrix_once_and_the_far_ones_are_apart() {
        let points: Vec<[f64; 2]> =
            (0..700).map(|k| [f64::from(k * 37 % 700) / 700.0, f64::from(k * k % 701) / 900.0]).collect();
        let tree = ClusterTree::new(&points, 20).unwrap();
        for eta in [0.5, 1.0, 3.0] {
            let mut covered = vec![0_u8; 700 * 700];
            for pair in partition(&tree, eta) {
                let (one, other) = (tree.bounds(pair.rows), tree.bounds(pair.columns));
                let apart = one.diameter().min(other.diameter()) <= eta * one.distance(other);
                assert!(pair.far == (apart && one.distance(other) > 0.0));
                assert!(
                    pair.far || tree.children(pair.rows).is_none() && tree.children(pair.columns).is_none()
                );
                for i in tree.range(pair.rows) {
                    tree.range(pair.columns).for_each(|j| covered[i * 700 + j] += 1);
                }
            }
            assert!(covered.iter().all(|times| *times == 1));
        }
    }

    #[test]
    fn on_a_line_the_number_of_blocks_grows_like_n() {
        let blocks = |n: u32| {
            let points: Vec<_> = (0..n).map(|k| [f64::from(k)]).collect();
            partition(&ClusterTree::new(&points, 32).unwrap(), 1.0).len() as f64
        };
        assert!((blocks(1 << 16) / blocks(1 << 15) - 2.0).abs() < 0.01);
    }

    #[test]
    fn points_that_coincide_are_never_far() {
        let tree = ClusterTree::new(&[[0.5]; 100], 10).unwrap();
        assert!(partition(&tree, 1.0).iter().all(|pair| !pair.far));
    }
}
