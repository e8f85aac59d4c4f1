//! Links to clusters against the matrix that they stand for.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

use fredholm::operator::{Columns, Gather, Line, Matrix, Operator, Rows, Shoot, TransposedOperator};
use fredholm::relax::{GaussSeidel, Outcome, Relaxation, Southwell, Stop, relax};
use fredholm::system::System;
use fredholm::value::{Rgb, Value, max_norm};
use radiosity::hierarchical::{Hierarchical, Kept, Light, Plan, clusters_bytes};
use radiosity::patches::{Patches, size_for_count};
use radiosity::scene::{Scene, cornell_box};
use radiosity::solve::{Options, Solution, SolveError, Solver, Storage, Unobserved, solve};
use radiosity::visibility::Visibility;
use std::sync::atomic::{AtomicU64, Ordering};

#[path = "../benches/scenes/mod.rs"]
mod scenes;

fn cut(scene: &Scene<Rgb>, count: usize) -> (Patches<Rgb>, Visibility) {
    (Patches::new(scene, size_for_count(scene, count)).unwrap(), Visibility::new(&scene.polygons()))
}

fn linked(patches: &Patches<Rgb>, visibility: &Visibility, part: f64) -> Hierarchical {
    let light = Light::ambient(patches, &patches.emission);
    Plan::new(patches, visibility).assemble(&light, part, 7, |_| ())
}

fn solved(patches: &Patches<Rgb>, visibility: &Visibility, storage: Storage, accuracy: f64) -> Solution<Rgb> {
    let options = Options { storage, accuracy, solver: Solver::Gmres, ..Options::default() };
    solve(patches, visibility, &options, &mut Unobserved).unwrap()
}

/// ‖u − v‖ / ‖v‖ in L².
fn distance(patches: &Patches<Rgb>, u: &[Rgb], v: &[Rgb]) -> f64 {
    let square = |x: Rgb| x.channels().iter().map(|c| c * c).sum::<f64>();
    let norm = |of: &dyn Fn(usize) -> f64| (0..v.len()).map(|i| patches.areas[i] * of(i)).sum::<f64>().sqrt();
    norm(&|i| square(u[i] - v[i])) / norm(&|i| square(v[i]))
}

/// The standard error of a row of the matrix that links are compared to.
const OWN: f64 = 3e-4;

#[test]
fn links_bring_what_the_matrix_brings_within_the_error_that_they_tell() {
    for (scene, count) in [
        (cornell_box(), 1000),
        (scenes::boxes(), 1500),
        (scenes::terrain(1000), 1000),
        (scenes::building(2, 1), 1000),
    ] {
        let (patches, visibility) = cut(&scene, count);
        // The matrix has an error of its own: sampled rows, of which each errs by so much.
        let dense = solved(&patches, &visibility, Storage::Dense, OWN);
        for accuracy in [3e-3, 3e-4] {
            let found = solved(&patches, &visibility, Storage::Hierarchical, accuracy);
            let told = found.links.unwrap().judged;
            let error = distance(&patches, &found.radiosity, &dense.radiosity);
            let reflected = |u: &[Rgb]| {
                (0..u.len()).map(|i| patches.areas[i] * (u[i] - patches.emission[i]).magnitude()).sum::<f64>()
            };
            let gained = reflected(&found.radiosity) / reflected(&dense.radiosity) - 1.0;
            let name = &scene.name;
            println!(
                "{name} {accuracy}: {error:.2e} told {:.2e} and {:.2e}, {gained:.2e} more",
                told.links, told.error
            );
            // Noise has a mean of nothing. With what hides dark places, or has parts that face apart, light was lost once: 2 % of the
            // hall's, and 6 % with more patches.
            assert!(gained.abs() < 0.015, "{name} {accuracy}: light is {gained} more");
            assert!(error < told.error, "{} {accuracy}: {error} of {}", scene.name, told.error);
            // What is told of links alone is an estimate from a sample, and mostly above the error: README, "How far to trust it".
            assert!(error < 1.2 * told.links + OWN && told.links < 0.012, "{error} of {}", told.links);
        }
    }
}

