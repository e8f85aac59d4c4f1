//! Newton's method on the temperatures: one step where surfaces are grey, since B is linear in σT⁴ then.

use super::bound::Bounds;
use super::error::ThermalError;
use super::linear::Linear;
use super::network::Network;
use super::surface::Condition;
use super::{Answer, Balance, Exchange, Node, State, alternative, planck};
use fredholm::operator::Rows;
use fredholm::value::max_norm;

/// How well to solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The residual to reach, relative to the largest B.
    pub tolerance: f64,
    /// The most steps of Newton's method, which only several bands need.
    pub steps: usize,
}

impl Default for Options {
    /// 10⁻¹², which two or three steps beyond the first digit reach; 100 steps.
    fn default() -> Self {
        Self { tolerance: 1e-12, steps: 100 }
    }
}

impl<F: Rows> Exchange<'_, F> {
    /// Solves for the temperatures and heats that are not given.
    ///
    /// # Errors
    ///
    /// What is given is impossible, or does not make an answer, or not just one: see [`ThermalError`].
    pub fn solve(&self, options: &Options) -> Result<Answer, ThermalError> {
        let network = Network::new(self)?;
        alternative::check(&network)?;
        let mut run = Run { network: &network, options, start: start(&network, options)? };
        let (step, steps) = run.newton()?;
        let bounds = Bounds::of(&step.linear, &step.u, &step.irradiance, &step.residual)?;
        Ok(answer(&network, &step, steps, options, bounds.as_ref()))
    }
}

struct Run<'a, F> {
    network: &'a Network<'a, F>,
    options: &'a Options,
    start: Vec<f64>,
}

/// A step of Newton's method, judged by the equation itself.
struct Step<'a, F> {
    /// About the temperatures that it found.
    linear: Linear<'a, F>,
    u: Vec<f64>,
    irradiance: Vec<f64>,
    /// ε e(T) + (1 − ε) H.
    radiosity: Vec<f64>,
    residual: Vec<f64>,
}

impl<F> Step<'_, F> {
    fn error(&self) -> f64 {
        max_norm(&self.residual) / max_norm(&self.radiosity).max(f64::MIN_POSITIVE)
    }
}

impl<'a, F: Rows> Run<'a, F> {
    fn newton(&mut self) -> Result<(Step<'a, F>, usize), ThermalError> {
        let is_linear = self.network.bands().is_grey() || self.network.bodies.is_empty();
        let mut best: Option<Step<'a, F>> = None;
        for k in 1..=self.options.steps.max(1) {
            let step = self.step()?;
            let last = best.as_ref().map_or(f64::INFINITY, Step::error);
            // Below 10⁻¹⁰ rounding decides which of two steps is the better one.
            let stalled = step.error() >= last && last < 1e-10;
            let error = step.error();
            self.start.clone_from(&step.linear.powers);
            best = Some(step);
            if is_linear || stalled || error <= self.options.tolerance {
                return best.map(|step| (step, k)).ok_or(ThermalError::Unsolved);
            }
        }
        best.map(|step| (step, self.options.steps)).ok_or(ThermalError::Unsolved)
    }

    fn step(&self) -> Result<Step<'a, F>, ThermalError> {
        let network = self.network;
        let linear = Linear::about(network, self.start.clone());
        let (u, irradiance) = field(&linear, self.options)?;
        let powers = powers(&linear, &irradiance)?;
        let linear = Linear::about(network, powers);
        let emitted = emitted(&linear);
        let sent = emitted.iter().zip(&network.emissivity).zip(&irradiance);
        let radiosity: Vec<f64> = sent.map(|((e, emissivity), h)| e + (1.0 - emissivity) * h).collect();
        let residual = radiosity.iter().zip(&u).map(|(b, u)| b - u).collect();
        Ok(Step { linear, u, irradiance, radiosity, residual })
    }
}

