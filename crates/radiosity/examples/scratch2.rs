#![allow(missing_docs, clippy::all)]
use fredholm::discretize::Coupling;
use radiosity::*;
fn main() {
    let file = std::env::args().nth(1).unwrap();
    let size: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let scene = scene::load(std::path::Path::new(&file)).unwrap().scene;
    let patches = patches::Patches::new(&scene, size).unwrap();
    let polys: Vec<_> = scene.surfaces.iter().flat_map(|s| s.polygons.iter().cloned()).collect();
    let vis = visibility::Visibility::new(&polys);
    for acc in [1e-1, 1e-2, 3e-3, 1e-3] {
        let t = std::time::Instant::now();
        let ff = form_factor::FormFactors::patch_to_patch(&patches, &vis, acc);
        let n = patches.len();
        let m = 200.min(n);
        use rayon::prelude::*;
        let sums: Vec<f64> = (0..m)
            .into_par_iter()
            .map(|k| {
                let mut row = vec![0.0; n];
                ff.row(k * n / m, 0, &mut row);
                row.iter().sum::<f64>() - 1.0
            })
            .collect();
        let rms = (sums.iter().map(|s| s * s).sum::<f64>() / m as f64).sqrt();
        let max = sums.iter().fold(0.0f64, |a, s| a.max(s.abs()));
        println!(
            "n {n} acc {acc} rms {rms:.2e} max {max:.2e} rays/row {} time/pair {:.2} us",
            ff.rays() / m as u64,
            t.elapsed().as_secs_f64() * 1e6 * 2.0 / (m * n) as f64
        );
    }
}
