//! The exchange of two faces: the sum over the polygons that they are made of.

use super::faces::Face;
use radiosity::form_factor::pairs::Pairs;
use radiosity::polygon::Polygon;
use radiosity::view_factors::Exchange;
use serde::Serialize;

/// How many pairs of polygons that face each other are how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// In full sight.
    pub clear: u64,
    /// Out of sight.
    pub hidden: u64,
    /// Neither, or not proved to be.
    pub partly: u64,
}

/// The pairs asked for so far.
pub fn counts(pairs: &Pairs<'_>) -> Counts {
    let radiosity::form_factor::pairs::Counts { clear, hidden, partly } = pairs.counts();
    Counts { clear, hidden, partly }
}

/// The exchange of two faces, or of a face with itself.
pub fn between(pairs: &Pairs<'_>, faces: &[Face], polygons: &[Polygon], i: usize, j: usize) -> Exchange {
    // A mask has the factor 1 to what it masks, and 0 to all else.
    for (mask, other) in [(i, j), (j, i)] {
        if let Some(base) = faces[mask].masks {
            let value = if base == other { faces[mask].own_area(polygons) } else { 0.0 };
            return Exchange { value, error: 0.0 };
        }
    }
    let (a, b) = (&faces[i].polygons, &faces[j].polygons);
    let mut sum = Exchange::default();
    for (k, &p) in a.iter().enumerate() {
        // With itself each pair comes once, and counts in both directions.
        let (others, times) = if i == j { (&b[k + 1..], 2.0) } else { (&b[..], 1.0) };
        for &q in others {
            let exchange = pairs.exchange(p, q);
            sum.value += times * exchange.value;
            sum.error += times * exchange.error;
        }
    }
    sum
}
