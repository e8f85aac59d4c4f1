//! Chapter 4: each rule is exact to its order *and not beyond*, with the constants of the textbooks, for n in the thousands.

#![expect(clippy::unwrap_used, reason = "a test may panic")]
#![expect(clippy::excessive_precision, reason = "exact values are given to twenty digits")]

use fredholm::quadrature::*;
use std::f64::consts::PI;

fn order(rule: &Quadrature<f64>, most: usize) -> usize {
    Peano::new(rule, -1.0, 1.0, most).unwrap().order()
}

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!((value / exact - 1.0).abs() <= tolerance, "{value:e} instead of {exact:e}");
}

#[test]
fn newton_cotes_has_the_order_of_theorem_4_2_and_no_more() {
    for rank in 1..=20 {
        assert_eq!(order(&newton_cotes(rank, -1.0, 1.0).unwrap(), 30), rank + (rank + 1) % 2, "rank {rank}");
        assert_eq!(
            order(&newton_cotes_open(rank, -1.0, 1.0).unwrap(), 30),
            rank - (rank + 1) % 2,
            "open {rank}"
        );
    }
}

#[test]
fn newton_cotes_weights_are_the_rational_ones() {
    let check = |rule: Quadrature<f64>, weights: &[f64], unit: f64| {
        rule.weights.iter().zip(weights).for_each(|(w, exact)| close(*w, exact / unit, 4e-15));
        assert_eq!(rule.weights.len(), weights.len());
    };
    check(newton_cotes(4, 0.0, 4.0).unwrap(), &[14.0, 64.0, 24.0, 64.0, 14.0], 45.0);
    let eight = [989.0, 5888.0, -928.0, 10496.0, -4540.0, 10496.0, -928.0, 5888.0, 989.0];
    check(newton_cotes(8, 0.0, 8.0).unwrap(), &eight.map(|w| 4.0 * w), 14175.0);
    check(newton_cotes_open(3, 0.0, 4.0).unwrap(), &[8.0, -4.0, 8.0], 3.0);
}

#[test]
fn high_ranks_are_right_to_rounding_and_too_high_ones_refused() {
    // The middle weight on an interval of length 1, from exact rational arithmetic.
    close(newton_cotes(30, 0.0, 1.0).unwrap().weights[15], NC30, 1e-13);
    close(newton_cotes(64, 0.0, 1.0).unwrap().weights[32], NC64, 1e-13);
    for rule in [newton_cotes(0, 0.0, 1.0), newton_cotes(65, 0.0, 1.0), newton_cotes_open(0, 0.0, 1.0)] {
        assert!(matches!(rule, Err(QuadratureError::Size { .. })));
    }
}
const NC30: f64 = 29470.693784626674442;
const NC64: f64 = -60277400046281.39542;

#[test]
fn error_constants_are_those_of_the_textbooks() {
    // E(f) = C (b − a)^{N+2} f^{(N+1)}, on [0, 1].
    let constant = |rule: Quadrature<f64>| Peano::new(&rule, 0.0, 1.0, 20).unwrap().constant();
    close(constant(midpoint(0.0, 1.0, 1).unwrap()), 1.0 / 24.0, 1e-14);
    close(constant(trapezoid(0.0, 1.0, 1).unwrap()), -1.0 / 12.0, 1e-14);
    close(constant(simpson(0.0, 1.0, 1).unwrap()), -1.0 / 2880.0, 1e-13);
    close(constant(boole(0.0, 1.0, 1).unwrap()), -1.0 / 1_935_360.0, 1e-12);
    // Composite: m panels divide it by m^{N+1}.
    close(constant(simpson(0.0, 1.0, 10).unwrap()), -1.0 / 2880.0 * 1e-4, 1e-9);
    // Gauss: (b − a)^{2n+1} (n!)⁴ / ((2n + 1) ((2n)!)³).
    close(constant(gauss_legendre(2, 0.0, 1.0)), 1.0 / 4320.0, 1e-13);
    close(constant(gauss_legendre(3, 0.0, 1.0)), 1.0 / 2_016_000.0, 1e-12);
}

