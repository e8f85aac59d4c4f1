//! Q = ∫ q dA: the numbers of a surface from those of its nodes.

use super::planck;
use super::{Answer, Exchange, State};

/// The heat of a surface: means over its area.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceHeat {
    /// Its area, in m².
    pub area: f64,
    /// Its state; the temperature is that of the mean σT⁴.
    pub mean: State,
    /// The lowest and the highest temperature of its nodes, in K.
    pub temperatures: Option<(f64, f64)>,
    /// Q, the net heat out of it, in W.
    pub heat: f64,
    /// The bounds of the errors of the mean state.
    pub error: Option<State>,
    /// The bound of the error of Q, in W.
    pub heat_error: Option<f64>,
}

impl Answer {
    /// The heat of each surface.
    pub fn by_surface<F>(&self, exchange: &Exchange<'_, F>) -> Vec<SurfaceHeat> {
        let mut nodes = vec![Vec::new(); exchange.surfaces.len()];
        exchange.nodes.iter().enumerate().for_each(|(k, node)| nodes[node.surface].push((k, node.area)));
        nodes.iter().map(|nodes| self.surface(nodes)).collect()
    }

    fn surface(&self, nodes: &[(usize, f64)]) -> SurfaceHeat {
        let area: f64 = nodes.iter().map(|(_, area)| area).sum();
        let mean = mean(nodes, &self.nodes, area);
        let kelvins = || nodes.iter().filter_map(|(k, _)| self.nodes[*k].temperature);
        let lowest = kelvins().reduce(f64::min);
        let error = self.errors.as_ref().map(|errors| {
            // A mean is off by the mean at most; T, whose mean is another, by the worst.
            let worst = nodes.iter().filter_map(|(k, _)| errors[*k].temperature).reduce(f64::max);
            State { temperature: worst, ..mean_of(nodes, errors, area) }
        });
        SurfaceHeat {
            area,
            temperatures: lowest.zip(kelvins().reduce(f64::max)),
            heat: mean.heat_flux * area,
            heat_error: error.map(|error| error.heat_flux * area),
            mean,
            error,
        }
    }
}

/// The mean of states, with the temperature of the mean σT⁴.
fn mean(nodes: &[(usize, f64)], states: &[State], area: f64) -> State {
    let power =
        |(k, a): &(usize, f64)| states[*k].temperature.map(|kelvin| a * planck::emissive_power(kelvin));
    let powers: Option<Vec<f64>> = nodes.iter().map(power).collect();
    let temperature = match nodes {
        // No rounding to a power and back.
        [(k, _)] => states[*k].temperature,
        _ => powers.map(|powers| planck::temperature(powers.iter().sum::<f64>() / area)),
    };
    State { temperature, ..mean_of(nodes, states, area) }
}

/// The mean of all but the temperature.
fn mean_of(nodes: &[(usize, f64)], states: &[State], area: f64) -> State {
    let mean = |of: fn(&State) -> f64| nodes.iter().map(|(k, a)| a * of(&states[*k])).sum::<f64>() / area;
    State {
        temperature: None,
        radiosity: mean(|state| state.radiosity),
        irradiance: mean(|state| state.irradiance),
        heat_flux: mean(|state| state.heat_flux),
    }
}
