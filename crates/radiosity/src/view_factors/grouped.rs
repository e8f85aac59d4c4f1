//! Faces taken together: A_a F_ab = Σ_{i ∈ a} Σ_{j ∈ b} A_i F_ij.

use super::packed::{entries, index};
use super::{Exchange, Storage, ViewFactors};

impl ViewFactors {
    /// The bytes that [`grouped`](Self::grouped) takes at most, with so many groups.
    pub fn grouped_bytes(groups: usize) -> u64 {
        let sums = entries(groups) as u64 * size_of::<Exchange>() as u64;
        sums + Self::bytes(groups, Storage::Double)
    }

    /// The factors between groups of faces: `group_of[i]` is the number of face i's group among `names`.
    ///
    /// A group that is not convex sees itself, so the diagonal is not 0. Errors are added up, as bounds are. The numbers
    /// are kept in `f64`.
    ///
    /// # Panics
    ///
    /// When there is not a group for each face, a name for each group, and a face in each.
    pub fn grouped(&self, group_of: &[usize], names: Vec<String>) -> Self {
        assert_eq!(group_of.len(), self.len(), "a group for each face");
        let k = names.len();
        let mut areas = vec![0.0; k];
        for (&group, area) in group_of.iter().zip(&self.areas) {
            areas[group] += area;
        }
        assert!(areas.iter().all(|area| *area > 0.0), "a face in each group");
        let mut sums = vec![Exchange::default(); entries(k)];
        self.for_each(|i, j, exchange| {
            // Within a group both directions count, but a face and itself only once.
            let times = if i != j && group_of[i] == group_of[j] { 2.0 } else { 1.0 };
            let sum = &mut sums[index(k, group_of[i], group_of[j])];
            sum.value += times * exchange.value;
            sum.error += times * exchange.error;
        });
        let pair = |a: usize, b: usize| sums[index(k, a, b)];
        Self::assemble(names, areas, Storage::Double, pair, |_| ())
    }
}
