//! |u − u*| ≤ w max |r|/v with v = w − P w > 0: a bound where ‖P‖∞ = 1 and the residual alone bounds nothing.
//!
//! P has no negative entries. A w > 0 with w − P w > 0, which can be checked whatever way it was found, makes I − P an
//! M-matrix: its inverse is not negative, and |r| ≤ c v gives |u − u*| ≤ c w.

use super::linear::Linear;
use fredholm::operator::Rows;
use fredholm::system::SystemError;

/// Of each node and band, and of each body, how far they can be from the exact answer of the discrete exchange.
pub(crate) struct Bounds {
    /// Of B.
    pub radiosity: Vec<f64>,
    /// Of H.
    pub irradiance: Vec<f64>,
    /// Of σT⁴.
    pub powers: Vec<f64>,
}

impl Bounds {
    /// From the residual `residual` of u, and the irradiance H of u; `None` where no w is found.
    ///
    /// With several bands it holds to first order in the change of temperatures.
    pub fn of<F: Rows>(
        linear: &Linear<'_, F>,
        u: &[f64],
        irradiance: &[f64],
        residual: &[f64],
    ) -> Result<Option<Self>, SystemError> {
        let network = linear.network;
        let w = linear.solve(&vec![1.0; u.len()], 0.1)?;
        let returned = linear.answer_to(&network.gather_magnitudes(&w));
        let v: Vec<f64> = w.iter().zip(&returned).map(|(w, p)| w - p).collect();
        if !v.iter().zip(&w).all(|(v, w)| *v > 0.25 && w.is_finite()) {
            return Ok(None);
        }
        let rounding = (network.len() + 16) as f64 * f64::EPSILON;
        let slack = slack(linear, irradiance, rounding);
        let mut worst = 0.0_f64;
        for (place, v) in v.iter().enumerate() {
            let body = network.body[place % network.len()];
            let warmed = body.map_or(0.0, |g| slack[g] * linear.slopes[g][place / network.len()]);
            // In u and in what P makes of it: both were rounded.
            let rounded = rounding * (u[place].abs() + irradiance[place].abs());
            worst = worst.max((residual[place].abs() + warmed + rounded) / v);
        }
        let radiosity: Vec<f64> = w.iter().map(|w| worst * w).collect();
        let irradiance = network.gather_magnitudes(&radiosity);
        let power = |(g, body)| {
            let absorbed: f64 =
                network.places(body).map(|(place, _, weight)| weight * irradiance[place]).sum();
            slack[g] + absorbed / linear.capacities[g]
        };
        let powers = network.bodies.iter().enumerate().map(power).collect();
        Ok(Some(Self { radiosity, irradiance, powers }))
    }
}

/// How far each body's σT⁴ is from balance with the irradiance, with the rounding of the balance.
fn slack<F: Rows>(linear: &Linear<'_, F>, irradiance: &[f64], rounding: f64) -> Vec<f64> {
    let network = linear.network;
    let of = |(g, body): (usize, &super::network::Body)| {
        let terms = network
            .places(body)
            .map(|(place, band, weight)| weight * (linear.levels[g][band].abs() + irradiance[place].abs()));
        let size = terms.fold(body.heat.abs(), |sum, term| sum + term);
        (linear.heat_missing(g, Some(irradiance)).abs() + rounding * size) / linear.capacities[g]
    };
    network.bodies.iter().enumerate().map(of).collect()
}
