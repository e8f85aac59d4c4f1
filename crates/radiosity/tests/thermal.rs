//! The enclosures of textbooks, to ten digits, and what follows of heat by radiation in general.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod common;

use common::{p, parallelogram, scene, visibility, walls};
use fredholm::operator::Dense;
use glam::DVec3;
use radiosity::form_factor::FormFactors;
use radiosity::patches::Patches;
use radiosity::thermal::{
    Answer, Bands, Condition, Enclosure, Exchange, Node, Options, Surface, ThermalError, emissive_power,
    temperature,
};

/// The temperature of what emits this much.
fn kelvin(power: f64) -> f64 {
    temperature(power)
}

fn solve(enclosure: &Enclosure) -> Answer {
    let answer = enclosure.solve(&Options::default()).unwrap();
    assert!(answer.converged, "{answer:?}");
    answer
}

fn nested(surfaces: Vec<Surface>, areas: &[f64]) -> Answer {
    solve(&Enclosure::nested(surfaces, areas, Bands::grey()).unwrap())
}

/// Asserts that a number is the expected one to 1e-10, and that its bound is right and small.
fn assert_is(found: f64, bound: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() < 1e-10 * expected.abs().max(1.0), "{what}: {found} for {expected}");
    assert!((found - expected).abs() <= bound, "{what}: off by {}, and the bound {bound}", found - expected);
    assert!(bound < 1e-10 * expected.abs().max(1.0), "{what}: a bound of {bound}");
}

fn heat_flux(answer: &Answer, k: usize) -> (f64, f64) {
    (answer.nodes[k].heat_flux, answer.errors.as_ref().unwrap()[k].heat_flux + 1e-15)
}

fn assert_flux(answer: &Answer, k: usize, expected: f64, what: &str) {
    let (found, bound) = heat_flux(answer, k);
    assert_is(found, bound, expected, what);
}

#[test]
fn parallel_plates() {
    let plates =
        |hot, cold| vec![Surface::at("hot", kelvin(hot), 0.8), Surface::at("cold", kelvin(cold), 0.5)];
    let answer = nested(plates(1.0, 0.0), &[1.0, 1.0]);
    assert_flux(&answer, 0, 4.0 / 9.0, "hot plate");
    assert_flux(&answer, 1, -4.0 / 9.0, "cold plate");
    assert!((answer.nodes[0].heat_flux - 0.444_444_444_444).abs() < 1e-12);
    assert!(answer.balance.defect() < 1e-15);
    // As many watts as a room has.
    let answer = nested(plates(emissive_power(900.0), emissive_power(300.0)), &[3.0, 3.0]);
    let expected = (emissive_power(900.0) - emissive_power(300.0)) / (1.0 / 0.8 + 1.0 / 0.5 - 1.0);
    assert_flux(&answer, 0, expected, "hot plate at 900 K");
}

#[test]
fn concentric_spheres_and_cylinders() {
    for (ratio, e1, e2) in [(4.0, 0.3, 0.7), (2.0, 0.05, 1.0), (9.0, 1.0, 0.01), (4.0, 0.999, 1e-3)] {
        let surfaces = vec![Surface::at("inner", kelvin(5.0), e1), Surface::at("outer", kelvin(2.0), e2)];
        let answer = nested(surfaces, &[2.0, 2.0 * ratio]);
        let expected = 3.0 / (1.0 / e1 + (1.0 / e2 - 1.0) / ratio);
        assert_flux(&answer, 0, expected, "inner");
        assert_flux(&answer, 1, -expected / ratio, "outer");
    }
}

/// N shields whose sides have these emissivities, between a plate with σT⁴ = 1 and one with 0.
fn shields(outer: (f64, f64), sides: &[(f64, f64)]) -> Answer {
    let mut surfaces = vec![Surface::at("hot", kelvin(1.0), outer.0)];
    for (k, (toward, away)) in sides.iter().enumerate() {
        surfaces.push(Surface::floating("toward", &k.to_string(), *toward));
        surfaces.push(Surface::floating("away", &k.to_string(), *away));
    }
    surfaces.push(Surface::at("cold", 0.0, outer.1));
    let count = surfaces.len();
    nested(surfaces, &vec![1.0; count])
}

