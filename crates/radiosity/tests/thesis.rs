//! The classical radiosity algorithms are special cases of the general theory: the two columns, equal.
//!
//! Left, radiosity as its books write it, transcribed literally (with the slips of the paper mended); right, the
//! general theory's methods, which know nothing of light.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::*;
use fredholm::discretize::{Collocation, Coupling, Galerkin, Nystrom};
use fredholm::kernel::Kernel;
use fredholm::neumann::estimated_rest;
use fredholm::operator::{Columns, Dense, OnTheFly};
use fredholm::quadrature::{Quadrature, gauss_legendre};
use fredholm::relax::{GaussSeidel, Relaxation, Southwell, SuccessiveApproximation};
use fredholm::space::{Element, Space};
use fredholm::system::System;
use fredholm::value::{Rgb, Spectrum, Value};
use glam::DVec3;
use radiosity::form_factor::{FormFactors, lambert::point_to_polygon, point_to_point};
use radiosity::kernel::{Lambertian, SurfacePoint, unoccluded};
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::scene::Scene;
use radiosity::solve::{Method, Options, Solver, Unobserved, solve};
use radiosity::visibility::Visibility;
use std::f64::consts::PI;

/// A coloured room with a block standing in it and a lamp, without symmetry (the largest residual is one, not two
/// equal ones), cut into patches of unequal areas.
struct Room {
    patches: Patches<Rgb>,
    visibility: Visibility,
}

fn room() -> Room {
    let mut groups: Vec<Vec<Polygon>> = walls(DVec3::ZERO, p(4.0, 3.3, 2.3), false).map(|w| vec![w]).to_vec();
    groups.push(walls(p(1.0, 0.7, 0.0), p(2.0, 1.9, 1.1), true)[1..].to_vec());
    groups.push(vec![parallelogram(p(1.5, 1.03, 2.29), DVec3::Y, 0.6 * DVec3::X)]);
    let mut scene = scene(groups, Spectrum([0.7, 0.6, 0.5]));
    scene.surfaces[4].reflectance = Spectrum([0.6, 0.1, 0.1]);
    scene.surfaces[5].reflectance = Spectrum([0.1, 0.5, 0.2]);
    scene.surfaces[7].emission = Spectrum([20.0, 18.0, 12.0]);
    Room { patches: Patches::new(&scene, 0.55).unwrap(), visibility: visibility(&scene) }
}

impl Room {
    fn form_factors(&self) -> FormFactors<'_> {
        FormFactors::patch_to_patch(&self.patches, &self.visibility, 1e-2)
    }

    fn matrix(&self) -> Dense<f64> {
        Dense::assemble(&self.form_factors(), |_| ()).unwrap()
    }

    fn system<'a, F: fredholm::operator::Operator<Rgb>>(&'a self, matrix: &'a F) -> System<'a, Rgb, F> {
        System::new(&self.patches.emission, &self.patches.reflectance, matrix).unwrap()
    }
}

const BLACK: Rgb = Spectrum([0.0; 3]);

#[test]
fn the_radiosity_equation_is_a_fredholm_equation_of_the_second_kind() {
    let room = room();
    let options = Options {
        method: Method::Galerkin,
        solver: Solver::GaussSeidel,
        accuracy: 1e-2,
        tolerance: 1e-12,
        iterations: 100,
        memory: 1 << 30,
        ..Options::default()
    };
    let b = solve(&room.patches, &room.visibility, &options, &mut Unobserved).unwrap().radiosity;
    let f = room.form_factors();
    for i in 0..room.patches.len() {
        let gathered = (0..b.len()).fold(BLACK, |sum, j| sum + b[j] * f.entry(i, j));
        let right = room.patches.emission[i] + room.patches.reflectance[i] * gathered;
        // The solver keeps F in single precision.
        assert!((b[i] - right).magnitude() < 1e-6 * 20.0, "patch {i}");
    }
}