#[test]
fn peanos_kernel_represents_the_error() {
    // (4.6) with f = eˣ, for every degree that the rule's order allows.
    let rule = simpson(0.0, 1.0, 1).unwrap();
    let peano = Peano::new(&rule, 0.0, 1.0, 10).unwrap();
    let error = 1_f64.exp() - 1.0 - rule.integrate(|x| x.exp());
    let panels = gauss_legendre(20, 0.0, 1.0).composite(0.0, 1.0, 2).unwrap();
    for (degree, factorial) in [1.0, 1.0, 2.0, 6.0].into_iter().enumerate() {
        let by_kernel = panels.integrate(|t| peano.of_degree(degree, *t) * t.exp()) / factorial;
        close(by_kernel, error, 1e-10);
    }
    // The trapezoidal rule's is −t(1 − t)/2, Simpson's of order 3 has one sign, its kernel of degree 1 two.
    let rule = trapezoid(0.0, 1.0, 1).unwrap();
    close(Peano::new(&rule, 0.0, 1.0, 10).unwrap().at(0.3), -0.5 * 0.3 * 0.7, 1e-14);
    close(peano.bound().unwrap(), 1.0 / 2880.0, 1e-9);
}

#[test]
fn a_kernel_with_two_signs_has_a_bound_above_its_constant() {
    // K_1(t) = (1 − t)²/2 − ⅚ (0.6 − t)₊ is negative at 0.1 and positive at 0.5.
    let rule = Quadrature { nodes: vec![0.0, 0.6], weights: vec![1.0 / 6.0, 5.0 / 6.0] };
    let peano = Peano::new(&rule, 0.0, 1.0, 10).unwrap();
    assert_eq!(peano.order(), 1);
    let fine = midpoint(0.0, 1.0, 200_000).unwrap();
    close(peano.bound().unwrap(), fine.integrate(|t| peano.at(*t).abs()), 1e-8);
    close(peano.constant(), fine.integrate(|t| peano.at(*t)), 1e-8);
    assert!(peano.bound().unwrap() > 1.01 * peano.constant().abs());
}

#[test]
fn a_rule_that_does_not_integrate_constants_has_no_order() {
    let rule = Quadrature { nodes: vec![0.0], weights: vec![1.0] };
    assert!(matches!(Peano::new(&rule, -1.0, 1.0, 5), Err(QuadratureError::Order { .. })));
}

#[test]
fn composite_rules_converge_at_their_rate() {
    let exact = 1_f64.exp() - 1.0;
    let error = |rule: Quadrature<f64>| (rule.integrate(|x| x.exp()) - exact).abs();
    let rate = |rule: &dyn Fn(usize) -> Quadrature<f64>| (error(rule(4)) / error(rule(8))).log2();
    assert!((rate(&|m| midpoint(0.0, 1.0, m).unwrap()) - 2.0).abs() < 0.01);
    assert!((rate(&|m| trapezoid(0.0, 1.0, m).unwrap()) - 2.0).abs() < 0.01);
    assert!((rate(&|m| simpson(0.0, 1.0, m).unwrap()) - 4.0).abs() < 0.01);
    assert!((rate(&|m| boole(0.0, 1.0, m).unwrap()) - 6.0).abs() < 0.02);
    assert_eq!(simpson(0.0, 1.0, 8).unwrap().nodes.len(), 17);
}

#[test]
fn the_periodic_trapezoid_is_exact_below_its_frequency() {
    let rule = periodic_trapezoid(12, 0.0, 2.0 * PI);
    for k in 1..12 {
        assert!(rule.integrate(|x| (f64::from(k) * x).cos()).abs() < 1e-14);
    }
    close(rule.integrate(|x| (12.0 * x).cos()), 2.0 * PI, 1e-14);
    // ∫₀^{2π} e^{cos x} dx = 2π I₀(1).
    close(
        periodic_trapezoid(16, 0.0, 2.0 * PI).integrate(|x| x.cos().exp()),
        2.0 * PI * 1.266_065_877_752_008_4,
        1e-15,
    );
}