#[test]
fn radiation_shields() {
    for n in 1..=10 {
        for emissivity in [0.02, 0.1, 0.5, 1.0] {
            let answer = shields((emissivity, emissivity), &vec![(emissivity, emissivity); n]);
            let expected = 1.0 / ((n + 1) as f64 * (2.0 / emissivity - 1.0));
            assert_flux(&answer, 0, expected, &format!("{n} shields of {emissivity}"));
            for k in 1..=n {
                // σT⁴ falls by the same step from each to the next.
                let power = emissive_power(answer.nodes[2 * k].temperature.unwrap());
                assert!(
                    (power - 1.0 + k as f64 / (n + 1) as f64).abs() < 1e-11,
                    "shield {k} of {n}: {power}"
                );
                assert_eq!(answer.nodes[2 * k].temperature, answer.nodes[2 * k - 1].temperature);
            }
        }
    }
    let three = shields((0.1, 0.1), &[(0.1, 0.1); 3]);
    assert!((three.nodes[0].heat_flux - 0.013_157_894_737).abs() < 1e-12);
}

#[test]
fn shields_of_sides_that_differ_are_resistances_in_a_row() {
    let sides = [(0.04, 0.3), (0.9, 0.06), (0.5, 0.11)];
    let answer = shields((0.8, 0.6), &sides);
    let gap = |a: f64, b: f64| 1.0 / a + 1.0 / b - 1.0;
    let resistance = gap(0.8, 0.04) + gap(0.3, 0.9) + gap(0.06, 0.5) + gap(0.11, 0.6);
    assert_flux(&answer, 0, 1.0 / resistance, "hot plate");
    assert_flux(&answer, 7, -1.0 / resistance, "cold plate");
    let first = emissive_power(answer.nodes[1].temperature.unwrap());
    assert!((first - (1.0 - gap(0.8, 0.04) / resistance)).abs() < 1e-12);
}

#[test]
fn a_shield_between_spheres_whose_sides_have_other_areas() {
    // Outside it is grooved: 3 m² for 2 m² inside.
    let surfaces = vec![
        Surface::at("inner", kelvin(5.0), 0.7),
        Surface::floating("toward", "shield", 0.2),
        Surface::floating("away", "shield", 0.4),
        Surface::at("outer", kelvin(1.0), 0.5),
    ];
    let answer = nested(surfaces, &[1.0, 2.0, 3.0, 4.0]);
    let gap = |inner: (f64, f64), outer: (f64, f64)| {
        (1.0 / inner.1 + inner.0 / outer.0 * (1.0 / outer.1 - 1.0)) / inner.0
    };
    let heat = 4.0 / (gap((1.0, 0.7), (2.0, 0.2)) + gap((3.0, 0.4), (4.0, 0.5)));
    assert_flux(&answer, 0, heat, "inner");
    assert_flux(&answer, 2, heat / 3.0, "away");
    assert_flux(&answer, 3, -heat / 4.0, "outer");
}

/// The shape factors of the faces of a cube: opposite, adjacent.
const CUBE: (f64, f64) = (OPPOSITE, (1.0 - OPPOSITE) / 4.0);
const OPPOSITE: f64 = 0.199_824_895_697_904_8;

/// The view factors of a cube's faces, of which 2k and 2k + 1 are opposite.
fn cube() -> Vec<Vec<f64>> {
    let factor = |i: usize, j: usize| match (i == j, i / 2 == j / 2) {
        (true, _) => 0.0,
        (_, true) => CUBE.0,
        _ => CUBE.1,
    };
    (0..6).map(|i| (0..6).map(|j| factor(i, j)).collect()).collect()
}

