//! Light to an accuracy by links: against the adaptive answer, and against what is known.

use fredholm::value::{Rgb, Value};
use glam::DVec3;
use radiosity::adaptive;
use radiosity::linked::{self, LinkedError, Request};
use radiosity::polygon::Polygon;
use radiosity::reconstruct::Lit;
use radiosity::scene::{Scene, Surface, cornell_box};
use radiosity::visibility::Visibility;

fn square(value: Rgb) -> f64 {
    value.channels().iter().map(|c| c * c).sum()
}

/// Points spread evenly over all faces.
fn points(faces: &[Polygon]) -> Vec<(u32, DVec3)> {
    let total: f64 = faces.iter().map(Polygon::area).sum();
    let on = |(k, face): (usize, &Polygon)| {
        let count = (2000.0 * face.area() / total).ceil() as usize;
        let at = move |i: usize| {
            let i = i as f64 + 0.5;
            (k as u32, face.point((0.754_877_666 * i).fract(), (0.569_840_291 * i).fract()))
        };
        (0..count).map(at).collect::<Vec<_>>()
    };
    faces.iter().enumerate().flat_map(on).collect()
}

#[test]
fn it_is_the_adaptive_answer_to_what_both_are_told_to_err() {
    let scene = cornell_box();
    let faces = scene.polygons();
    let visibility = Visibility::new(&faces);
    let domain = adaptive::Domain::new(&scene, &faces).unwrap();
    let fine =
        adaptive::solve(&domain, &adaptive::Request { accuracy: 0.005, ..Default::default() }, |_| true);
    let points = points(&faces);
    let truth = fine.seen(&mut points.iter().copied());
    for accuracy in [0.1, 0.03] {
        let request = Request { accuracy, ..Request::default() };
        let mut rounds = 0;
        let field = linked::solve(&scene, (&faces, &visibility), &request, |_| {
            rounds += 1;
            true
        })
        .unwrap();
        let told = field.bound().total();
        assert!(told <= accuracy && told > 0.1 * accuracy, "{told} for {accuracy} after {rounds} rounds");
        let found = field.seen(&mut points.iter().copied());
        let (mut off, mut all) = (0.0, 0.0);
        for ((a, b), (face, _)) in found.iter().zip(&truth).zip(&points) {
            let surface = scene.surfaces.iter().scan(0, |end, s| {
                *end += s.polygons.len() as u32;
                Some((*end, s.emission))
            });
            let emission = surface.filter(|(end, _)| face < end).map(|(_, e)| e).next().unwrap();
            off += square(a[0] - b[0]);
            all += square(b[0] - emission);
        }
        let error = (off / all).sqrt();
        assert!(error <= told + 0.005, "{error} off, told {told}");
    }
}

/// A closed box of which every face emits and reflects alike: u = E/(1 − ρ) everywhere.
fn furnace(parts: usize, rho: f64) -> Scene<f64> {
    let mut polygons = Vec::new();
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let unit = |k: usize| {
                DVec3::from_array(std::array::from_fn(|i| if i == (axis + k) % 3 { 1.0 } else { 0.0 }))
            };
            let [n, u, v] = [unit(0), unit(1), unit(2)];
            let [u, v] = if side == 0.0 { [u, v] } else { [v, u] };
            let step = 1.0 / parts as f64;
            for k in 0..parts * parts {
                let corner = n * side + u * (step * (k % parts) as f64) + v * (step * (k / parts) as f64);
                let [u, v] = [u * step, v * step];
                polygons.push(Polygon::quadrilateral(corner, corner + u, corner + u + v, corner + v));
            }
        }
    }
    let surface = Surface { name: "walls".into(), reflectance: rho, emission: 1.0, polygons };
    Scene { name: "furnace".into(), surfaces: vec![surface], lights: Vec::new(), camera: None }
}

#[test]
fn lamps_that_are_too_many_are_patches_like_all() {
    let scene = furnace(12, 0.5);
    let faces = scene.polygons();
    let visibility = Visibility::new(&faces);
    let request = Request { accuracy: 0.02, ..Request::default() };
    let field = linked::solve(&scene, (&faces, &visibility), &request, |_| true).unwrap();
    assert!(field.bound().total() <= 0.02, "{:?}", field.bound());
    let light = field.seen(&mut points(&faces).into_iter());
    let mean = |k: usize| light.iter().map(|l| l[k]).sum::<f64>() / light.len() as f64;
    assert!((mean(0) - 2.0).abs() < 0.02 && (mean(1) - 2.0).abs() < 0.04, "{} {}", mean(0), mean(1));
    let worst = light.iter().map(|[b, _]| (b - 2.0).abs()).fold(0.0, f64::max);
    assert!(worst < 0.2, "{worst}");
}

#[test]
fn it_is_dark_without_a_lamp_and_stops_when_told() {
    let mut scene = furnace(3, 0.5);
    let faces = scene.polygons();
    let visibility = Visibility::new(&faces);
    let mut rounds = 0;
    let request = Request { accuracy: 1e-4, ..Request::default() };
    let field = linked::solve(&scene, (&faces, &visibility), &request, |_| {
        rounds += 1;
        false
    })
    .unwrap();
    assert!(rounds == 1 && field.bound().total() > 1e-4);
    scene.surfaces[0].emission = 0.0;
    let field = linked::solve(&scene, (&faces, &visibility), &request, |_| true).unwrap();
    assert!(field.bound().total() == 0.0 && field.radiosity().iter().all(|b| *b == 0.0));
}

#[test]
fn what_does_not_fit_is_refused_before_it_is_made() {
    let scene = furnace(3, 0.5);
    let faces = scene.polygons();
    let visibility = Visibility::new(&faces);
    let request = Request { memory: 1 << 20, ..Request::default() };
    let refused = linked::solve(&scene, (&faces, &visibility), &request, |_| true).err();
    assert!(
        matches!(refused, Some(LinkedError::Memory { available, .. }) if available == 1 << 20),
        "{refused:?}"
    );
}

#[test]
fn more_patches_than_are_allowed_are_not_made() {
    let scene = cornell_box();
    let faces = scene.polygons();
    let visibility = Visibility::new(&faces);
    let request = Request { accuracy: 1e-3, most_patches: 5000, ..Request::default() };
    let field = linked::solve(&scene, (&faces, &visibility), &request, |_| true).unwrap();
    assert!(field.size()[0] <= 5100 && field.bound().total() > 1e-3);
}
