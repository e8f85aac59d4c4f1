//! Enclosures whose radiosity is known.

use super::common::{scene, sphere, visibility, walls};
use super::{Case, Row};
use glam::DVec3;
use radiosity::patches::Patches;
use radiosity::scene::Scene;
use radiosity::solve::{Options, Solution, Unobserved, solve};
use radiosity::thermal::{self, Bands, Enclosure, Surface};

pub fn cases() -> Vec<Case> {
    vec![closed(), spheres(), heat()]
}

fn solved(scene: &Scene<f64>, size: f64, accuracy: f64) -> (Patches<f64>, Solution<f64>) {
    let patches = Patches::new(scene, size).unwrap();
    let options = Options { tolerance: 1e-10, accuracy, ..Options::default() };
    let solution = solve(&patches, &visibility(scene), &options, &mut Unobserved).unwrap();
    (patches, solution)
}

fn closed() -> Case {
    let cube =
        |reflectance: f64| scene(walls(DVec3::ZERO, DVec3::ONE, false).map(|wall| vec![wall]), reflectance);
    let furnace = |rho: f64| {
        let mut cube = cube(rho);
        cube.surfaces.iter_mut().for_each(|surface| surface.emission = 1.0);
        let radiosity = solved(&cube, 0.25, 1e-6).1.radiosity;
        // The patch that is furthest off.
        let exact = 1.0 / (1.0 - rho);
        radiosity
            .into_iter()
            .fold(exact, |far, b| if (b - exact).abs() > (far - exact).abs() { b } else { far })
    };
    let mut zones = cube(0.6);
    zones.surfaces[0].emission = 1.0;
    let b = solved(&zones, 1.0, 1e-6).1.radiosity;
    Case {
        title: "Closed rooms",
        about: "White furnaces, a unit cube of E = 1 and one ρ in 96 patches of which the worst is shown: B = E/(1 − ρ); and the \
                cube of six zones with ρ = .6, of which one emits. W/m², by `solve`, whose matrix has single precision.",
        accepted: "",
        within: 1e-6,
        decimals: 6,
        rows: vec![
            Row::new("furnace, ρ = .3", 1.0 / 0.7, furnace(0.3)),
            Row::new("furnace, ρ = .8", 5.0, furnace(0.8)),
            Row::new("six zones, emitting", 1.160714295535, b[0]),
            Row::new("six zones, opposite", 0.267773389574, b[1]),
            Row::new("six zones, adjacent", 0.267878078723, b[2]),
        ],
    }
}

/// Rows of the planar patches that stand for a sphere.
const ROWS: usize = 15;

fn spheres() -> Case {
    let whole = |reflectance: &dyn Fn(f64) -> f64, emission: &dyn Fn(f64) -> f64, rows: usize| {
        let mut scene = scene(sphere(ROWS).into_iter().take(2 * ROWS * rows).map(|patch| vec![patch]), 0.0);
        for surface in &mut scene.surfaces {
            let cosine = surface.polygons[0].centroid().normalize().z;
            (surface.reflectance, surface.emission) = (reflectance(cosine), emission(cosine));
        }
        let (patches, solution) = solved(&scene, 9.0, 1e-3);
        let mean = |values: &[f64]| super::common::mean(&patches, values, |_| true);
        [mean(&solution.irradiance), mean(&solution.radiosity)]
    };
    let [irradiance, _] = whole(&|z| 0.5 + 0.3 * z, &|z| 1.0 + z * z, ROWS);
    // The part above z = −½ is ¾ of the sphere.
    let [_, cavity] = whole(&|_| 0.7, &|_| 0.3, 2 * ROWS / 3);
    Case {
        title: "Inside of a sphere",
        about: "H = mean(E)/(1 − mean(ρ)) with E = 1 + cos²θ and ρ = ½ + .3 cosθ, and the mean B = ε/(1 − (1 − ε) f) of a \
                cavity with f = ¾ of the sphere's area and ε = .3, in 15 rows of planar patches with their corners on the \
                sphere. W/m², by `solve`.",
        accepted: "",
        within: 1e-3,
        decimals: 3,
        rows: vec![
            Row::new("sphere, mean H", 8.0 / 3.0, irradiance),
            Row::new("cavity, mean B", 0.631578947368, cavity),
        ],
    }
}

fn heat() -> Case {
    // q from surfaces with σT⁴ = 1 in the first place and 0 in the last.
    let hot = thermal::temperature(1.0);
    let q = |surfaces: Vec<Surface>, areas: &[f64]| {
        let enclosure = Enclosure::nested(surfaces, areas, Bands::grey()).unwrap();
        enclosure.solve(&thermal::Options::default()).unwrap().nodes[0].heat_flux
    };
    let plates = vec![Surface::at("hot", hot, 0.8), Surface::at("cold", 0.0, 0.5)];
    let spheres = vec![Surface::at("inner", hot, 0.8), Surface::at("outer", 0.0, 0.5)];
    let mut shields = vec![Surface::at("hot", hot, 0.1)];
    for (side, shield) in ["1", "1", "2", "2", "3", "3"].iter().enumerate() {
        shields.push(Surface::floating(&side.to_string(), shield, 0.1));
    }
    shields.push(Surface::at("cold", 0.0, 0.1));
    Case {
        title: "Heat between plates and spheres",
        about: "The net heat flux in W/m² of the hot surface, σT⁴ = 1 there and 0 at the other, by `thermal`.",
        accepted: "",
        within: 1e-6,
        decimals: 9,
        rows: vec![
            Row::new("plates, ε = .8 and .5", 0.444444444444, q(plates, &[1.0; 2])),
            Row::new(
                "concentric spheres, radii 1 and 2, ε = .8 and .5",
                1.0 / (1.0 / 0.8 + 0.25 * (1.0 / 0.5 - 1.0)),
                q(spheres, &[1.0, 4.0]),
            ),
            Row::new("three shields, all ε = .1", 0.013157894737, q(shields, &[1.0; 8])),
        ],
    }
}