#[test]
fn a_cube_of_six_zones() {
    // E = 1 is ε σT⁴ with ε = 0.4.
    let wall = |k: usize| Surface::at(&k.to_string(), if k == 0 { kelvin(2.5) } else { 0.0 }, 0.4);
    let enclosure = Enclosure::new((0..6).map(wall).collect(), &[1.0; 6], &cube(), Bands::grey()).unwrap();
    assert!(enclosure.is_closed());
    let answer = solve(&enclosure);
    for (k, expected) in [(0, 1.160_714_295_535), (1, 0.267_773_389_574), (2, 0.267_878_078_723)] {
        assert!((answer.nodes[k].radiosity - expected).abs() < 1e-11, "{:?}", answer.nodes[k]);
    }
}

#[test]
fn a_cavity_with_an_opening() {
    // The cap fraction f of a sphere sees itself by f: B = ε/(1 − (1 − ε) f).
    let surfaces = || vec![Surface::at("cavity", kelvin(1.0), 0.3)];
    let cavity = Enclosure::new(surfaces(), &[3.0], &[vec![0.75]], Bands::grey()).unwrap();
    let answer = solve(&cavity);
    assert!((answer.nodes[0].radiosity - 0.631_578_947_368).abs() < 1e-12);
    assert_flux(&answer, 0, 0.25 * 12.0 / 19.0, "what leaves by the opening");
    // In surroundings as warm as itself nothing is exchanged, and everything is black.
    let answer = solve(&cavity.in_surroundings(kelvin(1.0)));
    assert!((answer.nodes[0].radiosity - 1.0).abs() < 1e-15 && answer.nodes[0].heat_flux.abs() < 1e-15);
}

#[test]
fn a_reradiating_third_surface() {
    // Incropera, §13.3.5: two surfaces and an adiabatic third, q₁ = (E₁ − E₂)/(R₁ + R + R₂).
    let (f12, f13, f23) = (0.2, 0.8, 0.8);
    let factors = [vec![0.0, f12, f13], vec![f12, 0.0, f23], vec![0.4, 0.4, 0.2]];
    for third in [0.0, 0.3, 1.0] {
        let surfaces = vec![
            Surface::at("1", 1000.0, 0.8),
            Surface::at("2", 500.0, 0.4),
            Surface::heated("reradiating", 0.0, third),
        ];
        let answer = solve(&Enclosure::new(surfaces, &[1.0, 1.0, 2.0], &factors, Bands::grey()).unwrap());
        let between = 1.0 / (f12 + 1.0 / (1.0 / f13 + 1.0 / f23));
        let resistance = (1.0 - 0.8) / 0.8 + between + (1.0 - 0.4) / 0.4;
        let expected = (emissive_power(1000.0) - emissive_power(500.0)) / resistance;
        assert_flux(&answer, 0, expected, "1");
        assert_flux(&answer, 1, -expected, "2");
        let wall = answer.nodes[2];
        assert!(wall.heat_flux.abs() < 1e-10 && (wall.radiosity - wall.irradiance).abs() < 1e-9);
        // Whatever its emissivity it glows with σT⁴ = H; what does not emit has no temperature to tell.
        let mean = 0.5 * (answer.nodes[0].radiosity + answer.nodes[1].radiosity);
        match wall.temperature {
            Some(kelvin) => assert!((emissive_power(kelvin) - mean).abs() < 1e-9),
            None => assert_eq!(third, 0.0),
        }
    }
}

/// A random enclosure: F with A_i F_ij = A_j F_ji and rows of 1, by Sinkhorn's scaling.
fn random_enclosure(n: usize, seed: u64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut exchange = vec![vec![0.0; n]; n];
    for (i, j) in (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))) {
        let direct = random();
        exchange[i][j] = direct;
        exchange[j][i] = direct;
    }
    let areas: Vec<f64> = exchange.iter().map(|row| row.iter().sum()).collect();
    let factors =
        exchange.iter().zip(&areas).map(|(row, area)| row.iter().map(|x| x / area).collect()).collect();
    (areas, factors)
}

