//! u = f + P u with P = (1 − ε) F + ε e′ ⊗ (A ε F)/Σ A ε e′: the exchange, linear about temperatures, which are eliminated.
//!
//! A body's balance Σ A ε (e + e′ δ − H) = Q gives its δ, the change of σT⁴, from the irradiance H of its nodes. Of a grey
//! node alone that is B = Q/A + H, or u = f + ρFu with f = q and ρ = 1.

use super::network::{Body, Network};
use super::planck;
use fredholm::direct;
use fredholm::discretize::Coupling;
use fredholm::krylov::Gmres;
use fredholm::operator::{Dense, Matrix, Operator, Rows};
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::system::{System, SystemError};

/// The exchange about the temperatures of its bodies.
pub(crate) struct Linear<'a, F> {
    pub network: &'a Network<'a, F>,
    /// σT⁴ of each body.
    pub powers: Vec<f64>,
    /// e_b of each body.
    pub levels: Vec<Vec<f64>>,
    /// e_b′ = de_b/d(σT⁴) of each body.
    pub slopes: Vec<Vec<f64>>,
    /// Σ A ε e′ of each body, in m².
    pub capacities: Vec<f64>,
}

impl<'a, F: Rows> Linear<'a, F> {
    /// About these σT⁴.
    pub fn about(network: &'a Network<'a, F>, powers: Vec<f64>) -> Self {
        let temperatures: Vec<f64> = powers.iter().map(|power| planck::temperature(*power)).collect();
        let bands = network.bands();
        let levels = match bands.is_grey() {
            true => powers.iter().map(|power| vec![*power]).collect(),
            false => temperatures.iter().map(|t| bands.emissive_powers(*t)).collect(),
        };
        let slope = |t: &f64| bands.slopes(*t).into_iter().map(|slope| slope.max(FLATTEST)).collect();
        let slopes = temperatures.iter().map(slope).collect();
        Self::with(network, powers, levels, slopes)
    }

    /// About nothing, as if each band had the share of the power that it has at a temperature.
    pub fn at_shares_of(network: &'a Network<'a, F>, temperature: f64) -> Self {
        let (count, bands) = (network.bodies.len(), network.bands());
        let power = planck::emissive_power(temperature).max(f64::MIN_POSITIVE);
        let share = |e: &f64| (e / power).max(FLATTEST);
        let shares: Vec<f64> = bands.emissive_powers(temperature).iter().map(share).collect();
        Self::with(network, vec![0.0; count], vec![vec![0.0; bands.count()]; count], vec![shares; count])
    }

    fn with(
        network: &'a Network<'a, F>,
        powers: Vec<f64>,
        levels: Vec<Vec<f64>>,
        slopes: Vec<Vec<f64>>,
    ) -> Self {
        let capacity = |(body, slopes): (&Body, &Vec<f64>)| {
            network.places(body).map(|(_, band, weight)| weight * slopes[band]).sum()
        };
        let capacities = network.bodies.iter().zip(&slopes).map(capacity).collect();
        Self { network, powers, levels, slopes, capacities }
    }

    /// f.
    pub fn source(&self) -> Vec<f64> {
        let network = self.network;
        let mut source = self.answer_to(&network.outside);
        source.iter_mut().zip(&network.emission).for_each(|(f, e)| *f += e);
        for (g, body) in network.bodies.iter().enumerate() {
            let change = self.heat_missing(g, None) / self.capacities[g];
            for (place, band, _) in network.places(body) {
                source[place] +=
                    network.emissivity[place] * (self.levels[g][band] + self.slopes[g][band] * change);
            }
        }
        source
    }

    /// Q − Σ A ε (e − H) of a body, in W: what it gets and does not send. Without an H, of a body that gets nothing.
    pub fn heat_missing(&self, g: usize, irradiance: Option<&[f64]>) -> f64 {
        let body = &self.network.bodies[g];
        let received = |place: usize| irradiance.map_or(0.0, |irradiance| irradiance[place]);
        let places = self.network.places(body);
        places.fold(body.heat, |heat, (place, band, weight)| {
            heat - weight * (self.levels[g][band] - received(place))
        })
    }