#[test]
fn gauss_rules_have_order_2n_minus_1_for_their_weight_and_no_more() {
    for n in [1, 2, 3, 10, 49, 50, 51, 200] {
        let degree = 2 * n + 3;
        let check = |recurrence: Recurrence, rule: Quadrature<f64>, name: &str, most: usize| {
            for rule in [&rule, &recurrence_of(&recurrence, n).gauss()] {
                match recurrence.order(rule) {
                    // Where E(p_2n) = ‖p_n‖²/‖p_2n‖ is rounding, that the rule is no better cannot be seen.
                    Some(order) if n <= most => assert_eq!(order, 2 * n - 1, "{name} {n}"),
                    order => assert!(
                        n > most && order.is_none_or(|order| order >= 2 * n - 1),
                        "{name} {n}: {order:?}"
                    ),
                }
                assert!(rule.nodes.windows(2).all(|x| x[0] < x[1]), "{name} {n} ascends");
            }
        };
        let exactly = |recurrence, rule, name| check(recurrence, rule, name, usize::MAX);
        exactly(Recurrence::legendre(degree), gauss_legendre(n, -1.0, 1.0), "Legendre");
        exactly(Recurrence::chebyshev_1(degree), gauss_chebyshev_1(n, -1.0, 1.0), "Chebyshev 1");
        exactly(Recurrence::chebyshev_2(degree), gauss_chebyshev_2(n, -1.0, 1.0), "Chebyshev 2");
        check(Recurrence::hermite(degree), gauss_hermite(n), "Hermite", 30);
        for (alpha, beta) in [(0.0, 1.0), (-0.5, -0.5), (-0.5, 2.5), (7.0, 7.0)] {
            let rule = gauss_jacobi(n, alpha, beta, -1.0, 1.0).unwrap();
            exactly(Recurrence::jacobi(degree, alpha, beta), rule, "Jacobi");
        }
        for alpha in [0.0, -0.9, 2.5] {
            check(Recurrence::laguerre(degree, alpha), gauss_laguerre(n, alpha).unwrap(), "Laguerre", 10);
        }
    }
}

#[test]
fn legendres_series_and_recurrence_meet() {
    for n in [45, 49, 50, 51, 60, 99, 100] {
        let (rule, other) = (gauss_legendre(n, -1.0, 1.0), Recurrence::legendre(n).gauss());
        for k in 0..n {
            assert!((rule.nodes[k] - other.nodes[k]).abs() < 5e-16, "{n}: node {k}");
            close(rule.weights[k], other.weights[k], 2e-13);
        }
    }
}

#[test]
fn strong_singularities_keep_their_digits() {
    // ∫₀¹ x^{k−0.9} (1 − x)² dx.
    let rule = gauss_jacobi(1000, 2.0, -0.9, 0.0, 1.0).unwrap();
    for k in [0.0, 1.0, 20.0] {
        let exact = 1.0 / (k + 0.1) - 2.0 / (k + 1.1) + 1.0 / (k + 2.1);
        close(rule.integrate(|x| x.powf(k)), exact, 1e-13);
    }
    // The same as seen from 1, where x itself cannot say how near it is.
    let mirrored = gauss_jacobi(1000, -0.9, 2.0, 0.0, 1.0).unwrap();
    close(mirrored.weights[999], rule.weights[0], 1e-13);
}

/// The first n steps of a recurrence.
fn recurrence_of(recurrence: &Recurrence, n: usize) -> Recurrence {
    let (diagonal, beside) = (recurrence.diagonal[..n].to_vec(), recurrence.beside[..n].to_vec());
    Recurrence { diagonal, beside, mass: recurrence.mass }
}

#[test]
fn radau_lobatto_and_clenshaw_curtis_have_their_orders() {
    for n in [2, 3, 4, 5, 12, 33] {
        assert_eq!(order(&gauss_radau(n, -1.0, 1.0).unwrap(), 2 * n + 2), 2 * n - 2, "Radau {n}");
        assert_eq!(order(&gauss_lobatto(n, -1.0, 1.0).unwrap(), 2 * n + 2), 2 * n - 3, "Lobatto {n}");
        // Interpolation in n symmetric points: n − 1, and one more when that is even.
        assert_eq!(
            order(&clenshaw_curtis(n, -1.0, 1.0).unwrap(), 2 * n + 2),
            n - 1 + n % 2,
            "Clenshaw–Curtis {n}"
        );
        assert_eq!(order(&fejer(n, -1.0, 1.0), 2 * n + 2), n - 1 + n % 2, "Fejér {n}");
    }
    let lobatto = gauss_lobatto(4, -1.0, 1.0).unwrap();
    close(lobatto.nodes[2], 0.2_f64.sqrt(), 1e-15);
    close(lobatto.weights[1], 5.0 / 6.0, 1e-15);
    assert_eq!(
        (gauss_radau(3, 2.0, 5.0).unwrap().nodes[0], lobatto.nodes[0], lobatto.nodes[3]),
        (2.0, -1.0, 1.0)
    );
    assert!(gauss_lobatto(1, 0.0, 1.0).is_err() && gauss_radau(0, 0.0, 1.0).is_err());
}