#[test]
fn the_point_to_point_form_factor_is_nystrom() {
    let room = room();
    let nystrom = point_to_point(&room.patches, &room.visibility);
    let patches = &room.patches.polygons;
    let mut hidden = 0;
    for (i, a) in patches.iter().enumerate() {
        for (j, b) in patches.iter().enumerate().filter(|&(j, _)| j != i) {
            let r = b.centroid() - a.centroid();
            let (cos, cos_prime) = (a.normal().dot(r) / r.length(), -b.normal().dot(r) / r.length());
            let faces = cos > 0.0 && cos_prime > 0.0;
            let v = f64::from(u8::from(faces && room.visibility.unoccluded(a.centroid(), b.centroid())));
            hidden += usize::from(faces && v == 0.0);
            let classical = v * cos * cos_prime / (PI * r.length_squared()) * b.area();
            assert!((nystrom.entry(i, j) - classical).abs() <= 1e-12 * classical);
        }
        assert_eq!(nystrom.entry(i, i), 0.0);
    }
    assert!(hidden > 100);
}

/// A polygon as an element of the general theory: its centroid, and a rule of `points`² points.
fn element(polygon: &Polygon, points: usize) -> Element<SurfacePoint> {
    let normal = polygon.normal();
    let rule = gauss_legendre(points, 0.0, 1.0).squared();
    let quadrature = rule.map(|&[s, t], w| {
        (SurfacePoint { position: polygon.point(s, t), normal }, w * polygon.density(s, t))
    });
    Element { node: SurfacePoint::centroid(polygon), quadrature }
}

/// The walls of an empty room, whose pairs see each other whole, as elements.
fn empty_room(points: usize) -> (Patches<f64>, Visibility, Space<SurfacePoint>) {
    let scene = scene([walls(DVec3::ZERO, p(3.0, 2.0, 1.0), false).to_vec()], 0.5);
    let patches = Patches::new(&scene, 0.5).unwrap();
    let elements = patches.polygons.iter().map(|polygon| element(polygon, points)).collect();
    (patches, visibility(&scene), Space { elements })
}

fn touch(a: &Polygon, b: &Polygon) -> bool {
    a.vertices().iter().any(|v| b.vertices().iter().any(|w| v.distance(*w) < 1e-9))
}

#[test]
fn the_point_to_patch_form_factor_is_p0_collocation() {
    let (patches, visibility, space) = empty_room(16);
    let radiosity = FormFactors::point_to_patch(&patches, &visibility, 1e-3);
    let general = Collocation::new(Lambertian::new(&visibility), space);
    let n = patches.len();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        assert!((radiosity.entry(i, j) - general.entry(i, j)).abs() < 1e-9, "{i} {j}");
    }
}

#[test]
fn the_patch_to_patch_form_factor_is_p0_galerkin_the_mean_over_the_test_patch() {
    let (patches, visibility, space) = empty_room(6);
    let radiosity = FormFactors::patch_to_patch(&patches, &visibility, 1e-7);
    let general = Galerkin::new(Lambertian::new(&visibility), space.clone());
    let n = patches.len();
    for (i, j) in (0..n).flat_map(|i| (0..n).step_by(3).map(move |j| (i, j))) {
        let (a, b) = (&patches.polygons[i], &patches.polygons[j]);
        // The rule of the general method does not resolve patches that share an edge.
        if !touch(a, b) {
            assert!((radiosity.entry(i, j) - general.entry(i, j)).abs() < 1e-8, "{i} {j}");
        }
        let rule = &space.elements[i].quadrature;
        let mean = rule.integrate(|x| point_to_polygon(x.position, x.normal, b)) / a.area();
        assert!((radiosity.entry(i, j) - mean).abs() < if touch(a, b) { 2e-3 } else { 1e-8 }, "{i} {j}");
    }
}

