//! Form factors a second, on one thread.
#![allow(missing_docs)]

#[path = "../tests/rooms/mod.rs"]
mod rooms;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use fredholm::discretize::Coupling;
use fredholm::value::Rgb;
use radiosity::form_factor::exchange::Unoccluded;
use radiosity::form_factor::lambert::point_to_polygon;
use radiosity::form_factor::{FormFactors, point_to_point};
use radiosity::patches::{Patches, size_for_count};
use radiosity::scene::{cornell_box, load};
use radiosity::visibility::Visibility;
use rooms::Random;
use std::path::Path;

fn main() {
    divan::main();
}

/// The scenes, in some 2000 patches each: the Cornell box, and a closed gallery with columns and furniture.
const SCENES: [&str; 2] = ["cornell", "gallery"];

/// The standard error of a row sum: the default of the command line.
const ACCURACY: f64 = 1e-3;

/// A scene as the solver sees it.
struct Domain {
    patches: Patches<Rgb>,
    visibility: Visibility,
}

fn domain(name: &str) -> Domain {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gallery/gallery.toml");
    let scene = if name == "cornell" { cornell_box() } else { load(&gallery).expect("a scene").scene };
    let polygons: Vec<_> = scene.surfaces.iter().flat_map(|s| s.polygons.iter().cloned()).collect();
    Domain {
        patches: Patches::new(&scene, size_for_count(&scene, 2000)).expect("patches"),
        visibility: Visibility::new(&polygons),
    }
}

/// Whole rows, spread over the scene.
fn rows(bencher: Bencher<'_, '_>, coupling: &impl Coupling) {
    const ROWS: usize = 32;
    let n = coupling.dim();
    let mut row = vec![0.0; n];
    bencher.counter(ItemsCount::new(ROWS * n)).bench_local(|| {
        for k in 0..ROWS {
            coupling.row((2 * k + 1) * n / (2 * ROWS), 0, &mut row);
            black_box(&row);
        }
    });
}

#[divan::bench(args = SCENES, sample_count = 20)]
fn galerkin(bencher: Bencher<'_, '_>, name: &str) {
    let Domain { patches, visibility } = domain(name);
    rows(bencher, &FormFactors::patch_to_patch(&patches, &visibility, ACCURACY));
}

#[divan::bench(args = SCENES, sample_count = 20)]
fn collocation(bencher: Bencher<'_, '_>, name: &str) {
    let Domain { patches, visibility } = domain(name);
    rows(bencher, &FormFactors::point_to_patch(&patches, &visibility, ACCURACY));
}

#[divan::bench(args = SCENES, sample_count = 20)]
fn nystrom(bencher: Bencher<'_, '_>, name: &str) {
    let Domain { patches, visibility } = domain(name);
    rows(bencher, &point_to_point(&patches, &visibility));
}

/// Pairs of patches of an empty cube that face each other, by distance in diameters. `touching` ones share a corner
/// or an edge; `near` ones are integrated by Lambert's formula, `middling` ones by 4 × 4 nodes and `far` ones by 2 × 2.
#[divan::bench(args = ["touching", "near", "middling", "far"])]
fn exchange(bencher: Bencher<'_, '_>, name: &str) {
    const PAIRS: usize = 1 << 10;
    let distances = match name {
        "touching" => 0.0..0.8,
        "near" => 0.8..1.2,
        "middling" => 1.3..3.7,
        _ => 3.8..99.0,
    };
    let polygons = rooms::cube(1.0, 16);
    let exchange = Unoccluded::new(&polygons, 0.1 * ACCURACY);
    let mut random = Random(5);
    let mut pairs = Vec::new();
    while pairs.len() < PAIRS {
        let (i, j) = (random.below(polygons.len()), random.below(polygons.len()));
        let (a, b) = (&polygons[i], &polygons[j]);
        let distance = a.centroid().distance(b.centroid()) / a.diameter();
        if a.normal() != b.normal() && distances.contains(&distance) {
            pairs.push((i, j));
        }
    }
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        pairs.iter().map(|&(i, j)| exchange.between(black_box(&polygons), i, j).value).sum::<f64>()
    });
}

/// Lambert's formula from points that see a whole quadrilateral or triangle.
#[divan::bench]
fn lambert(bencher: Bencher<'_, '_>) {
    let pairs = rooms::facing_pairs(&rooms::cornell(), 4, 1 << 12);
    bencher.counter(ItemsCount::new(pairs.len())).bench_local(|| {
        let factors = pairs.iter().map(|(a, b)| point_to_polygon(a.centroid(), a.normal(), black_box(b)));
        factors.sum::<f64>()
    });
}