/// Nodes and weights by Newton's method in 60 digits.
#[test]
fn thousands_of_nodes_are_right_to_rounding() {
    let node = |rule: &Quadrature<f64>, k: usize, node: f64, weight: f64| {
        assert!((rule.nodes[k] - node).abs() <= 2e-15 * node.abs(), "node {k}: {:e}", rule.nodes[k]);
        close(rule.weights[k], weight, 2e-14);
    };
    let rule = gauss_legendre(5000, 0.0, 2.0);
    node(&rule, 0, 1.1564058737035035366e-7, 2.967710852408797379e-7);
    node(&rule, 1, 6.093033161984832412e-7, 6.9082648257059715749e-7);
    node(&rule, 100, 0.0020025763082466795295, 0.000039740003165793135767);
    node(&rule, 1234, 0.28609606701186948056, 0.0004399320659079796624);
    let rule = gauss_hermite(1001);
    node(&rule, 300, -14.285533608290205725, 1.7392357970343203221e-90);
    node(&rule, 500, 0.0, 0.070195516023720963085);
    node(&rule, 501, 0.07019554480409038263, 0.069850570291386668348);
    node(&rule, 700, 14.285533608290205725, 1.7392357970343203221e-90);
    let rule = gauss_laguerre(1000, 0.5).unwrap();
    node(&rule, 0, 0.0024655523655863967504, 0.00024424779706109275188);
    node(&rule, 10, 0.29833918665208792456, 0.02198601347331779302);
    node(&rule, 300, 227.71623598350135546, 2.9593363492842344091e-98);
    let rule = gauss_jacobi(1000, -0.5, 0.25, -1.0, 1.0).unwrap();
    node(&rule, 0, -0.99999613623265247671, 2.7083430256139822838e-7);
    node(&rule, 1, -0.99998257186369736154, 8.4489958008159425654e-7);
    node(&rule, 400, -0.30685076778176451173, 0.0023856518946142906155);
    node(&rule, 999, 0.99999876722451610149, 0.0052815248631017012795);
}

#[test]
fn thousands_of_nodes_integrate_what_they_should() {
    for n in [2000, 5000] {
        let rule = gauss_legendre(n, -1.0, 1.0);
        close(rule.weights.iter().sum(), 2.0, 1e-14);
        assert_eq!(Recurrence::legendre(2 * n + 2).order(&rule), Some(2 * n - 1));
        assert!(
            (0..n).all(
                |k| rule.nodes[k] == -rule.nodes[n - 1 - k] && rule.weights[k] == rule.weights[n - 1 - k]
            )
        );
        assert!(rule.nodes.windows(2).all(|x| x[0] < x[1]));
    }
    let hermite = gauss_hermite(2000);
    close(hermite.integrate(|x| x.powi(20)), 654_729_075.0 / 1024.0 * PI.sqrt(), 1e-13);
    close(hermite.integrate(|x| x.cos()), PI.sqrt() * (-0.25_f64).exp(), 1e-13);
    let laguerre = gauss_laguerre(2000, 0.0).unwrap();
    close(laguerre.integrate(|x| x.sin()), 0.5, 1e-13);
    assert!(laguerre.weights.iter().chain(&hermite.weights).all(|w| w.is_finite() && *w >= 0.0));
    let jacobi = gauss_jacobi(2000, -0.5, 0.25, 0.0, 1.0).unwrap();
    close(jacobi.weights.iter().sum(), BETA0, 1e-13);
    close(jacobi.integrate(|x| x.powi(10)), BETA10, 1e-13);
}
/// B(1.25, 0.5) and B(11.25, 0.5).
const BETA0: f64 = 1.7480383695280798736;
const BETA10: f64 = 0.53434602678171582123;

