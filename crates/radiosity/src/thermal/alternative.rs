//! Fredholm's alternative for heat: where no temperature is given, I − P is singular.
//!
//! P takes 1 to 1 on nodes that nothing anchors: neither a given temperature, nor surroundings, nor exchange with what has
//! them. There the heats must add up to 0, and the answer is one up to a constant.

use super::error::ThermalError;
use super::network::Network;
use fredholm::operator::Rows;

/// Refuses an exchange that has no answer, or more than one.
pub(crate) fn check<F: Rows>(network: &Network<'_, F>) -> Result<(), ThermalError> {
    let anchored = Anchored::of(network);
    let Some(place) = anchored.places.iter().position(|anchored| !anchored) else { return Ok(()) };
    let n = network.len();
    let surface = network.surface(place % n).name.clone();
    let loose = |body: &&super::network::Body| {
        network.places(body).any(|(place, _, weight)| weight > 0.0 && !anchored.places[place])
    };
    let heats = || network.bodies.iter().filter(loose).map(|body| body.heat);
    let (excess, size) = (heats().sum::<f64>(), heats().map(f64::abs).sum::<f64>());
    // Heats as people type them balance to a few digits more than are typed.
    if excess.abs() > 1e-9 * size {
        return Err(ThermalError::NoSolution { surface, excess });
    }
    Err(ThermalError::NotUnique { surface })
}

/// The places that a temperature given somewhere reaches, found by going from there to all that see it.
struct Anchored<'a, F> {
    network: &'a Network<'a, F>,
    places: Vec<bool>,
    waiting: Vec<usize>,
}

impl<'a, F: Rows> Anchored<'a, F> {
    fn of(network: &'a Network<'a, F>) -> Self {
        let count = network.emissivity.len();
        let mut anchored = Self { network, places: vec![false; count], waiting: Vec::new() };
        let n = network.len();
        for place in 0..count {
            let node = place % n;
            let is_given = network.body[node].is_none() && network.emissivity[place] > 0.0;
            if is_given || network.share[node] > 0.0 {
                anchored.reach(place);
            }
        }
        let mut buffer = Vec::new();
        while let Some(place) = anchored.waiting.pop() {
            let (node, first) = (place % n, place - place % n);
            // By reciprocity whom a node sees, he sees it.
            let row = network.exchange.operator.row(node, &mut buffer);
            row.iter().enumerate().filter(|(_, f)| *f > 0.0).for_each(|(k, _)| anchored.reach(first + k));
        }
        anchored
    }

    /// Marks a place, and with it its body where that absorbs.
    fn reach(&mut self, place: usize) {
        if std::mem::replace(&mut self.places[place], true) {
            return;
        }
        self.waiting.push(place);
        let network = self.network;
        if network.emissivity[place] > 0.0
            && let Some(body) = network.body[place % network.len()]
        {
            for (other, _, weight) in network.places(&network.bodies[body]) {
                if weight > 0.0 && !std::mem::replace(&mut self.places[other], true) {
                    self.waiting.push(other);
                }
            }
        }
    }
}
