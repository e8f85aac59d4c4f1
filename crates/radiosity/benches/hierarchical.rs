//! Very many patches: time, memory, links and error of the hierarchical operator on four scenes.
//!
//! `cargo bench -p radiosity --bench hierarchical [-- PATCHES …]`.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark prints what it measures")]

mod scenes;

use fredholm::krylov::Gmres;
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::system::System;
use fredholm::value::{Rgb, Value, max_norm};
use radiosity::hierarchical::{Hierarchical, Light, Plan};
use radiosity::patches::{Patches, size_for_count};
use radiosity::scene::{Scene, cornell_box};
use radiosity::visibility::Visibility;
use std::time::Instant;

fn main() {
    let given: Vec<f64> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let part = given.first().copied().unwrap_or(0.01);
    let counts: Vec<usize> = given[1..].iter().map(|n| *n as usize).collect();
    let names: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word.parse::<f64>().is_err() && !word.starts_with('-'))
        .collect();
    println!(
        "{:>10} {:>9} {:>8} {:>8} {:>7} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7}",
        "scene", "patches", "links/n", "rays/n", "MB", "told", "links", "patches", "true", "build", "solve"
    );
    for n in counts {
        let building = (n as f64 / 2500.0).sqrt().ceil() as usize;
        for scene in
            [cornell_box(), scenes::boxes(), scenes::terrain(n), scenes::building(building.clamp(2, 12))]
        {
            if names.is_empty() || names.iter().any(|name| scene.name.contains(name.as_str())) {
                row(&scene, n, part);
            }
        }
    }
}

fn solve(operator: &Hierarchical, patches: &Patches<Rgb>, source: &[Rgb]) -> [Vec<Rgb>; 2] {
    let system = System::new(source, &patches.reflectance, operator).unwrap();
    let mut gmres = Gmres::new(system);
    let stop = Stop { residual: 1e-4 * max_norm(source), sweeps: 60 };
    let report = relax(&mut gmres, stop, |_, _, _| true);
    let u = gmres.solution();
    let mut h = vec![Rgb::splat(0.0); u.len()];
    fredholm::operator::Operator::apply(operator, &u, &mut h);
    let _ = report;
    [u, h]
}

fn row(scene: &Scene<Rgb>, n: usize, part: f64) {
    let patches = Patches::new(scene, size_for_count(scene, n)).unwrap();
    let visibility = Visibility::new(&scene.polygons());
    let source = patches.emission.clone();
    let start = Instant::now();
    let plan = Plan::new(&patches, &visibility);
    let tree = start.elapsed().as_secs_f64();
    let light = Light::ambient(&patches, &source);
    let first = plan.sketch(&light, part, 1);
    let t1 = start.elapsed().as_secs_f64();
    let [u, h] = solve(&first, &patches, &source);
    let light = Light::of(&patches, &u, &h);
    let t2 = start.elapsed().as_secs_f64();
    let operator = plan.assemble(&light, part, 2, |_| ());
    let build = start.elapsed().as_secs_f64();
    let [u, h] = solve(&operator, &patches, &source);
    let solved = start.elapsed().as_secs_f64();
    let light = Light::of(&patches, &u, &h);
    let judged = plan.judge(&source, &u, &light, part);
    let told = start.elapsed().as_secs_f64();
    let truth = if patches.len() <= 8_000 {
        let finer = plan.assemble(&light, 0.003, 77, |_| ());
        let [v, _] = solve(&finer, &patches, &source);
        let norm =
            |a: &dyn Fn(usize) -> f64| (0..v.len()).map(|i| patches.areas[i] * a(i)).sum::<f64>().sqrt();
        if std::env::var("DUMP").is_ok() {
            let mut worst: Vec<(f64, usize)> =
                (0..v.len()).map(|i| (patches.areas[i] * (u[i] - v[i]).magnitude().powi(2), i)).collect();
            worst.sort_by(|a, b| b.0.total_cmp(&a.0));
            for (name, op) in [("operator", &operator), ("finer", &finer)] {
                let ones = vec![1.0; v.len()];
                let mut sums = vec![0.0; v.len()];
                fredholm::operator::Operator::apply(op, &ones, &mut sums);
                for surface in 0..scene.surfaces.len() {
                    let of = || (0..v.len()).filter(|i| patches.surface[*i] as usize == surface);
                    let mean = of().map(|i| patches.areas[i] * sums[i]).sum::<f64>()
                        / of().map(|i| patches.areas[i]).sum::<f64>();
                    println!("{name} {}: mean row sum {mean:.4}", scene.surfaces[surface].name);
                }
                println!(
                    "{name} ceiling {:.4} links {}",
                    (1000..1600)
                        .filter(|i| patches.polygons[*i].normal().z < -0.9)
                        .map(|i| sums[i])
                        .sum::<f64>()
                        / (1000..1600).filter(|i| patches.polygons[*i].normal().z < -0.9).count() as f64,
                    op.statistics().links
                );
            }
            let total: f64 = worst.iter().map(|w| w.0).sum();
            let mut sum = 0.0;
            for (k, (w, i)) in worst.iter().enumerate() {
                sum += w;
                if k < 25 || k.is_power_of_two() {
                    let p = &patches.polygons[*i];
                    println!(
                        "{k:>6} {:.3} {i} at {:.2} n {:.1} u {:.4} v {:.4}",
                        sum / total,
                        p.centroid(),
                        p.normal(),
                        u[*i].magnitude(),
                        v[*i].magnitude()
                    );
                }
            }
        }
        let square = |x: Rgb| x.channels().iter().map(|c| c * c).sum::<f64>();
        norm(&|i| square(u[i] - v[i])) / norm(&|i| square(v[i]))
    } else {
        f64::NAN
    };
    let s = operator.statistics();
    let n = patches.len() as f64;
    println!(
        "{:>10} {:>9} {:>8.1} {:>8.1} {:>7} {:>7.2}% {:>6.2}% {:>6.2}% {:>6.2}% {:>7.2} {:>7.2}   tree {tree:.2} first {t1:.2} solve {t2:.2} judge {:.2}",
        scene.name,
        patches.len(),
        s.links as f64 / n,
        s.rays as f64 / n,
        s.bytes >> 20,
        100.0 * judged.error,
        100.0 * judged.links,
        100.0 * judged.patches,
        100.0 * truth,
        build,
        solved,
        told - solved
    );
}
