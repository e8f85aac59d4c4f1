//! F(0 → λT) = (15/π⁴) ∫_z^∞ x³/(eˣ − 1) dx with z = c₂/(λT): the share of a black body's power at wavelengths below λ.

use std::f64::consts::PI;

/// σ = 2π⁵k⁴/(15h³c²), in W/(m² K⁴): CODATA 2018, exact in the SI but for the digits left out.
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// c₂ = hc/k, in µm K: CODATA 2018, exact in the SI but for the digits left out.
pub const SECOND_RADIATION: f64 = 14_387.768_775_039_34;

/// E = σT⁴ of a temperature in K, in W/m².
pub fn emissive_power(temperature: f64) -> f64 {
    STEFAN_BOLTZMANN * temperature.powi(4)
}

/// T = (E/σ)^¼ in K, of a black body that emits E, in W/m².
pub fn temperature(emissive_power: f64) -> f64 {
    (emissive_power / STEFAN_BOLTZMANN).sqrt().sqrt()
}

/// 15/π⁴.
const SCALE: f64 = 15.0 / (PI * PI * PI * PI);

/// From here on the series in e^{−z} is summed, before it the power series: at 1 the first takes 38 terms, and the
/// last term of the second is 10⁻¹⁶.
const SPLIT: f64 = 1.0;

/// The share F(0 → λT) of its power that a black body emits at wavelengths below λ, to 10⁻¹⁵; λT in µm K.
///
/// Chang and Rhee, International Communications in Heat and Mass Transfer 11 (1984): Σ_k e^{−kz} (z³/k + 3z²/k² + 6z/k³
/// + 6/k⁴) 15/π⁴. For long waves, where that is slow, 1 less the integral from 0 of the power series.
pub fn black_body_fraction(wavelength_temperature: f64) -> f64 {
    if wavelength_temperature <= 0.0 {
        return 0.0;
    }
    let z = SECOND_RADIATION / wavelength_temperature;
    if z < SPLIT { 1.0 - SCALE * from_zero(z) } else { SCALE * to_infinity(z) }
}

/// dF/d ln T = (15/π⁴) z⁴/(e^z − 1), with λT in µm K.
pub(crate) fn fraction_slope(wavelength_temperature: f64) -> f64 {
    let z = SECOND_RADIATION / wavelength_temperature;
    // Where the power is no number, e^z has long won.
    if z < 700.0 { SCALE * z.powi(4) / z.exp_m1() } else { 0.0 }
}

fn to_infinity(z: f64) -> f64 {
    let mut sum = 0.0;
    for k in 1..64 {
        let k = f64::from(k);
        let decay = (-k * z).exp();
        if decay < 1e-18 {
            break;
        }
        sum += decay * (z.powi(3) / k + 3.0 * z * z / k.powi(2) + 6.0 * z / k.powi(3) + 6.0 / k.powi(4));
    }
    sum
}

/// ∫_0^z x³/(eˣ − 1) dx = z³ (1/3 − z/8 + Σ_n B_2n z²ⁿ/((2n)! (2n + 3))).
fn from_zero(z: f64) -> f64 {
    const BERNOULLI: [f64; 9] = [
        1.0 / 6.0,
        -1.0 / 30.0,
        1.0 / 42.0,
        -1.0 / 30.0,
        5.0 / 66.0,
        -691.0 / 2730.0,
        7.0 / 6.0,
        -3617.0 / 510.0,
        43867.0 / 798.0,
    ];
    let (mut power, mut sum) = (1.0, 1.0 / 3.0 - z / 8.0);
    for (n, bernoulli) in (1..).map(|n| 2.0 * f64::from(n)).zip(BERNOULLI) {
        power *= z * z / (n * (n - 1.0));
        sum += bernoulli * power / (n + 3.0);
    }
    z.powi(3) * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use fredholm::quadrature::integrate;

    #[test]
    fn the_share_is_the_integral_of_plancks_law() {
        for z in [0.01, 0.3, 0.999_999, 1.0, 1.7, 5.0, 20.0] {
            let planck = |x: f64| SCALE * x.powi(3) / x.exp_m1();
            let tail = if z < 2.0 {
                1.0 - integrate(|x| if x > 0.0 { planck(x) } else { 0.0 }, 0.0, z).unwrap().value
            } else {
                integrate(planck, z, z + 60.0).unwrap().value
            };
            let share = black_body_fraction(SECOND_RADIATION / z);
            assert!((share - tail).abs() < 1e-13, "{z}: {share} {tail}");
        }
    }

    #[test]
    fn the_share_is_that_of_the_tables() {
        // Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, table 12.1: λT in µm K.
        let table = [(1000.0, 0.000_321), (2000.0, 0.066_728), (4000.0, 0.480_877), (10_000.0, 0.914_199)];
        for (product, share) in table {
            // Its c₂ is an older one.
            assert!((black_body_fraction(product) - share).abs() < 5e-5, "{product}");
        }
        assert_eq!((black_body_fraction(0.0), black_body_fraction(f64::INFINITY)), (0.0, 1.0));
    }

    #[test]
    fn the_slope_is_that_of_the_share() {
        for product in [800.0, 2898.0, 14_000.0, 40_000.0] {
            let step = 1e-5;
            let share = |factor: f64| black_body_fraction(product * factor);
            let slope = (share(1.0 + step) - share(1.0 - step)) / (2.0 * step);
            assert!((fraction_slope(product) - slope).abs() < 1e-8, "{product}");
        }
    }

    #[test]
    fn powers_and_temperatures_are_inverse() {
        assert!((temperature(emissive_power(300.0)) - 300.0).abs() < 1e-12);
        assert!((emissive_power(300.0) - 459.300_328).abs() < 1e-5);
    }
}