/// x with M x = b, by Gauss's elimination with pivots: written here so that no solver judges itself.
fn eliminate(mut m: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| m[*i][k].abs().total_cmp(&m[*j][k].abs())).unwrap();
        m.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = m[i][k] / m[k][k];
            let pivot_row = m[k].clone();
            m[i].iter_mut().zip(&pivot_row).for_each(|(x, pivot)| *x -= factor * pivot);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| m[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / m[k][k];
    }
    b
}

#[test]
fn enclosures_of_many_surfaces_are_those_of_elimination() {
    for (n, seed) in [(3, 1), (8, 2), (25, 3)] {
        let (areas, factors) = random_enclosure(n, seed);
        let emissivity = |k: usize| 0.05 + 0.9 * (k as f64 / n as f64);
        let power = |k: usize| 1.0 + (k as f64).sin();
        let surface = |k: usize| match k % 3 {
            2 => Surface::heated(&k.to_string(), 0.3 * (1.2 + (k as f64).cos()), emissivity(k)),
            _ => Surface::at(&k.to_string(), kelvin(power(k)), emissivity(k)),
        };
        let enclosure =
            Enclosure::new((0..n).map(surface).collect(), &areas, &factors, Bands::grey()).unwrap();
        let answer = solve(&enclosure);
        // B − ρ F B = f with ρ = 1 and f = q where the heat is given.
        let coefficient = |k: usize| if k % 3 == 2 { 1.0 } else { 1.0 - emissivity(k) };
        let matrix = (0..n)
            .map(|i| (0..n).map(|j| f64::from(i == j) - coefficient(i) * factors[i][j]).collect())
            .collect();
        let source =
            |k: usize| if k % 3 == 2 { 0.3 * (1.2 + (k as f64).cos()) } else { emissivity(k) * power(k) };
        let expected = eliminate(matrix, (0..n).map(source).collect());
        let errors = answer.errors.as_ref().unwrap();
        for k in 0..n {
            let found = answer.nodes[k].radiosity;
            assert_is(found, errors[k].radiosity, expected[k], &format!("{k} of {n}"));
        }
        assert!(answer.balance.defect() < 1e-12 * answer.balance.exchanged);
    }
}

#[test]
fn bands_that_are_alike_are_grey() {
    let bands = || Bands::new(vec![3.0, 6.0, 12.0]).unwrap();
    let surfaces = |count: usize| {
        let mut surfaces = vec![
            Surface::at("hot", 900.0, 0.7),
            Surface::floating("toward", "shield", 0.2),
            Surface::floating("away", "shield", 0.4),
            Surface::at("cold", 300.0, 0.5),
        ];
        surfaces.iter_mut().for_each(|s| s.emissivity = vec![s.emissivity[0]; count]);
        surfaces
    };
    let grey = nested(surfaces(1), &[1.0; 4]);
    let banded = solve(&Enclosure::nested(surfaces(4), &[1.0; 4], bands()).unwrap());
    for (a, b) in grey.nodes.iter().zip(&banded.nodes) {
        assert!((a.heat_flux - b.heat_flux).abs() < 1e-9 && (a.radiosity - b.radiosity).abs() < 1e-8);
        assert!((a.temperature.unwrap() - b.temperature.unwrap()).abs() < 1e-10);
    }
    assert!(banded.steps < 10, "{} steps", banded.steps);
}

