//! Rays, certificates and builds a second, on one thread.
#![allow(missing_docs)]

#[path = "../tests/rooms/mod.rs"]
mod rooms;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;
use radiosity::polygon::Polygon;
use radiosity::visibility::Visibility;
use rooms::Random;

const RAYS: usize = 1 << 17;

fn main() {
    divan::main();
}

/// The scenes: the Cornell box of 32 triangles, and a room with 108 000.
const SCENES: [&str; 2] = ["cornell", "room"];

fn scene(name: &str) -> Vec<Polygon> {
    if name == "cornell" { rooms::cornell() } else { rooms::furnished(7) }
}

/// Segments from surface to surface; all ends of `group` in a row start at one point.
fn segments(polygons: &[Polygon], group: usize) -> Vec<(DVec3, DVec3)> {
    let mut random = Random(1);
    let starts = rooms::points(polygons, RAYS / group, &mut random);
    let ends = rooms::points(polygons, RAYS, &mut random);
    ends.into_iter().enumerate().map(|(k, end)| (starts[k / group], end)).collect()
}

fn occlusion(bencher: Bencher<'_, '_>, name: &str, group: usize) {
    let polygons = scene(name);
    let visibility = Visibility::new(&polygons);
    let segments = segments(&polygons, group);
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        segments.iter().filter(|&&(s, t)| visibility.unoccluded(black_box(s), black_box(t))).count()
    });
}

#[divan::bench(args = SCENES)]
fn occlusion_incoherent(bencher: Bencher<'_, '_>, name: &str) {
    occlusion(bencher, name, 1);
}

#[divan::bench(args = SCENES)]
fn occlusion_by_origin(bencher: Bencher<'_, '_>, name: &str) {
    occlusion(bencher, name, 256);
}

#[divan::bench(args = SCENES)]
fn nearest(bencher: Bencher<'_, '_>, name: &str) {
    let polygons = scene(name);
    let visibility = Visibility::new(&polygons);
    let rays: Vec<_> =
        segments(&polygons, 1).into_iter().map(|(s, t)| (s, (t - s).normalize_or(DVec3::X))).collect();
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        rays.iter().filter(|&&(s, d)| visibility.nearest(black_box(s), black_box(d)).is_some()).count()
    });
}

#[divan::bench(args = SCENES, sample_count = 10)]
fn build(bencher: Bencher<'_, '_>, name: &str) {
    let polygons = scene(name);
    bencher.bench_local(|| Visibility::new(black_box(&polygons)));
}

#[divan::bench]
fn certainly_clear(bencher: Bencher<'_, '_>) {
    let polygons = rooms::cornell();
    let visibility = Visibility::new(&polygons);
    let pairs = rooms::facing_pairs(&polygons, 4, 1 << 15);
    bencher.counter(ItemsCount::new(pairs.len())).bench_local(|| {
        pairs.iter().filter(|(a, b)| visibility.certainly_clear(black_box(a), black_box(b))).count()
    });
}