#[test]
fn a_weight_of_ones_own_gives_the_classical_rules() {
    let same = |own: Recurrence, classical: Recurrence| {
        close(own.mass, classical.mass, 1e-13);
        for k in 0..20 {
            assert!(
                (own.diagonal[k] - classical.diagonal[k]).abs() < 1e-12 * (1.0 + classical.diagonal[k].abs())
            );
            assert!((own.beside[k] - classical.beside[k]).abs() <= 1e-12 * classical.beside[k], "{k}");
        }
    };
    let infinity = f64::INFINITY;
    same(Recurrence::of_weight(20, |_| 1.0, -1.0, 1.0).unwrap(), Recurrence::legendre(20));
    same(Recurrence::of_weight(20, |x| 1.0 - x, -1.0, 1.0).unwrap(), Recurrence::jacobi(20, 1.0, 0.0));
    same(
        Recurrence::of_weight(20, |x| (-x).exp() / x.sqrt(), 0.0, infinity).unwrap(),
        Recurrence::laguerre(20, -0.5),
    );
    same(
        Recurrence::of_weight(20, |x| (-x * x).exp(), -infinity, infinity).unwrap(),
        Recurrence::hermite(20),
    );
}

#[test]
fn a_logarithmic_weight_is_integrated_with_its_singularity() {
    // ∫₀¹ −ln x x^k dx = 1/(k + 1)².
    let rule = Recurrence::of_weight(30, |x| -x.ln(), 0.0, 1.0).unwrap().gauss();
    for k in [0, 1, 10, 59] {
        close(rule.integrate(|x| x.powi(k)), 1.0 / f64::from(k + 1).powi(2), 1e-13);
    }
    let order = Recurrence::of_weight(14, |x| -x.ln(), 0.0, 1.0).unwrap();
    assert_eq!(order.order(&Recurrence::of_weight(5, |x| -x.ln(), 0.0, 1.0).unwrap().gauss()), Some(9));
}

#[test]
fn weights_that_are_none_are_refused() {
    let error = |weight: fn(f64) -> f64, a, b| Recurrence::of_weight(5, weight, a, b).unwrap_err();
    assert!(matches!(error(|x| x, -1.0, 1.0), QuadratureError::Weight { value, .. } if value < 0.0));
    assert!(matches!(error(|_| 0.0, -1.0, 1.0), QuadratureError::Weight { .. }));
    assert!(matches!(error(|x| x.sqrt(), -1.0, 1.0), QuadratureError::NotFinite { .. }));
    assert!(matches!(error(|x| 1.0 / (1.0 - x).sqrt(), 0.0, 1.0), QuadratureError::Moments { .. }));
    assert!(matches!(error(|_| 1.0, 1.0, 0.0), QuadratureError::Domain { .. }));
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(gauss_jacobi(3, bad, 0.0, 0.0, 1.0).is_err() && gauss_laguerre(3, bad).is_err());
    }
}

#[test]
fn the_recurrence_gives_the_polynomials() {
    // P_3 = x³ − 3x/5, monic.
    let monic = Recurrence::legendre(3).monic(0.5);
    close(monic[3], 0.125 - 0.3, 1e-15);
    let hermite = Recurrence::hermite(4).orthonormal(1.0, 1.0);
    // H_3(1) = −4, ‖H_3‖² = √π 2³ 3!.
    close(hermite[3], -4.0 / (PI.sqrt() * 48.0).sqrt(), 1e-14);
}

#[test]
fn bernoulli_numbers_are_the_known_ones() {
    assert_eq!([0, 1, 3, 5].map(|p| bernoulli(p).unwrap()), [1.0, -0.5, 0.0, 0.0]);
    let exact = [
        (2, 1.0 / 6.0),
        (4, -1.0 / 30.0),
        (6, 1.0 / 42.0),
        (12, -691.0 / 2730.0),
        (20, -174_611.0 / 330.0),
        (30, 8_615_841_276_005.0 / 14_322.0),
        (38, 488332318973593.16667),
        (40, -19296579341940068.149),
        (60, -2.1399949257225333666e+34),
        (100, -2.8382249570693706959e+78),
        (258, 1.3352784187354633875e+306),
    ];
    for (p, value) in exact {
        close(bernoulli(p).unwrap(), value, if p <= 38 { 4e-16 } else { 1e-14 });
    }
    assert!(bernoulli(260).is_err());
}