/// The paper's algorithm 3.5.1, once around.
fn gather_literally(room: &Room, f: &FormFactors<'_>, b: &mut [Rgb]) {
    let Patches { emission: e, reflectance: rho, .. } = &room.patches;
    for i in 0..b.len() {
        let mut sum = BLACK;
        for j in (0..b.len()).filter(|&j| j != i) {
            sum += b[j] * f.entry(i, j);
        }
        b[i] = e[i] + rho[i] * sum;
    }
}

#[test]
fn gathering_is_gauss_seidel() {
    let room = room();
    let (f, matrix) = (room.form_factors(), room.matrix());
    let mut general = GaussSeidel::new(room.system(&matrix));
    let mut b = room.patches.emission.clone();
    for sweep in 0..4 {
        gather_literally(&room, &f, &mut b);
        general.sweep();
        assert!(distance(&b, &general.solution()) < 1e-13 * 20.0, "sweep {sweep}");
    }
}

/// The paper's algorithm 3.5.2, one shot: B and ΔB.
fn shoot_literally(room: &Room, f: &FormFactors<'_>, b: &mut [Rgb], delta: &mut [Rgb]) {
    let Patches { reflectance: rho, areas, .. } = &room.patches;
    let power = |i: usize| delta[i].magnitude() * areas[i];
    let i = (0..b.len()).fold(0, |best, i| if power(i) > power(best) { i } else { best });
    for j in (0..b.len()).filter(|&j| j != i) {
        let rad = delta[i] * rho[j] * f.entry(j, i);
        delta[j] += rad;
        b[j] += rad;
    }
    delta[i] = BLACK;
}

#[test]
fn progressive_radiosity_is_southwell_weighted_by_area_and_shows_u_plus_r() {
    let room = room();
    let f = room.form_factors();
    let on_the_fly = OnTheFly(room.form_factors());
    let mut general = Southwell::new(room.system(&on_the_fly), &room.patches.areas);
    let (mut b, mut delta) = (room.patches.emission.clone(), room.patches.emission.clone());
    // The areas matter: without them other patches would be shot on the way.
    let ones = vec![1.0; room.patches.len()];
    let mut unweighted = Southwell::new(room.system(&on_the_fly), &ones);
    let mut furthest_apart = 0.0_f64;
    for shot in 0..60 {
        shoot_literally(&room, &f, &mut b, &mut delta);
        general.sweep();
        assert!(distance(&b, &general.preview()) < 1e-13 * 20.0, "shot {shot}");
        assert!(distance(&delta, &general.residual()) < 1e-13 * 20.0, "shot {shot}");
        unweighted.sweep();
        furthest_apart = furthest_apart.max(distance(&unweighted.solution(), &general.solution()));
    }
    assert!(furthest_apart > 1e-3, "{furthest_apart}");
}

#[test]
fn reciprocity_is_self_adjointness_and_a_column_is_a_rescaled_row() {
    let room = room();
    let f = room.form_factors();
    let areas = &room.patches.areas;
    let n = f.dim();
    for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let (there, back) = (areas[i] * f.entry(i, j), areas[j] * f.entry(j, i));
        assert!((there - back).abs() <= 1e-15 * there, "{i} {j}");
    }
    // ⟨F u, v⟩ = ⟨u, F v⟩ for the product weighted by areas.
    let matrix = room.matrix();
    let (u, v): (Vec<f64>, Vec<f64>) = (0..n).map(|i| ((i as f64).sin(), (0.3 * i as f64).cos())).unzip();
    let image = |u: &[f64]| {
        let mut out = vec![0.0; n];
        fredholm::operator::Operator::apply(&matrix, u, &mut out);
        out
    };
    let product = |a: &[f64], b: &[f64]| (0..n).map(|i| areas[i] * a[i] * b[i]).sum::<f64>();
    assert!((product(&image(&u), &v) - product(&u, &image(&v))).abs() < 1e-12);
    let (mut row, mut buffer) = (vec![0.0; n], Vec::new());
    for j in [0, 17, n - 1] {
        f.row(j, 0, &mut row);
        let on_the_fly = OnTheFly(&f);
        let column = on_the_fly.column(j, &mut buffer);
        for i in 0..n {
            let rescaled = row[i] * areas[j] / areas[i];
            assert!((column.get(i) - rescaled).abs() <= 1e-15 * rescaled);
            assert!((column.get(i) - f.entry(i, j)).abs() <= 1e-15 * rescaled);
        }
    }
}