#[test]
fn rows_columns_and_both_actions_are_of_one_matrix() {
    let (patches, visibility) = cut(&cornell_box(), 400);
    let operator = linked(&patches, &visibility, 0.3);
    let n = operator.dim();
    let mut buffer = Vec::new();
    let rows: Vec<Vec<f64>> = (0..n).map(|i| operator.row(i, &mut buffer).iter().collect()).collect();
    let (mut image, mut shot) = (vec![0.0; n], vec![0.0; n]);
    let u: Vec<f64> = (0..n).map(|i| (0.37 * i as f64).sin()).collect();
    operator.apply(&u, &mut image);
    operator.apply_transposed(&u, &mut shot);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
    for i in 0..n {
        assert_eq!(rows[i][i], operator.diagonal(i));
        assert!(close(image[i], rows[i].iter().zip(&u).map(|(f, u)| f * u).sum()));
        assert!(close(shot[i], (0..n).map(|k| rows[k][i] * u[k]).sum()));
        let column: Vec<f64> = operator.column(i, &mut buffer).iter().collect();
        assert!((0..n).all(|k| close(column[k], rows[k][i])));
    }
    // A cluster sends by area: patches of unlike areas are among them.
    assert!(
        rows.iter().flatten().filter(|factor| **factor > 0.0).count() as u64 > operator.statistics().links
    );
}

#[test]
fn the_same_digits_come_from_any_number_of_threads() {
    let (patches, visibility) = cut(&scenes::building(2, 1), 1000);
    let sums = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let operator = linked(&patches, &visibility, 0.1);
            let (mut image, mut shot) = (vec![0.0; patches.len()], vec![0.0; patches.len()]);
            operator.apply(&patches.areas, &mut image);
            operator.apply_transposed(&patches.areas, &mut shot);
            (image, shot)
        })
    };
    assert_eq!(sums(1), sums(3));
}

/// Links that are asked for no line, and count what is received of shots.
struct NoLines<'a>(&'a Hierarchical, AtomicU64);

impl Matrix for NoLines<'_> {
    fn dim(&self) -> usize {
        self.0.dim()
    }
    fn diagonal(&self, i: usize) -> f64 {
        self.0.diagonal(i)
    }
}

impl Rows for NoLines<'_> {
    fn row<'a>(&'a self, _: usize, _: &'a mut Vec<f64>) -> Line<'a> {
        panic!("a row has as many numbers as there are patches")
    }
    fn act<V: Value>(&self, u: &[V], out: &mut [V]) {
        self.0.act(u, out);
    }
    fn gathering<'a, V: Value>(&'a self) -> Option<Box<dyn Gather<V> + 'a>> {
        self.0.gathering()
    }
}

impl Columns for NoLines<'_> {
    fn column<'a>(&'a self, _: usize, _: &'a mut Vec<f64>) -> Line<'a> {
        panic!("a column has as many numbers as there are patches")
    }
    fn shooting<'a, V: Value>(&'a self) -> Option<Box<dyn Shoot<V> + 'a>> {
        Some(Box::new(Counted(self.0.shooting()?, &self.1)))
    }
}

#[derive(Debug)]
struct Counted<'a, V>(Box<dyn Shoot<V> + 'a>, &'a AtomicU64);

impl<V: Value> Shoot<V> for Counted<'_, V> {
    fn send(&mut self, j: usize, step: V) {
        self.0.send(j, step);
    }
    fn held(&self) -> f64 {
        self.0.held()
    }
    fn deliver(&mut self, receive: &mut dyn FnMut(&[usize], &[V])) {
        self.0.deliver(&mut |unknowns, received| {
            self.1.fetch_add(unknowns.len() as u64, Ordering::Relaxed);
            receive(unknowns, received);
        });
    }
    fn outstanding(&self) -> Vec<V> {
        self.0.outstanding()
    }
}