    /// What nodes send because of an irradiance: reflected, and emitted by the bodies that it warms.
    pub fn answer_to(&self, irradiance: &[f64]) -> Vec<f64> {
        let network = self.network;
        let reflected =
            irradiance.iter().zip(&network.emissivity).map(|(h, emissivity)| (1.0 - emissivity) * h);
        let mut answer: Vec<f64> = reflected.collect();
        for (g, body) in network.bodies.iter().enumerate() {
            let absorbed: f64 =
                network.places(body).map(|(place, _, weight)| weight * irradiance[place]).sum();
            let change = absorbed / self.capacities[g];
            for (place, band, _) in network.places(body) {
                answer[place] += network.emissivity[place] * self.slopes[g][band] * change;
            }
        }
        answer
    }

    /// u with u = `source` + P u, by LU where that is small, else until the residual is `tolerance`.
    pub fn solve(&self, source: &[f64], tolerance: f64) -> Result<Vec<f64>, SystemError> {
        let ones = vec![1.0; source.len()];
        if source.len() <= FACTORED {
            let table = Table::of(self);
            // Nothing in it was ever infinite, or the system is refused.
            let Ok(matrix) = Dense::<f64>::assemble(&table, |_| ()) else {
                return Err(SystemError::NotFinite { what: "coefficient", index: 0 });
            };
            return Ok(direct::solve(System::new(source, &ones, &matrix)?));
        }
        let mut gmres = Gmres::new(System::new(source, &ones, self)?);
        relax(&mut gmres, Stop { residual: tolerance, sweeps: SWEEPS }, |_, _, _| true);
        Ok(gmres.solution())
    }
}

/// A body that emits nothing in its bands as cold as it is would be taken to any temperature by a step of Newton's. The
/// answer does not depend on it: 10⁻⁶ costs a step now and then, 10⁻¹² does not stop what it is to stop.
const FLATTEST: f64 = 1e-9;

/// Up to so many unknowns are solved for by LU: in a tenth of a second; a row of shields makes GMRES restart.
const FACTORED: usize = 400;

/// The most steps of GMRES. Scenes need 10 to 50.
const SWEEPS: usize = 2000;

impl<F: Rows> Matrix for Linear<'_, F> {
    fn dim(&self) -> usize {
        self.network.emissivity.len()
    }

    fn diagonal(&self, place: usize) -> f64 {
        let (network, n) = (self.network, self.network.len());
        let (node, band) = (place % n, place / n);
        let seen = |k: usize| {
            let own = if k == node { network.diagonal[k] } else { 0.0 };
            own + network.exchange.operator.row(k, &mut Vec::new()).get(node)
        };
        let emissivity = network.emissivity[place];
        let warmed = network.body[node].map_or(0.0, |g| {
            let weights = network.bodies[g]
                .members
                .iter()
                .map(|&k| network.area(k) * network.emissivity[band * n + k] * seen(k));
            emissivity * self.slopes[g][band] * weights.sum::<f64>() / self.capacities[g]
        });
        (1.0 - emissivity) * seen(node) + warmed
    }
}

impl<F: Rows> Operator<f64> for Linear<'_, F> {
    fn apply(&self, u: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.answer_to(&self.network.gather(u)));
    }
}

/// P, column by column.
struct Table {
    dim: usize,
    columns: Vec<f64>,
}

impl Table {
    fn of<F: Rows>(linear: &Linear<'_, F>) -> Self {
        let dim = linear.dim();
        let (mut columns, mut unit) = (vec![0.0; dim * dim], vec![0.0; dim]);
        for (j, column) in columns.chunks_mut(dim.max(1)).enumerate() {
            unit[j] = 1.0;
            linear.apply(&unit, column);
            unit[j] = 0.0;
        }
        Self { dim, columns }
    }
}

impl Coupling for Table {
    fn dim(&self) -> usize {
        self.dim
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self.columns[j * self.dim + i]
    }
}
