//! 𝓕 = ε (I − F ρ)⁻¹ F ε: Hottel's script F, the part of what i would send out if it were black that j absorbs, straight or
//! after any number of diffuse reflections (Hottel and Sarofim, *Radiative Transfer*, 1967, p. 84).
//!
//! With N = (I − ρF)⁻¹ the exchanges are A 𝓕 = ε A F N ε, which is symmetric; an error δ of A F makes one of ε Nᵀ δ N ε, to
//! first order, and N has no entry below 0: bounds go through it as they are. In an enclosure row i sums to ε_i.

use super::{Exchange, Storage, ViewFactors};
use fredholm::direct::Resolvent;

impl ViewFactors {
    /// The bytes that [`with_reflections`](Self::with_reflections) takes at most beside these.
    pub fn reflections_bytes(faces: usize) -> u64 {
        // The matrix, its factors and its inverse; two products; the new factors.
        5 * (faces * faces * size_of::<f64>()) as u64 + Self::bytes(faces, Storage::Double)
    }

    /// Hottel's script F between grey, diffuse faces of these emittances, each in (0, 1]: where all are 1 the factors
    /// themselves. A face sees itself in the others, so that the diagonal is not 0.
    ///
    /// The errors are those of the factors, carried through the reflections to first order.
    pub fn with_reflections(&self, emittances: &[f64]) -> Self {
        assert_eq!(emittances.len(), self.len(), "an emittance for each face");
        let reflectances: Vec<f64> = emittances.iter().map(|emittance| 1.0 - emittance).collect();
        let resolvent = Resolvent::new(&reflectances, |i, j| self.factor(i, j));
        let exchanges = resolvent.after(|i, j| self.exchange(i, j).value);
        let errors = resolvent.between(|i, j| self.exchange(i, j).error);
        let entry = |i: usize, j: usize| {
            let both = emittances[i] * emittances[j];
            // Symmetric but for rounding.
            let value = 0.5 * (exchanges.at(i, j) + exchanges.at(j, i));
            Exchange { value: both * value, error: both * errors.at(i, j) }
        };
        Self::assemble(self.names().to_vec(), self.areas().to_vec(), Storage::Double, entry, |_| ())
    }
}