#[test]
fn the_kth_bounce_of_light_is_the_kth_term_of_the_neumann_series() {
    let room = room();
    let (f, matrix) = (room.form_factors(), room.matrix());
    let mut general = SuccessiveApproximation::new(room.system(&matrix));
    let mut bounce = room.patches.emission.clone();
    for k in 0..4 {
        assert!(distance(&bounce, &general.residual()) < 1e-13 * 20.0, "bounce {k}");
        let arriving = |i: usize| (0..bounce.len()).fold(BLACK, |sum, j| sum + bounce[j] * f.entry(i, j));
        bounce = (0..bounce.len()).map(|i| room.patches.reflectance[i] * arriving(i)).collect();
        general.sweep();
    }
}

#[test]
fn the_ambient_term_is_the_estimated_rest_of_the_neumann_series() {
    // Cohen et al. 1988: Ambient = R Σ ΔB_i A_i / Σ A_i with R = 1 + ρ̄ + ρ̄² + …, and the picture B_i + ρ_i Ambient.
    let room = room();
    let on_the_fly = OnTheFly(room.form_factors());
    let Patches { reflectance, areas, .. } = &room.patches;
    let mut plain = Southwell::new(room.system(&on_the_fly), areas);
    let mut ambient = Southwell::new(room.system(&on_the_fly), areas).with_ambient();
    for _ in 0..5 {
        plain.sweep();
        ambient.sweep();
    }
    let total: f64 = areas.iter().sum();
    let mean =
        |values: &[Rgb], k: usize| values.iter().zip(areas).map(|(v, a)| v.0[k] * a).sum::<f64>() / total;
    let unshot = plain.residual();
    for k in 0..3 {
        let series: f64 = (0..200).map(|power| mean(reflectance, k).powi(power)).sum();
        let classical = series * mean(&unshot, k);
        assert!((estimated_rest(&unshot, reflectance, areas).0[k] / classical - 1.0).abs() < 1e-12);
        let pictures = plain.preview().into_iter().zip(ambient.preview()).zip(reflectance);
        for ((without, with), rho) in pictures {
            assert!((with.0[k] - (without.0[k] + rho.0[k] * classical)).abs() < 1e-12);
        }
    }
}

#[test]
fn the_final_gather_is_nystroms_interpolant() {
    // φ(x) = f(x) + ρ(x) Σ_j K(x, x_j) w_j u_j: through the nodes, and between them the light that x sees.
    let room = room();
    let Patches { reflectance, emission, polygons, areas, .. } = &room.patches;
    let nystrom = point_to_point(&room.patches, &room.visibility);
    let matrix = Dense::<f64>::assemble(&nystrom, |_| ()).unwrap();
    let u = fredholm::direct::solve(room.system(&matrix));
    for i in [0, 40, 77] {
        let through = emission[i] + reflectance[i] * nystrom.apply_at(&nystrom.nodes()[i], &u);
        assert!((through - u[i]).magnitude() < 1e-12);
    }
    let x = SurfacePoint { position: p(3.1, 0.2, 0.0), normal: DVec3::Z };
    let gathered = (0..u.len()).fold(BLACK, |sum, j| {
        let y = SurfacePoint::centroid(&polygons[j]);
        let seen = room.visibility.unoccluded(x.position, y.position);
        if seen { sum + u[j] * (unoccluded(&x, &y) * areas[j]) } else { sum }
    });
    assert!(gathered.magnitude() > 0.1);
    assert!((gathered - nystrom.apply_at(&x, &u)).magnitude() < 1e-12);
}

