//! B = ε e(T) + (1 − ε) H in each band: who sees whom, and whose temperature is to be found.

use super::error::ThermalError;
use super::surface::{Condition, Surface};
use super::{Bands, Exchange};
use fredholm::operator::Rows;
use fredholm::system::row_sums;
use std::collections::BTreeMap;

/// The exchange made ready: numbers per node and, band after band, per node and band.
pub(crate) struct Network<'a, F> {
    pub exchange: &'a Exchange<'a, F>,
    /// Added to F_ii: what a row misses of 1 where nothing is open, and what it has too much elsewhere.
    pub diagonal: Vec<f64>,
    /// The share of its view that a node has of the surroundings, 1 − Σ_j F_ij.
    pub share: Vec<f64>,
    /// ε.
    pub emissivity: Vec<f64>,
    /// What the surroundings send.
    pub outside: Vec<f64>,
    /// ε e(T) where T is given, else 0.
    pub emission: Vec<f64>,
    /// The body of each node whose temperature is to be found.
    pub body: Vec<Option<usize>>,
    /// The bodies.
    pub bodies: Vec<Body>,
}

/// Nodes of one temperature, which is to be found.
pub(crate) struct Body {
    pub members: Vec<usize>,
    /// Σ Q, in W.
    pub heat: f64,
}

impl<'a, F: Rows> Network<'a, F> {
    pub fn new(exchange: &'a Exchange<'a, F>) -> Result<Self, ThermalError> {
        let Exchange { surfaces, nodes, bands, surroundings, .. } = exchange;
        surfaces.iter().try_for_each(|surface| surface.check(bands))?;
        if !(*surroundings >= 0.0 && surroundings.is_finite()) {
            return Err(ThermalError::Surroundings(*surroundings));
        }
        let (share, diagonal) = exchange.shares();
        let outside = by_band(&bands.emissive_powers(*surroundings), &share);
        let emissivity: Vec<f64> = (0..bands.count())
            .flat_map(|b| nodes.iter().map(move |node| surfaces[node.surface].emissivity[b]))
            .collect();
        let (body, bodies) = exchange.bodies()?;
        let emission = emission(exchange, &emissivity);
        Ok(Self { exchange, diagonal, share, emissivity, outside, emission, body, bodies })
    }

    pub fn len(&self) -> usize {
        self.exchange.nodes.len()
    }

    pub fn bands(&self) -> &Bands {
        self.exchange.bands
    }

    pub fn area(&self, node: usize) -> f64 {
        self.exchange.nodes[node].area
    }

    pub fn surface(&self, node: usize) -> &Surface {
        &self.exchange.surfaces[self.exchange.nodes[node].surface]
    }

    /// F u + d u in each band, without what the surroundings send.
    pub fn gather(&self, u: &[f64]) -> Vec<f64> {
        let n = self.len();
        let mut gathered = vec![0.0; u.len()];
        for (out, u) in gathered.chunks_mut(n).zip(u.chunks(n)) {
            fredholm::operator::Operator::apply(self.exchange.operator, u, out);
            out.iter_mut().zip(u).zip(&self.diagonal).for_each(|((h, u), d)| *h += d * u);
        }
        gathered
    }

    /// The same of |F| + |d| for u ≥ 0: form factors are not negative.
    pub fn gather_magnitudes(&self, u: &[f64]) -> Vec<f64> {
        let mut gathered = self.gather(u);
        let excess = u.chunks(self.len()).flat_map(|u| u.iter().zip(&self.diagonal));
        gathered.iter_mut().zip(excess).for_each(|(h, (u, d))| *h += (d.abs() - d) * u);
        gathered
    }

    /// The indices of a body's nodes and bands: (place, band, area × ε).
    pub fn places<'b>(&'b self, body: &'b Body) -> impl Iterator<Item = (usize, usize, f64)> + 'b {
        let n = self.len();
        body.members.iter().flat_map(move |&k| {
            (0..self.bands().count()).map(move |b| (b * n + k, b, self.area(k) * self.emissivity[b * n + k]))
        })
    }
}