#[test]
fn euler_maclaurin_gains_two_orders_with_each_derivative() {
    let (f, derivatives) = (|x: f64| x.exp(), [[1.0, 1_f64.exp()]; 4]);
    let exact = 1_f64.exp() - 1.0;
    for k in 0..=2 {
        let error = |m| (euler_maclaurin(f, &derivatives[..k], 0.0, 1.0, m).unwrap() - exact).abs();
        assert!(((error(2) / error(4)).log2() - (2 * k + 2) as f64).abs() < 0.05, "{k}");
    }
    close(euler_maclaurin(f, &derivatives, 0.0, 1.0, 20).unwrap(), exact, 1e-15);
}

#[test]
fn romberg_columns_are_newton_cotes_first_and_gain_two_orders_each() {
    let trapezoids = |f: &dyn Fn(f64) -> f64, rows: usize| -> Vec<f64> {
        (0..rows).map(|m| trapezoid(0.0, 1.0, 1 << m).unwrap().integrate(|x| f(*x))).collect()
    };
    let f = |x: f64| 1.0 / (1.0 + x);
    let triangle = richardson(&trapezoids(&f, 8), 4.0);
    close(triangle[3][1], simpson(0.0, 1.0, 4).unwrap().integrate(|x| f(*x)), 1e-15);
    close(triangle[3][2], boole(0.0, 1.0, 2).unwrap().integrate(|x| f(*x)), 1e-15);
    for n in [0, 1, 2] {
        let error = |m: usize| (triangle[m][n] - 2_f64.ln()).abs();
        assert!(((error(4) / error(5)).log2() - (2 * n + 2) as f64).abs() < 0.15, "column {n}");
    }
    // Column n is exact for degree 2n + 1 and no more.
    for n in 0..5 {
        let last = |degree: i32| {
            let triangle = richardson(&trapezoids(&|x| x.powi(degree), n + 1), 4.0);
            (triangle[n][n] * f64::from(degree + 1) - 1.0).abs()
        };
        assert!(last(2 * n as i32 + 1) < 1e-14 && last(2 * n as i32 + 2) > 1e-12, "{n}");
    }
}

#[test]
fn romberg_asks_for_each_point_once_and_knows_its_error() {
    let mut asked = Vec::new();
    let integral = romberg(
        |x| {
            asked.push(x);
            x.exp()
        },
        0.0,
        1.0,
        1e-13,
    )
    .unwrap();
    assert!((integral.value - (1_f64.exp() - 1.0)).abs() <= integral.error && integral.error < 1e-12);
    assert_eq!(integral.evaluations, asked.len());
    asked.sort_unstable_by(f64::total_cmp);
    assert!(asked.windows(2).all(|x| x[0] < x[1]));
    let hard = romberg(|x| x.sqrt(), 0.0, 1.0, 1e-13).unwrap_err();
    assert!(
        matches!(hard, IntegrateError::NotConverged { best, .. } if (best.value - 2.0 / 3.0).abs() <= best.error)
    );
    assert!(matches!(romberg(|x| 1.0 / x, 0.0, 1.0, 1e-6), Err(IntegrateError::Quadrature(_))));
}