#[test]
fn inside_a_sphere_the_kernel_is_degenerate_of_rank_one_and_the_solution_closed() {
    // K = 1/(4πR²) whatever x and y.
    let nothing = Visibility::new(&[]);
    let kernel = Lambertian::new(&nothing);
    let on_sphere = |polar: f64, turn: f64| {
        let out = p(polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos());
        SurfacePoint { position: 3.0 * out, normal: -out }
    };
    for (a, b) in [(0.3, 2.0), (1.0, 1.1), (3.0, 0.1)] {
        let k = kernel.at(&on_sphere(a, b), &on_sphere(b, a * 2.0));
        assert!((k * 4.0 * PI * 9.0 - 1.0).abs() < 1e-10, "{k}");
    }
    // So B = E + ρ ⟨E⟩/(1 − ⟨ρ⟩): here E = 1 + cos², ρ = ½ + 0.3 cos, and H = (4/3)/(1/2) = 8/3. Nyström on a Gauss
    // rule of the sphere reaches rounding.
    let polar = gauss_legendre(12, -1.0, 1.0);
    let turns = 24;
    let mut rule = Quadrature { nodes: Vec::new(), weights: Vec::new() };
    for (z, w) in polar.nodes.iter().zip(&polar.weights) {
        for k in 0..turns {
            rule.nodes.push(on_sphere(z.acos(), (f64::from(k) + 0.5) * 2.0 * PI / f64::from(turns)));
            rule.weights.push(9.0 * w * 2.0 * PI / f64::from(turns));
        }
    }
    let cosine = |x: &SurfacePoint| -x.normal.z;
    let e: Vec<f64> = rule.nodes.iter().map(|x| 1.0 + cosine(x).powi(2)).collect();
    let rho: Vec<f64> = rule.nodes.iter().map(|x| 0.5 + 0.3 * cosine(x)).collect();
    // The limit at x = y of a curved surface's kernel is not that of a flat one.
    let curved =
        |x: &SurfacePoint, y: &SurfacePoint| if x == y { 1.0 / (36.0 * PI) } else { kernel.at(x, y) };
    let matrix = Dense::<f64>::assemble(&Nystrom::new(curved, rule), |_| ()).unwrap();
    let u = fredholm::direct::solve(System::new(&e, &rho, &matrix).unwrap());
    for i in 0..u.len() {
        assert!((u[i] - (e[i] + rho[i] * 8.0 / 3.0)).abs() < 1e-9, "{i}");
    }
}

#[test]
fn a_white_furnace_has_the_radiosity_e_over_one_minus_rho() {
    // Closed, E and ρ constant: F·1 = 1, so B = E/(1 − ρ). A box, and the inside of a polyhedral sphere.
    let furnace = |polygons: Vec<Polygon>, size: f64, solver: Solver| {
        let mut furnace: Scene<f64> = scene([polygons], 0.75);
        furnace.surfaces[0].emission = 2.0;
        let patches = Patches::new(&furnace, size).unwrap();
        let options = Options {
            method: Method::Galerkin,
            solver,
            accuracy: 1e-4,
            tolerance: 1e-10,
            iterations: 100_000,
            memory: 1 << 30,
            ..Options::default()
        };
        let solution = solve(&patches, &visibility(&furnace), &options, &mut Unobserved).unwrap();
        distance(&solution.radiosity, &vec![8.0; patches.len()])
    };
    let box_walls = walls(DVec3::ZERO, p(3.0, 2.0, 1.0), false).to_vec();
    for solver in [Solver::GaussSeidel, Solver::Southwell, Solver::Gmres, Solver::Direct] {
        let error = furnace(box_walls.clone(), 0.6, solver);
        assert!(error < 1e-4, "{solver:?}: {error:e}");
    }
    let error = furnace(sphere(8), 1.0, Solver::Jacobi);
    assert!(error < 1e-4, "{error:e}");
}