#[test]
fn gathering_and_shooting_by_links_solve_what_the_action_does() {
    for scene in [cornell_box(), scenes::building(2, 1)] {
        let (patches, visibility) = cut(&scene, 1500);
        let operator = linked(&patches, &visibility, 0.1);
        let links = NoLines(&operator, AtomicU64::new(0));
        let (source, rho) = (&patches.emission, &patches.reflectance);
        let system = System::new(source, rho, &links).unwrap();
        let stop = |part: f64| Stop { residual: part * max_norm(source), sweeps: 1_000_000 };
        let mut exact = GaussSeidel::new(system);
        assert_eq!(relax(&mut exact, stop(1e-9), |_, _, _| true).outcome, Outcome::Converged);
        let residual = max_norm(&system.residual(&exact.solution()));
        assert!(residual <= 1e-9 * max_norm(source), "{residual}");

        let mut gathered = GaussSeidel::new(system);
        let mut shot = Southwell::new(system, &patches.areas);
        let report = relax(&mut gathered, stop(1e-4), |_, _, _| true);
        // Fewer sweeps than bounces: what is gathered is used at once.
        let mut bounces = fredholm::relax::SuccessiveApproximation::new(system);
        let plain = relax(&mut bounces, stop(1e-4), |_, _, _| true);
        assert!(report.residuals.len() < plain.residuals.len(), "{} sweeps", report.residuals.len());
        let shots = relax(&mut shot, stop(1e-4), |_, _, _| true);
        assert_eq!(shots.outcome, Outcome::Converged);
        // What it carries is the residual of its solution, and F times that.
        let (carried, residual) = (shot.residual(), system.residual(&shot.solution()));
        let apart: Vec<Rgb> = carried.iter().zip(&residual).map(|(r, s)| *r - *s).collect();
        assert!(max_norm(&apart) < 1e-9 * max_norm(source));
        let mut image = vec![Rgb::splat(0.0); patches.len()];
        operator.apply(&shot.solution(), &mut image);
        let sums = shot.gathered().iter().zip(&image).map(|(g, h)| *g - *h).collect::<Vec<_>>();
        assert!(max_norm(&sums) < 1e-9 * max_norm(source));
        for solution in [gathered.solution(), shot.solution()] {
            let error = distance(&patches, &solution, &exact.solution());
            assert!(error < 1e-3, "{}: {error}", scene.name);
        }
        // As many shots as would be n columns are received over as many links as there are, some times.
        let each = links.1.load(Ordering::Relaxed) as f64 / shots.residuals.len() as f64;
        let in_row = operator.statistics().links as f64 / patches.len() as f64;
        println!(
            "{}: {} shots, {each:.0} received each, {in_row:.0} links a patch",
            scene.name,
            shots.residuals.len()
        );
        assert!(each < 2.0 * in_row, "{}: {each} received of a shot, {in_row} links a patch", scene.name);
    }
}