/// u and its irradiance, that of the surroundings included.
fn field<F: Rows>(linear: &Linear<'_, F>, options: &Options) -> Result<(Vec<f64>, Vec<f64>), ThermalError> {
    let source = linear.source();
    let u = linear.solve(&source, 0.1 * options.tolerance * max_norm(&source))?;
    let mut irradiance = linear.network.gather(&u);
    irradiance.iter_mut().zip(&linear.network.outside).for_each(|(h, outside)| *h += outside);
    Ok((u, irradiance))
}

/// A step changes σT⁴ by this factor at most where there are several bands: each has its own law, and a step may fall
/// below 0, from where there is no way back.
const STRIDE: f64 = 10.0;

/// Below this part of the largest σT⁴ a negative one is rounding.
const NOTHING: f64 = 1e-12;

/// σT⁴ of each body after a step.
fn powers<F: Rows>(linear: &Linear<'_, F>, irradiance: &[f64]) -> Result<Vec<f64>, ThermalError> {
    let network = linear.network;
    let found: Vec<f64> = (0..linear.powers.len())
        .map(|g| linear.powers[g] + linear.heat_missing(g, Some(irradiance)) / linear.capacities[g])
        .collect();
    if !network.bands().is_grey() {
        let within =
            |(new, old): (&f64, &f64)| if *old > 0.0 { new.clamp(old / STRIDE, old * STRIDE) } else { *new };
        return Ok(found.iter().zip(&linear.powers).map(within).map(|power| power.max(0.0)).collect());
    }
    let least = -NOTHING * max_norm(&found).max(max_norm(irradiance));
    match found.iter().position(|power| *power < least) {
        Some(g) => {
            let surface = network.surface(network.bodies[g].members[0]).name.clone();
            Err(ThermalError::TooCold { surface, power: found[g] })
        }
        None => Ok(found.into_iter().map(|power| power.max(0.0)).collect()),
    }
}

/// σT⁴ to begin with: 0 if surfaces are grey, else as if the shares of the bands stayed as they are about where the given
/// temperatures lie.
fn start<F: Rows>(network: &Network<'_, F>, options: &Options) -> Result<Vec<f64>, ThermalError> {
    if network.bands().is_grey() {
        return Ok(vec![0.0; network.bodies.len()]);
    }
    let middle = middle_power(network).max(f64::MIN_POSITIVE);
    let linear = Linear::at_shares_of(network, planck::temperature(middle));
    let (_, irradiance) = field(&linear, options)?;
    let power = |g: usize| linear.heat_missing(g, Some(&irradiance)) / linear.capacities[g];
    // What comes out too cold has to climb, and steps are bounded.
    Ok((0..network.bodies.len()).map(|g| power(g).max(1e-3 * middle)).collect())
}

/// The largest σT⁴ that is given, or of which the given heats speak.
fn middle_power<F: Rows>(network: &Network<'_, F>) -> f64 {
    let given = network.exchange.surfaces.iter().map(|surface| match surface.condition {
        Condition::Temperature(temperature) => planck::emissive_power(temperature),
        _ => 0.0,
    });
    let heated = network.bodies.iter().map(|body| {
        let area: f64 = body.members.iter().map(|&k| network.area(k)).sum();
        body.heat.abs() / area
    });
    given.chain(heated).fold(planck::emissive_power(network.exchange.surroundings), f64::max)
}

/// ε e(T) of all nodes, band after band.
fn emitted<F: Rows>(linear: &Linear<'_, F>) -> Vec<f64> {
    let network = linear.network;
    let mut emitted = network.emission.clone();
    for (body, levels) in network.bodies.iter().zip(&linear.levels) {
        network
            .places(body)
            .for_each(|(place, band, _)| emitted[place] = network.emissivity[place] * levels[band]);
    }
    emitted
}

