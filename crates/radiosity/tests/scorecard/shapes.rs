//! View factors that are known: in full sight and behind screens.

use super::common::{p, parallelogram, walls};
use super::{Case, Row};
use glam::DVec3;
use radiosity::form_factor::pairs::Pairs;
use radiosity::polygon::Polygon;

pub fn cases() -> Vec<Case> {
    vec![in_sight(), behind_screens()]
}

/// Σ over the faces of two groups: the factor from the one to the other.
fn factor(faces: &[Polygon], from: &[usize], to: &[usize]) -> f64 {
    let pairs = Pairs::new(faces, 1e-10);
    let exchange: f64 = from.iter().flat_map(|i| to.iter().map(|j| pairs.exchange(*i, *j).value)).sum();
    exchange / from.iter().map(|i| faces[*i].area()).sum::<f64>()
}

fn in_sight() -> Case {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let floor = || parallelogram(DVec3::ZERO, x, y);
    let two = |other: Polygon| factor(&[floor(), other], &[0], &[1]);
    Case {
        title: "View factors of unit squares",
        about: "By `form_factor::pairs`, to 10⁻¹⁰.",
        accepted: "",
        within: 1e-6,
        decimals: 9,
        rows: vec![
            Row::new("opposite, at distance 1", 0.199824895698, two(parallelogram(z, y, x))),
            Row::new("with a common edge, at 90°", 0.200043776075, two(parallelogram(DVec3::ZERO, y, z))),
            Row::new(
                "parallel and offset, [0,1]² and [1,3] × [.5,1.5]",
                0.085530552987,
                two(parallelogram(p(1.0, 0.5, 1.0), y, 2.0 * x)),
            ),
            Row::new(
                "parallel, side by side at height 1",
                0.086050489152,
                two(parallelogram(p(1.0, 0.0, 1.0), y, x)),
            ),
        ],
    }
}

fn behind_screens() -> Case {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let screened = |along: DVec3, across: DVec3| {
        let screen = parallelogram(0.5 * z, along, across);
        factor(&[parallelogram(DVec3::ZERO, x, y), parallelogram(z, y, x), screen], &[0], &[1])
    };
    let room = walls(DVec3::ZERO, DVec3::ONE, false);
    let boxed: Vec<Polygon> =
        room.into_iter().chain(walls(DVec3::splat(0.3), DVec3::splat(0.7), true)).collect();
    let (outer, inner): (Vec<usize>, Vec<usize>) = ((0..6).collect(), (6..12).collect());
    Case {
        title: "View factors in part hidden",
        about: "Unit squares at distance 1 with a screen half-way, and a cube of side .4 in the middle of a unit cube, by \
                `form_factor::pairs`, which clips.",
        accepted: "",
        within: 1e-6,
        decimals: 9,
        rows: vec![
            Row::new("a quarter screen", 0.149868671774, screened(0.5 * x, 0.5 * y)),
            Row::new("a half screen", 0.099912447849, screened(0.5 * x, y)),
            Row::new("cube to obstacle", 0.16, factor(&boxed, &outer, &inner)),
            Row::new("cube to cube", 0.84, factor(&boxed, &outer, &outer)),
            Row::new("obstacle to cube", 1.0, factor(&boxed, &inner, &outer)),
        ],
    }
}
