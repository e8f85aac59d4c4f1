//! The Cornell box beside a path tracer that shares no code with this program.

use super::common::{mean, p, visibility};
use super::{Case, Row};
use fredholm::value::{Rgb, Value};
use glam::DVec3;
use radiosity::patches::{Patches, size_for_count};
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, cornell_box};
use radiosity::solve::{Options, Unobserved, solve};

/// Mean radiosity of whole walls, W/m².
const TRACED: [(&str, [f64; 3]); 4] = [
    ("floor", [0.34717, 0.23130, 0.06271]),
    ("back", [0.52735, 0.34663, 0.09358]),
    ("right", [0.10960, 0.23799, 0.01434]),
    ("left", [0.43853, 0.02925, 0.00673]),
];

pub fn case() -> Case {
    let scene = lowered();
    let patches = Patches::new(&scene, size_for_count(&scene, 3000)).unwrap();
    let solution = solve(&patches, &visibility(&scene), &Options::default(), &mut Unobserved).unwrap();
    let rows = TRACED.into_iter().flat_map(|(wall, expected)| {
        let index = scene.surfaces.iter().position(|surface| surface.name == wall).unwrap();
        let of = |channel: usize| {
            let values: Vec<f64> = solution.radiosity.iter().map(|b| b.0[channel]).collect();
            mean(&patches, &values, |i| patches.surface[i] as usize == index)
        };
        (0..3).map(move |c| (wall, c, expected[c])).zip([of(0), of(1), of(2)])
    });
    Case {
        title: "Cornell box, measured",
        about: "Mean radiosity of whole walls in W/m² beside an unbiased path tracer (16 × 1024 paths a texel, 64 × 64 texels a \
                wall), with a black lamp 0.1 mm below a whole ceiling; by `solve` on 3 000 patches, with sampled visibility.",
        accepted: "the path tracer errs by 0.1 % over all, and rounds to 5 decimals",
        within: 1e-2,
        decimals: 3,
        rows: rows
            .map(|((wall, channel, expected), ours)| {
                Row::new(format!("{wall}, {}", ["red", "green", "blue"][channel]), expected, ours)
            })
            .collect(),
    }
}

/// The box with the lamp of the path tracer.
fn lowered() -> Scene<Rgb> {
    let mut scene = cornell_box();
    let named = |scene: &Scene<Rgb>, name: &str| scene.surfaces.iter().position(|s| s.name == name).unwrap();
    let (ceiling, lamp) = (named(&scene, "ceiling"), named(&scene, "light"));
    let [a, b, c, d] =
        [(0.556, 0.0), (0.556, 0.5592), (0.0, 0.5592), (0.0, 0.0)].map(|(x, z)| p(x, 0.5488, z));
    scene.surfaces[ceiling].polygons = vec![Polygon::quadrilateral(a, b, c, d)];
    let corners = scene.surfaces[lamp].polygons[0].vertices().to_vec();
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| corners[k] - 1e-4 * DVec3::Y);
    scene.surfaces[lamp].polygons = vec![Polygon::quadrilateral(a, b, c, d)];
    scene.surfaces[lamp].reflectance = Rgb::splat(0.0);
    scene
}