fn answer<F: Rows>(
    network: &Network<'_, F>,
    step: &Step<'_, F>,
    steps: usize,
    options: &Options,
    bounds: Option<&Bounds>,
) -> Answer {
    let reader = Reader { network, step, emitted: emitted(&step.linear), bounds };
    let nodes: Vec<State> = (0..network.len()).map(|k| reader.state(k)).collect();
    let errors = bounds.map(|_| (0..network.len()).map(|k| reader.error(k, &nodes[k])).collect());
    Answer {
        balance: balance(network, &nodes),
        steps,
        residual: max_norm(&step.residual),
        largest: max_norm(&step.radiosity),
        converged: step.error() <= options.tolerance.max(ROUNDING),
        nodes,
        errors,
    }
}

/// No residual is asked to be less than this part of the largest B, whatever the tolerance.
const ROUNDING: f64 = 1e-13;

/// Reads what is known of a node, all bands together.
struct Reader<'a, F> {
    network: &'a Network<'a, F>,
    step: &'a Step<'a, F>,
    emitted: Vec<f64>,
    bounds: Option<&'a Bounds>,
}

impl<F: Rows> Reader<'_, F> {
    /// Σ over the bands of what is known of a node.
    fn total(&self, k: usize, of: impl Fn(usize) -> f64) -> f64 {
        let n = self.network.len();
        (0..self.network.bands().count()).map(|band| of(band * n + k)).sum()
    }

    fn state(&self, k: usize) -> State {
        let Step { irradiance, radiosity, linear, .. } = self.step;
        let emissivity = &self.network.emissivity;
        State {
            temperature: match (&self.network.surface(k).condition, self.network.body[k]) {
                (Condition::Temperature(temperature), _) => Some(*temperature),
                (_, body) => body.map(|g| planck::temperature(linear.powers[g])),
            },
            radiosity: self.total(k, |place| radiosity[place]),
            irradiance: self.total(k, |place| irradiance[place]),
            heat_flux: self.total(k, |place| self.emitted[place] - emissivity[place] * irradiance[place]),
        }
    }

    /// How far the state of a node can be off.
    fn error(&self, k: usize, state: &State) -> State {
        let Some(bounds) = self.bounds else { return *state };
        let (network, linear) = (self.network, &self.step.linear);
        let power = network.body[k].map_or(0.0, |g| bounds.powers[g]);
        let slope = |place: usize| network.body[k].map_or(0.0, |g| linear.slopes[g][place / network.len()]);
        let emissivity = &network.emissivity;
        let warmed = |place: usize| slope(place) * power + bounds.irradiance[place];
        let heat_flux = match network.surface(k).condition {
            Condition::HeatFlux(flux) => (state.heat_flux - flux).abs(),
            _ => self.total(k, |place| emissivity[place] * warmed(place)),
        };
        State {
            temperature: state.temperature.map(|t| temperature_error(t, power)),
            radiosity: self.total(k, |place| bounds.radiosity[place]),
            irradiance: self.total(k, |place| bounds.irradiance[place]),
            heat_flux: heat_flux + 8.0 * f64::EPSILON * (state.radiosity + state.irradiance),
        }
    }
}

/// How far T can be off when σT⁴ is off by `power`.
fn temperature_error(temperature: f64, power: f64) -> f64 {
    let level = planck::emissive_power(temperature);
    let (above, below) = (planck::temperature(level + power), planck::temperature((level - power).max(0.0)));
    if power > 0.0 { (above - temperature).max(temperature - below) } else { 0.0 }
}

fn balance<F: Rows>(network: &Network<'_, F>, nodes: &[State]) -> Balance {
    let surroundings = planck::emissive_power(network.exchange.surroundings);
    let mut balance = Balance { heat: 0.0, to_surroundings: 0.0, exchanged: 0.0 };
    for ((state, Node { area, .. }), share) in nodes.iter().zip(network.exchange.nodes).zip(&network.share) {
        balance.heat += area * state.heat_flux;
        balance.exchanged += 0.5 * area * state.heat_flux.abs();
        balance.to_surroundings += area * share * (state.radiosity - surroundings);
    }
    balance.exchanged += 0.5 * balance.to_surroundings.abs();
    balance
}