#[test]
fn in_an_empty_room_rows_add_up_to_one_without_a_ray() {
    let mut scene = scenes::building(1, 1);
    scene.surfaces.truncate(1);
    scene.surfaces[0].emission = Rgb::splat(1.0);
    let (patches, visibility) = cut(&scene, 3000);
    let operator = linked(&patches, &visibility, 0.03);
    let mut sums = vec![0.0; patches.len()];
    operator.apply(&vec![1.0; patches.len()], &mut sums);
    let worst = sums.iter().map(|sum| (sum - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst < 0.02 && operator.statistics().rays == 0, "{worst}");
    // B = E / (1 − ρ) of a furnace.
    let found = solved(&patches, &visibility, Storage::Hierarchical, 3e-4);
    let furnace = vec![Rgb::splat(1.0 / 0.3); patches.len()];
    let error = distance(&patches, &found.radiosity, &furnace);
    assert!(error < 0.01, "{error}");
}

#[test]
fn four_times_the_patches_have_little_more_than_four_times_the_links() {
    for scene in [cornell_box(), scenes::building(2, 1)] {
        let links = |count: usize| {
            let (patches, visibility) = cut(&scene, count);
            linked(&patches, &visibility, 0.3).statistics().links as f64 / patches.len() as f64
        };
        let growth = links(8000) / links(2000);
        assert!(growth < 1.4, "{}: {growth}", scene.name);
    }
}

#[test]
fn a_picture_shows_who_gathers_from_what() {
    let pictured = |scene: &Scene<Rgb>, count: usize| {
        let (patches, visibility) = cut(scene, count);
        let links = linked(&patches, &visibility, 0.1);
        let picture = links.picture();
        let (patches_told, links_told) = (patches.len(), links.statistics().links);
        let title = format!("{patches_told} patches, down, gather by {links_told} links");
        assert!(picture.contains(&title), "{}", &picture[..600]);
        assert!(picture.len() < 4 << 20 && picture.ends_with("</svg>\n"));
        // The parts of the area that are blue, orange and white: 960 squared in all.
        let areas = |colours: &[&str]| {
            let of = |line: &str, name: &str| -> f64 {
                line.split(&format!("{name}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
            };
            let drawn = picture.lines().filter(|line| colours.iter().any(|colour| line.contains(colour)));
            drawn.map(|line| of(line, " width") * of(line, " height")).sum::<f64>() / (960.0 * 960.0)
        };
        let all = areas(&["#08306b", "#08519c", "#2171b5", "#4292c6", "#6baed6", "#9ecae1"]);
        let some = areas(&["#7f2704", "#a63603", "#d94801", "#f16913", "#fd8d3c", "#fdae6b"]);
        // So do the rows: of blue no entry is 0, and of what is neither most are.
        let mut buffer = Vec::new();
        let sees = |i: usize| links.row(i, &mut buffer).iter().filter(|factor| *factor > 0.0).count();
        let seen = (0..patches.len()).map(sees).sum::<usize>() as f64 / (patches.len() as f64).powi(2);
        assert!(all - 0.05 < seen && seen < all + some + 0.05, "{seen}, of which {all} and {some}");
        [all, some]
    };
    // In an empty cube a wall sees the other five, and all of each; where two meet a receiver has patches of both.
    let mut empty = scenes::building(1, 1);
    empty.surfaces.truncate(1);
    empty.surfaces[0].emission = Rgb::splat(1.0);
    let [all, some] = pictured(&empty, 600);
    assert!((0.6..0.84).contains(&all) && some < 0.25, "{all} and {some}");
    // Through doors some patches of a receiver see what others do not.
    let [all, some] = pictured(&scenes::building(2, 1), 3000);
    assert!(some > all, "{all} and {some}");
}

#[test]
fn memory_is_known_before_it_is_taken() {
    let (patches, visibility) = cut(&scenes::boxes(), 4000);
    let plan = Plan::new(&patches, &visibility);
    let light = Light::ambient(&patches, &patches.emission);
    let planned = plan.bytes(&light, 0.1) as f64;
    let taken = plan.assemble(&light, 0.1, 7, |_| ()).statistics().bytes as f64;
    assert!((0.7..1.1).contains(&(taken / planned)), "{taken} of {planned}");
}

#[test]
fn links_that_do_not_fit_are_refused_with_advice() {
    let (patches, visibility) = cut(&cornell_box(), 2000);
    let refused = |options: Options| solve(&patches, &visibility, &options, &mut Unobserved).unwrap_err();
    // Before there are clusters, and before there are links.
    for memory in [1 << 20, clusters_bytes(patches.len())] {
        let options = Options { storage: Storage::Hierarchical, memory, ..Options::default() };
        let error = refused(options).to_string();
        let told = error.contains("clusters of 2000 patches and their links take about");
        assert!(told && error.contains("larger patches"), "{error}");
    }
    // LU makes a matrix of them, however they are kept.
    for storage in [Storage::Hierarchical, Storage::OnTheFly] {
        let options = Options { storage, solver: Solver::Direct, memory: 8 << 20, ..Options::default() };
        let error = refused(options);
        assert!(matches!(error, SolveError::Memory { patches: 2000, .. }), "{error}");
    }
}

#[test]
fn what_is_kept_halfway_is_gone_on_with() {
    let (patches, visibility) = cut(&scenes::boxes(), 3000);
    let (plan, part, seed) = (Plan::new(&patches, &visibility), 0.1, 7);
    let light = Light::ambient(&patches, &patches.emission);
    let none = Kept::none(&plan, light.clone(), part, &patches.emission);
    let done = AtomicU64::new(0);
    let progress = |patches: usize| {
        done.fetch_add(patches as u64, Ordering::Relaxed);
    };
    let half = plan.go_on(none, part, seed, (progress, || done.load(Ordering::Relaxed) >= 1000)).unwrap_err();
    assert!((1000..patches.len()).contains(&half.patches()), "{} of {}", half.patches(), patches.len());

    let mut file = Vec::new();
    half.write(&mut file).unwrap();
    let read = Kept::read(&plan, part, &patches.emission, &mut file.as_slice()).unwrap();
    assert_eq!(read, half);
    let resumed = plan.go_on(read, part, seed, (|_| (), || false)).unwrap();
    let whole = plan.assemble(&light, part, seed, |_| ());
    assert_eq!(resumed.statistics(), whole.statistics());
    let act = |links: &Hierarchical| {
        let mut image = vec![Rgb::splat(0.0); patches.len()];
        links.apply(&patches.reflectance, &mut image);
        image
    };
    assert_eq!(act(&resumed), act(&whole));
}
