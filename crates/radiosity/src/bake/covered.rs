//! Under what stands on a face it is dark, and nobody sees it: texels there take what those beside them have. A filter that mixed
//! in the dark would draw a seam along every foot.

use fredholm::value::Value;
use std::collections::HashMap;

/// A texel, and the radiosity and the irradiance there; none where something stands.
pub(super) type Texel<V> = (usize, Option<[V; 2]>);

/// Gives each covered texel of a face the mean of its neighbours that have light, from the rim inwards. `width` is that of the
/// atlas; a face that is covered as a whole is dark.
pub(super) fn uncovered<V: Value>(texels: Vec<Texel<V>>, width: usize) -> Vec<(usize, [V; 2])> {
    let dark = [V::splat(0.0); 2];
    let all: Vec<usize> = texels.iter().map(|(texel, _)| *texel).collect();
    let mut covered: Vec<usize> =
        texels.iter().filter_map(|(texel, light)| light.is_none().then_some(*texel)).collect();
    let mut lit: HashMap<usize, [V; 2]> =
        texels.into_iter().filter_map(|(texel, light)| light.map(|light| (texel, light))).collect();
    loop {
        let found: Vec<_> =
            covered.iter().filter_map(|&texel| Some((texel, around(texel, width, &lit)?))).collect();
        if found.is_empty() {
            return all.iter().map(|texel| (*texel, *lit.get(texel).unwrap_or(&dark))).collect();
        }
        lit.extend(found);
        covered.retain(|texel| !lit.contains_key(texel));
    }
}

/// The mean light of the neighbours that have some.
fn around<V: Value>(texel: usize, width: usize, lit: &HashMap<usize, [V; 2]>) -> Option<[V; 2]> {
    // Faces have margins, so that what is one row further is no neighbour's.
    let rows = [texel.checked_sub(width), Some(texel), Some(texel + width)];
    let near = rows.into_iter().flatten().flat_map(|middle| middle.saturating_sub(1)..=middle + 1);
    let near: Vec<&[V; 2]> = near.filter_map(|texel| lit.get(&texel)).collect();
    let share = 1.0 / near.len().max(1) as f64;
    let mean = |k: usize| near.iter().fold(V::splat(0.0), |sum, light| sum + light[k] * share);
    (!near.is_empty()).then(|| [mean(0), mean(1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_goes_in_from_the_rim_and_a_covered_face_stays_dark() {
        let light = |b: f64| Some([b, 2.0 * b]);
        // Two rows of three in an atlas four wide: only the first column is seen.
        let texels = vec![(5, light(1.0)), (6, None), (7, None), (9, light(3.0)), (10, None), (11, None)];
        let all = uncovered(texels, 4);
        assert_eq!(all[0], (5, [1.0, 2.0]));
        assert!(all[1..3].iter().chain(&all[4..]).all(|(_, light)| *light == [2.0, 4.0]), "{all:?}");
        assert_eq!(uncovered(vec![(0, None::<[f64; 2]>)], 4), [(0, [0.0; 2])]);
    }
}