/// (name, integrand, a, b, integral).
type Problem = (&'static str, fn(f64) -> f64, f64, f64, f64);

const INFINITY: f64 = f64::INFINITY;
const PROBLEMS: &[Problem] = &[
    ("exp", f64::exp, 0.0, 1.0, std::f64::consts::E - 1.0),
    ("backwards", f64::exp, 1.0, 0.0, 1.0 - std::f64::consts::E),
    ("ln", f64::ln, 0.0, 1.0, -1.0),
    ("1/√x", |x| 1.0 / x.sqrt(), 0.0, 1.0, 2.0),
    ("x^-0.9", |x| x.powf(-0.9), 0.0, 1.0, 10.0),
    ("kink", |x| (x - 0.3).abs(), 0.0, 1.0, 0.29),
    ("jump", |x| if x < 1.0 / 3.0 { 0.0 } else { 1.0 }, 0.0, 1.0, 2.0 / 3.0),
    ("Runge", |x| 1.0 / (1.0 + 25.0 * x * x), -1.0, 1.0, 0.549_360_306_778_006_2),
    ("peak", |x| 1e-3 / (x * x + 1e-6), -1.0, 1.0, 3.139_592_654_256_459_4),
    ("waves", |x| (300.0 * x).sin(), 0.0, 1.0, 0.003_406_988_730_928_946_5),
    ("nothing", |x| (2.0 * PI * x).sin(), 0.0, 1.0, 0.0),
    ("Gauss", |x| (-x * x).exp(), -INFINITY, INFINITY, 1.772_453_850_905_516),
    ("Cauchy", |x| 1.0 / (1.0 + x * x), 0.0, INFINITY, 0.5 * PI),
    ("half a line, left", f64::exp, -INFINITY, 1.0, std::f64::consts::E),
    ("both ends singular", |x| (-x).exp() / x.sqrt(), 0.0, INFINITY, 1.772_453_850_905_516),
    ("slow decay", |x| x.powf(-1.5), 1.0, INFINITY, 2.0),
];

#[test]
fn adaptive_integration_meets_its_tolerance_and_its_estimate() {
    for (name, f, a, b, exact) in PROBLEMS {
        let found = integrate(f, *a, *b).unwrap();
        let error = (found.value - exact).abs();
        // 1e-15 of what is integrated belongs to the exact values and to the integrands themselves.
        assert!(error <= found.error + 2e-15 * exact.abs(), "{name}: {error:e}, estimated {:e}", found.error);
        assert!(found.error <= 1e-12 * exact.abs().max(1.0), "{name}: {:e}", found.error);
    }
    let coarse = Adaptive { relative: 1e-3, ..Adaptive::default() }.integrate(f64::sqrt, 0.0, 1.0).unwrap();
    assert!((coarse.value - 2.0 / 3.0).abs() <= 1e-3 && coarse.evaluations <= 100);
}

#[test]
fn what_cannot_be_integrated_is_told() {
    let told = integrate(|x| (x - 0.5).sqrt(), 0.0, 1.0).unwrap_err();
    assert!(matches!(told, IntegrateError::Quadrature(QuadratureError::NotFinite { at, .. }) if at < 0.5));
    assert!(integrate(|x| 1.0 / x, 0.0, 1.0).is_err());
    assert!(integrate(|x| 1.0 / x, 1.0, f64::INFINITY).is_err());
    assert!(integrate(|x| x, 0.0, f64::NAN).is_err());
    let told = integrate(|x| 1.0 / (1.0 - x).sqrt(), 0.0, 1.0).unwrap_err();
    assert!(
        matches!(told, IntegrateError::NotConverged { best, .. } if (best.value - 2.0).abs() <= best.error)
    );
    let few = Adaptive { evaluations: 100, ..Adaptive::default() };
    let told = few.integrate(|x| (300.0 * x).sin(), 0.0, 1.0).unwrap_err();
    assert!(matches!(told, IntegrateError::NotConverged { best, .. } if best.evaluations < 200));
}

const UNIT: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// The largest |Σ w p − ∫ p| over the orthonormal polynomials p of one degree on the unit triangle (Koornwinder, Dubiner).
fn defect(rule: &Quadrature<[f64; 2]>, degree: usize) -> f64 {
    let defect = |i: usize, j: usize| {
        let exact = if i + j == 0 { 0.5_f64.sqrt() } else { 0.0 };
        (rule.integrate(|p| dubiner(i, j, *p)) - exact).abs()
    };
    (0..=degree).map(|i| defect(i, degree - i)).fold(0.0, f64::max)
}

fn dubiner(i: usize, j: usize, [x, y]: [f64; 2]) -> f64 {
    let fold = 1.0 - y;
    let across = if fold > 0.0 { 2.0 * x / fold - 1.0 } else { 0.0 };
    let p = Recurrence::legendre(i + 1).orthonormal(across, 1.0)[i] * fold.powi(i as i32);
    let alpha = 2.0 * i as f64 + 1.0;
    // dA = (1 − y)/2 d(across) dy, and the weight (1 − s)^α of s = 2y − 1 is 2^α (1 − y)^α.
    p * Recurrence::jacobi(j + 1, alpha, 0.0).orthonormal(2.0 * y - 1.0, 1.0)[j]
        * 2_f64.powf(0.5 * alpha + 1.0)
}

#[test]
fn triangle_rules_have_their_degree_and_no_more() {
    for degree in 1..=MOST_SYMMETRIC {
        let rule = triangle(degree, UNIT).unwrap();
        let known = |degree: usize| rule.nodes == triangle(degree, UNIT).map(|r| r.nodes).unwrap_or_default();
        let top = (degree..=MOST_SYMMETRIC).take_while(|d| known(*d)).last().unwrap();
        for d in 0..=top {
            assert!(defect(&rule, d) < 1e-14, "degree {degree} at {d}: {:e}", defect(&rule, d));
        }
        assert!(defect(&rule, top + 1) > 1e-8, "degree {degree} is better than that");
        assert!(rule.weights.iter().all(|w| *w > 0.0));
        assert!(rule.nodes.iter().all(|[x, y]| *x > 0.0 && *y > 0.0 && x + y < 1.0));
    }
    assert_eq!([1, 2, 4, 5, 8, 14].map(|d| triangle(d, UNIT).unwrap().nodes.len()), [1, 3, 6, 7, 16, 42]);
    assert!(matches!(triangle(MOST_SYMMETRIC + 1, UNIT), Err(QuadratureError::Degree { .. })));
}

#[test]
fn triangle_rules_are_symmetric_and_map_to_any_triangle() {
    let corners = [[1.0, 2.0], [4.0, 1.0], [2.0, 5.0]];
    let turned = [corners[1], corners[2], corners[0]];
    let g = |p: &[f64; 2]| (0.3 * p[0] - 0.2 * p[1]).exp();
    for rule in [triangle(20, corners), triangle(20, turned), conical(20, corners), conical(40, turned)] {
        let rule = rule.unwrap();
        close(rule.weights.iter().sum(), 5.0, 1e-14);
        close(rule.integrate(g), conical(30, corners).unwrap().integrate(g), 1e-14);
    }
}

#[test]
fn conical_rules_have_any_degree() {
    for degree in [0, 1, 2, 7, 24, 31] {
        let rule = conical(degree, UNIT).unwrap();
        let top = 2 * (degree / 2) + 1;
        assert!((0..=top).all(|d| defect(&rule, d) < 1e-14), "{degree}");
        assert!(defect(&rule, top + 1) > 1e-6, "{degree}");
    }
}

#[test]
fn rectangles_and_disks_are_exact_to_their_degree_and_no_more() {
    let rule = rectangle(5, [0.0, 2.0], [1.0, 3.0]);
    close(rule.integrate(|[x, y]| x.powi(5) * y.powi(5)), 64.0 / 6.0 * 728.0 / 6.0, 1e-14);
    assert!((rule.integrate(|[x, _]| x.powi(6)) / (256.0 / 7.0) - 1.0).abs() > 1e-6);
    for degree in 0..=12_i32 {
        let rule = disk(degree as usize, [0.0, 0.0], 2.0).unwrap();
        // ∫ x^2i y^2j = 2 R^{2i+2j+2}/(2i + 2j + 2) B(i + ½, j + ½), here by a finer rule in polar coordinates.
        let fine = disk(60, [0.0, 0.0], 2.0).unwrap();
        let error = |i: i32, j: i32| {
            let g = |p: &[f64; 2]| (0.5 * p[0]).powi(i) * (0.5 * p[1]).powi(j);
            (rule.integrate(g) - fine.integrate(g)).abs()
        };
        for d in 0..=degree {
            assert!((0..=d).all(|i| error(i, d - i) < 1e-13), "degree {degree} at {d}");
        }
        assert!(
            (1..=2).any(|more| (0..=degree + more).any(|i| error(i, degree + more - i) > 1e-5)),
            "{degree}"
        );
    }
    close(disk(4, [3.0, 1.0], 2.0).unwrap().integrate(|[x, _]| x * x), 4.0 * PI * (9.0 + 1.0), 1e-14);
    assert!(disk(3, [0.0, 0.0], -1.0).is_err());
}