impl<F: Rows> Exchange<'_, F> {
    /// What each node sees of the surroundings, and what is to be added to F_ii.
    ///
    /// In a closed scene what a row misses is error, or the back of something that stands on the node, which neither
    /// warms nor cools it: added to F_ii it keeps reciprocity, and the heats add up to 0.
    fn shares(&self) -> (Vec<f64>, Vec<f64>) {
        let all: Vec<usize> = (0..self.nodes.len()).collect();
        let missing: Vec<f64> = row_sums(self.operator, &all).iter().map(|sum| 1.0 - sum).collect();
        let open = |missing: &f64| if self.closed { 0.0 } else { missing.max(0.0) };
        let share: Vec<f64> = missing.iter().map(open).collect();
        let diagonal = missing.iter().zip(&share).map(|(missing, share)| missing - share).collect();
        (share, diagonal)
    }

    /// The body of each node of unknown temperature. A mirror reflects what it gets, whatever its temperature: it is none.
    fn bodies(&self) -> Result<(Vec<Option<usize>>, Vec<Body>), ThermalError> {
        let (mut bodies, mut named) = (Vec::<Body>::new(), BTreeMap::new());
        let mut body_of = vec![None; self.nodes.len()];
        let mut heats: Vec<Option<f64>> = self.surfaces.iter().map(heat_of_body).collect();
        for (k, node) in self.nodes.iter().enumerate() {
            let surface = &self.surfaces[node.surface];
            let heat = match &surface.condition {
                Condition::Temperature(_) => continue,
                Condition::HeatFlux(_) if surface.is_mirror() => continue,
                Condition::HeatFlux(flux) => flux * node.area,
                Condition::Linked { .. } => heats[node.surface].take().unwrap_or(0.0),
            };
            let next = bodies.len();
            let index = match &surface.condition {
                Condition::Linked { body, .. } => *named.entry(body).or_insert(next),
                _ => next,
            };
            if index == next {
                bodies.push(Body { members: Vec::new(), heat: 0.0 });
            }
            bodies[index].members.push(k);
            bodies[index].heat += heat;
            body_of[k] = Some(index);
        }
        self.drop_mirrors(&mut body_of, bodies)
    }

    /// Bodies of which no part emits have no say in the exchange, and no heat to give.
    fn drop_mirrors(
        &self,
        body_of: &mut [Option<usize>],
        bodies: Vec<Body>,
    ) -> Result<(Vec<Option<usize>>, Vec<Body>), ThermalError> {
        let mut kept = Vec::new();
        for body in bodies {
            let surface = |k: usize| &self.surfaces[self.nodes[k].surface];
            if body.members.iter().all(|&k| surface(k).is_mirror()) {
                if body.heat != 0.0 {
                    let surface = surface(body.members[0]).name.clone();
                    return Err(ThermalError::HeatedMirror { surface, value: body.heat });
                }
                body.members.iter().for_each(|&k| body_of[k] = None);
            } else {
                body.members.iter().for_each(|&k| body_of[k] = Some(kept.len()));
                kept.push(body);
            }
        }
        Ok((body_of.to_vec(), kept))
    }
}

/// The heat of a surface's part of a body, in W.
fn heat_of_body(surface: &Surface) -> Option<f64> {
    match surface.condition {
        Condition::Linked { heat, .. } => Some(heat),
        _ => None,
    }
}

/// ε e(T) of the nodes of given temperature, band after band.
fn emission<F>(exchange: &Exchange<'_, F>, emissivity: &[f64]) -> Vec<f64> {
    let Exchange { surfaces, nodes, bands, .. } = exchange;
    let n = nodes.len();
    let powers: Vec<Option<Vec<f64>>> = surfaces
        .iter()
        .map(|surface| match surface.condition {
            Condition::Temperature(temperature) => Some(bands.emissive_powers(temperature)),
            _ => None,
        })
        .collect();
    let power = |place: usize| powers[nodes[place % n].surface].as_ref().map_or(0.0, |p| p[place / n]);
    emissivity.iter().enumerate().map(|(place, emissivity)| emissivity * power(place)).collect()
}

/// a_b c_i, band after band.
fn by_band(bands: &[f64], nodes: &[f64]) -> Vec<f64> {
    bands.iter().flat_map(|a| nodes.iter().map(move |c| a * c)).collect()
}
