//! x_i = (i/n, {i/φ}): points that fill the unit square evenly, for any number of them.

use glam::DVec3;

/// A rotation of the lattice on its torus, so that neighbouring pixels make different errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    s: f64,
    t: f64,
}

impl Rotation {
    /// The rotation that leaves every point.
    pub const NONE: Self = Self { s: 0.0, t: 0.0 };

    /// The rotation of the `index`-th pixel: the same on every run, whatever thread asks.
    pub fn of(index: usize) -> Self {
        let bits = scramble(index as u64);
        Self { s: unit(bits >> 32), t: unit(bits & 0xffff_ffff) }
    }

    /// The rotation of a point: another one beside it.
    pub fn at(point: DVec3) -> Self {
        Self::of(point.to_array().iter().fold(0, |bits, c| bits ^ c.to_bits() as usize))
    }

    /// The rotation where the `index`-th ray from here ends.
    pub fn next(self, index: usize) -> Self {
        let along = (index + 1) as f64;
        Self { s: (self.s + along * GOLDEN).fract(), t: (self.t + along * PLASTIC).fract() }
    }
}

/// Rays that are spread over something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays {
    /// How many.
    pub count: usize,
    /// Of the lattice that spreads them.
    pub rotation: Rotation,
}

impl Rays {
    /// So many that the light of a sky is right to some thousandths of that of all of it.
    pub const MANY: usize = 256;

    /// Many from a point.
    pub fn from(point: DVec3) -> Self {
        Self::turned(Rotation::at(point))
    }

    /// The same, of a rotation.
    pub fn turned(rotation: Rotation) -> Self {
        Self { count: Self::MANY, rotation }
    }
}

/// The finaliser of SplitMix64: every bit of the index changes half of the bits.
fn scramble(index: u64) -> u64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 32 bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    bits as f64 / 4_294_967_296.0
}

/// The golden section's fractional part: the multiples of no other number are spread more evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// 1/ρ of the plastic number ρ, ρ³ = ρ + 1.
const PLASTIC_ROOT: f64 = 0.754_877_666_246_692_7;

/// 1/ρ² of the plastic number ρ: multiples that do not follow those of the golden section.
const PLASTIC: f64 = 0.569_840_290_998_053_2;

/// `count` points of [0,1)².
pub(crate) fn lattice(count: usize, rotation: Rotation) -> impl Iterator<Item = (f64, f64)> {
    (0..count).map(move |i| {
        let (s, t) = ((i as f64 + 0.5) / count as f64, i as f64 * GOLDEN);
        ((s + rotation.s).fract(), (t + rotation.t).fract())
    })
}

/// The k-th of points of [0,1)² that fill it evenly however many there are: multiples of the powers of the plastic number's inverse.
pub(crate) fn scattered(k: usize) -> (f64, f64) {
    let k = k as f64 + 0.5;
    ((k * PLASTIC_ROOT).fract(), (k * PLASTIC).fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_integrates_smooth_functions_whatever_its_rotation() {
        for index in 0..50 {
            let mean = lattice(64, Rotation::of(index)).map(|(s, t)| s * s + s * t).sum::<f64>() / 64.0;
            assert!((mean - (1.0 / 3.0 + 0.25)).abs() < 0.02, "{mean}");
        }
    }

    #[test]
    fn rotations_fill_the_square() {
        let cells: std::collections::BTreeSet<_> =
            (0..400).map(Rotation::of).map(|r| ((r.s * 8.0) as u32, (r.t * 8.0) as u32)).collect();
        assert!(cells.len() > 55 && cells.iter().all(|&(s, t)| s < 8 && t < 8), "{}", cells.len());
    }
}