#[test]
fn a_shield_of_two_bands_balances_what_it_gets_in_each() {
    // Between a black plate at 1200 K and one at 300 K: ε (2 e(T) − e(1200 K) − e(300 K)) summed over the bands is 0.
    let bands = Bands::new(vec![4.0]).unwrap();
    let emissivity = [0.1, 0.9];
    let of = |surface: Surface, values: [f64; 2]| Surface { emissivity: values.to_vec(), ..surface };
    let surfaces = vec![
        of(Surface::at("hot", 1200.0, 1.0), [1.0; 2]),
        of(Surface::floating("toward", "shield", 0.5), emissivity),
        of(Surface::floating("away", "shield", 0.5), emissivity),
        of(Surface::at("cold", 300.0, 1.0), [1.0; 2]),
    ];
    let answer = solve(&Enclosure::nested(surfaces, &[1.0; 4], bands.clone()).unwrap());
    let (hot, cold) = (bands.emissive_powers(1200.0), bands.emissive_powers(300.0));
    let excess = |t: f64| -> f64 {
        let own = bands.emissive_powers(t);
        (0..2).map(|b| emissivity[b] * (2.0 * own[b] - hot[b] - cold[b])).sum()
    };
    let (mut low, mut high) = (300.0, 1200.0);
    while high - low > 1e-11 {
        let middle = 0.5 * (low + high);
        *(if excess(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    let shield = answer.nodes[1].temperature.unwrap();
    assert!((shield - low).abs() < 1e-9, "{shield} for {low}");
    // A grey shield takes the middle of the fourth powers; this one sees the hot plate less, which glows below 4 µm.
    let grey = temperature(0.5 * (emissive_power(1200.0) + emissive_power(300.0)));
    assert!(shield < grey - 50.0, "{shield} {grey}");
    let expected: f64 = (0..2).map(|b| emissivity[b] * (hot[b] - bands.emissive_powers(low)[b])).sum();
    assert!((answer.nodes[0].heat_flux - expected).abs() < 1e-7);
}

#[test]
fn newton_finds_hot_and_cold_from_afar() {
    let bands = || Bands::new(vec![1.0, 2.0, 5.0, 20.0]).unwrap();
    for (flux, selective) in [(1e-3, 0.9), (50.0, 0.2), (1e7, 0.05), (1e7, 1.0)] {
        let emissivity = vec![selective, 0.5 * selective, 0.3, 0.1, 0.02];
        let condition = Condition::HeatFlux(flux);
        let heated = Surface { name: "heated".into(), emissivity, condition };
        let mut cold = Surface::at("cold", 77.0, 0.5);
        cold.emissivity = vec![0.9, 0.7, 0.5, 0.3, 0.1];
        let answer = solve(&Enclosure::nested(vec![heated, cold], &[1.0, 2.0], bands()).unwrap());
        assert!((answer.nodes[0].heat_flux / flux - 1.0).abs() < 1e-6, "{flux}: {answer:?}");
        assert!((answer.nodes[1].heat_flux / flux + 0.5).abs() < 1e-6, "{flux}: {answer:?}");
        assert!(answer.steps < 25, "{flux}: {} steps", answer.steps);
    }
}

#[test]
fn the_alternative_is_told() {
    let two = |a: Surface, b: Surface| Enclosure::nested(vec![a, b], &[1.0, 2.0], Bands::grey()).unwrap();
    let fails = |enclosure: &Enclosure| enclosure.solve(&Options::default()).unwrap_err();
    let heated = |flux| Surface::heated("s", flux, 0.5);
    let loose = fails(&two(heated(2.0), heated(-1.0)));
    assert!(matches!(loose, ThermalError::NotUnique { .. }), "{loose}");
    match fails(&two(heated(2.0), heated(-0.5))) {
        ThermalError::NoSolution { excess, .. } => assert!((excess - 1.0).abs() < 1e-12),
        other => panic!("{other}"),
    }
    // A temperature on what neither emits nor absorbs anchors nothing.
    assert!(matches!(
        fails(&two(heated(0.0), Surface::at("mirror", 300.0, 0.0))),
        ThermalError::NotUnique { .. }
    ));
    // Of two chambers one has a temperature.
    let four = vec![Surface::at("a", 300.0, 0.5), heated(0.0), heated(1.0), heated(-1.0)];
    let chambers = Enclosure::nested(four, &[1.0; 4], Bands::grey()).unwrap();
    assert!(matches!(fails(&chambers), ThermalError::NotUnique { .. }));
    // A shield that both share links them.
    let four = vec![
        Surface::at("a", 300.0, 0.5),
        Surface::floating("s", "shield", 0.5),
        Surface::floating("s", "shield", 0.5),
        heated(2.0),
    ];
    let linked = solve(&Enclosure::nested(four, &[1.0; 4], Bands::grey()).unwrap());
    assert!((linked.nodes[0].heat_flux + 2.0).abs() < 1e-10);
    // No more can be drawn than arrives.
    match fails(&two(heated(-100.0), Surface::at("cold", 100.0, 0.5))) {
        ThermalError::TooCold { power, .. } => assert!(power < 0.0),
        other => panic!("{other}"),
    }
}

#[test]
fn what_makes_no_enclosure_is_refused() {
    let surfaces = |n: usize| (0..n).map(|k| Surface::at(&k.to_string(), 300.0, 0.5)).collect::<Vec<_>>();
    let refused = |n: usize, areas: &[f64], factors: &[Vec<f64>]| {
        Enclosure::new(surfaces(n), areas, factors, Bands::grey()).unwrap_err()
    };
    let even = |n: usize| vec![vec![1.0 / n as f64; n]; n];
    assert!(matches!(refused(3, &[1.0; 3], &even(2)), ThermalError::Shape { row: 1, given: 2, .. }));
    assert!(matches!(refused(2, &[1.0; 2], &[vec![0.5; 2]]), ThermalError::Shape { row: 2, given: 0, .. }));
    assert!(matches!(refused(2, &[1.0; 2], &even(3)), ThermalError::Shape { row: 1, given: 3, .. }));
    assert!(matches!(refused(2, &[1.0, -1.0], &even(2)), ThermalError::Area { .. }));
    assert!(matches!(refused(2, &[1.0, 2.0], &even(2)), ThermalError::Reciprocity { .. }));
    assert!(matches!(refused(1, &[1.0], &[vec![1.1]]), ThermalError::ViewFactor { row: 1, column: 1, .. }));
    assert!(matches!(refused(2, &[1.0; 2], &[vec![0.6; 2], vec![0.6; 2]]), ThermalError::RowSum { .. }));
    assert!(Enclosure::nested(surfaces(3), &[1.0; 3], Bands::grey()).is_err());
    assert!(Enclosure::nested(surfaces(2), &[2.0, 1.0], Bands::grey()).is_err());
}

/// The faces of a unit cube in patches, each face a surface.
fn cube_exchange<T>(
    surfaces: &[Surface],
    size: f64,
    judge: impl Fn(&Exchange<'_, Dense<f32>>, &[f64]) -> T,
) -> T {
    let scene = scene::<f64>(walls(DVec3::ZERO, DVec3::ONE, false).map(|wall| vec![wall]), 0.0);
    let (patches, visibility) = (Patches::new(&scene, size).unwrap(), visibility(&scene));
    let coupling = FormFactors::patch_to_patch(&patches, &visibility, 1e-3);
    let operator = Dense::<f32>::assemble(&coupling, |_| ()).unwrap();
    let node = |(surface, area): (&u32, &f64)| Node { surface: *surface as usize, area: *area };
    let nodes: Vec<Node> = patches.surface.iter().zip(&patches.areas).map(node).collect();
    let bands = Bands::grey();
    let exchange = Exchange {
        surfaces,
        nodes: &nodes,
        bands: &bands,
        operator: &operator,
        surroundings: 0.0,
        closed: true,
    };
    judge(&exchange, &patches.areas)
}

#[test]
fn adiabatic_walls_in_patches_balance() {
    // Floor hot, ceiling cold, the other four adiabatic: by symmetry the middle of the walls is the middle of σT⁴.
    let mut surfaces: Vec<Surface> = (0..6).map(|k| Surface::heated(&k.to_string(), 0.0, 0.5)).collect();
    surfaces[0] = Surface::at("floor", 1000.0, 1.0);
    surfaces[1] = Surface::at("ceiling", 600.0, 1.0);
    let fluxes = [0.25, 0.1].map(|size| {
        cube_exchange(&surfaces, size, |exchange, _| {
            let answer = exchange.solve(&Options::default()).unwrap();
            assert!(answer.converged && answer.errors.is_some(), "{}", answer.residual);
            assert!(answer.balance.defect() < 1e-6 * answer.balance.exchanged, "{:?}", answer.balance);
            let surfaces = answer.by_surface(exchange);
            assert!((surfaces[0].heat + surfaces[1].heat).abs() < 1e-6 * surfaces[0].heat);
            let middle = 0.5 * (emissive_power(1000.0) + emissive_power(600.0));
            for wall in &surfaces[2..] {
                assert!((emissive_power(wall.mean.temperature.unwrap()) / middle - 1.0).abs() < 1e-5);
                let (lowest, highest) = wall.temperatures.unwrap();
                assert!(lowest < wall.mean.temperature.unwrap() && highest > lowest + 50.0);
                assert!(wall.heat.abs() < 1e-8 * surfaces[0].heat);
            }
            surfaces[0].mean.heat_flux / (emissive_power(1000.0) - emissive_power(600.0))
        })
    });
    // One node for each wall would give F₁₂ + ½ (1 − F₁₂) = 0.59991; walls that vary hinder the heat more.
    assert!((fluxes[0] - fluxes[1]).abs() < 5e-3 && (0.52..0.599).contains(&fluxes[1]), "{fluxes:?}");
}

#[test]
fn an_enclosure_at_one_temperature_exchanges_nothing() {
    let mut surfaces: Vec<Surface> =
        (0..6).map(|k| Surface::at(&k.to_string(), 300.0, 0.1 + 0.15 * k as f64)).collect();
    surfaces[3].condition = Condition::HeatFlux(0.0);
    cube_exchange(&surfaces, 0.25, |exchange, _| {
        let answer = exchange.solve(&Options::default()).unwrap();
        for node in &answer.nodes {
            assert!((node.radiosity / emissive_power(300.0) - 1.0).abs() < 1e-12);
            assert!((node.temperature.unwrap() - 300.0).abs() < 1e-9 && node.heat_flux.abs() < 1e-9);
        }
    });
}

#[test]
fn an_open_scene_radiates_into_its_surroundings() {
    // A black plate at T in surroundings at 300 K: q = σ(T⁴ − 300⁴), and the same from a grey one times ε.
    let plate = parallelogram(p(0.0, 0.0, 0.0), DVec3::X, DVec3::Y);
    let scene = scene::<f64>([vec![plate]], 0.0);
    let (patches, visibility) = (Patches::new(&scene, 0.5).unwrap(), visibility(&scene));
    let coupling = FormFactors::patch_to_patch(&patches, &visibility, 1e-3);
    let operator = Dense::<f32>::assemble(&coupling, |_| ()).unwrap();
    let nodes = vec![Node { surface: 0, area: 0.25 }; 4];
    let (surfaces, bands) = ([Surface::at("plate", 500.0, 0.6)], Bands::grey());
    let exchange = Exchange {
        surfaces: &surfaces,
        nodes: &nodes,
        bands: &bands,
        operator: &operator,
        surroundings: 300.0,
        closed: false,
    };
    let answer = exchange.solve(&Options::default()).unwrap();
    let expected = 0.6 * (emissive_power(500.0) - emissive_power(300.0));
    assert!((answer.by_surface(&exchange)[0].heat / expected - 1.0).abs() < 1e-14);
    assert!((answer.balance.to_surroundings / expected - 1.0).abs() < 1e-14);
}
