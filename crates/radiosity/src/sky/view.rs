//! The sky from a point: what is hidden as a whole, or not at all, is known at once; of the rest what hides is clipped away, and what
//! is left is integrated over the cells of the dome.

use super::cover::Cover;
use super::dome::{Dome, ROOTS, quarters};
use crate::form_factor::outline::Outline;
use crate::form_factor::view::take_away;
use glam::DVec3;
use std::ops::Range;

/// The irradiance at a point with a unit normal from what the cover leaves of a sky whose zenith has a radiance of 1, in sr.
pub(crate) fn received(dome: &Dome, cover: &Cover, point: DVec3, normal: DVec3) -> f64 {
    let (mut planes, mut shadows) = (Vec::new(), Vec::new());
    if !cover.shadows(point, normal, &mut planes, &mut shadows) {
        return 0.0;
    }
    let kept = (0..shadows.len() as u32).collect();
    let mut look = Look { dome, normal, planes, shadows, kept, pieces: Vec::new() };
    let all = 0..look.kept.len();
    let roots = (0..ROOTS).map(|cell| Part { corners: dome.cells[cell].corners, cell, is_whole: true });
    roots.map(|root| look.seen(&root, all.clone())).sum::<DVec3>().dot(normal).max(0.0)
}

struct Look<'a> {
    dome: &'a Dome,
    normal: DVec3,
    /// The planes of all shadows, and which are those of each.
    planes: Vec<DVec3>,
    shadows: Vec<Range<usize>>,
    /// The shadows that reach into some part, behind those that reach into what it is a part of.
    kept: Vec<u32>,
    pieces: Vec<Outline>,
}

/// A triangle in which it is looked for shadows: a cell of the dome, or a part of one that has no parts itself.
struct Part {
    corners: [DVec3; 3],
    cell: usize,
    is_whole: bool,
}

/// So many shadows at a time are clipped away; where more of them meet a part is cut first.
const FEW: usize = 10;

/// The side, in radians, of a part that is cut no further: it is hidden where its middle is. It is 10⁻⁶ of the sky.
const LEAST: f64 = 2e-3;

/// How a part is seen.
enum Seen {
    Nothing,
    /// All of it, above the horizon too.
    All,
    /// What so many shadows leave.
    Partly(Range<usize>),
}

impl Look<'_> {
    /// ∫ L ω dω over what some shadows leave of a part.
    fn seen(&mut self, part: &Part, hiders: Range<usize>) -> DVec3 {
        let cell = &self.dome.cells[part.cell];
        match self.filter(&part.corners, hiders) {
            Seen::Nothing => DVec3::ZERO,
            Seen::All if part.is_whole => cell.moment,
            Seen::All => cell.luminance.moment(part.corners.into_iter()),
            Seen::Partly(hiders) => {
                let start = hiders.start;
                let sum = self.partly(part, hiders);
                self.kept.truncate(start);
                sum
            }
        }
    }

    fn partly(&mut self, part: &Part, hiders: Range<usize>) -> DVec3 {
        if hiders.len() <= FEW {
            return self.clipped(part, hiders);
        }
        if part.corners[0].distance(part.corners[1]) < LEAST {
            let middle = part.corners.iter().sum::<DVec3>();
            let is_above =
                |shadow: &Range<usize>| self.planes[shadow.clone()].iter().all(|p| p.dot(middle) >= 0.0);
            let hidden = self.kept[hiders].iter().any(|&k| is_above(&self.shadows[k as usize]));
            return if hidden { DVec3::ZERO } else { self.clipped(part, 0..0) };
        }
        let first = self.dome.cells[part.cell].parts.filter(|_| part.is_whole);
        let parts = quarters(part.corners);
        (0..4)
            .map(|k| {
                let cell = first.map_or(part.cell, |first| first + k);
                self.seen(&Part { corners: parts[k], cell, is_whole: first.is_some() }, hiders.clone())
            })
            .sum()
    }

    /// Which of the shadows reach into a triangle.
    fn filter(&mut self, corners: &[DVec3; 3], hiders: Range<usize>) -> Seen {
        let heights = corners.map(|corner| corner.dot(self.normal));
        if heights.iter().all(|height| *height <= 0.0) {
            return Seen::Nothing;
        }
        let (outline, start) = (Outline::new(corners), self.kept.len());
        for k in hiders {
            let shadow = self.kept[k];
            match outline.lies(&self.planes[self.shadows[shadow as usize].clone()]) {
                Some(true) => {
                    self.kept.truncate(start);
                    return Seen::Nothing;
                }
                Some(false) => (),
                None => self.kept.push(shadow),
            }
        }
        if self.kept.len() == start && heights.iter().all(|height| *height >= 0.0) {
            return Seen::All;
        }
        Seen::Partly(start..self.kept.len())
    }

    /// The integral over the pieces that some shadows and the horizon leave of a part.
    fn clipped(&mut self, part: &Part, hiders: Range<usize>) -> DVec3 {
        let normal = self.normal;
        let mut outline = Outline::new(&part.corners);
        outline.keep_above(|v| v.dot(normal));
        self.pieces.clear();
        self.pieces.push(outline);
        for k in hiders {
            let planes = &self.planes[self.shadows[self.kept[k] as usize].clone()];
            let before = self.pieces.len();
            for piece in 0..before {
                let piece = self.pieces[piece];
                if piece.lies(planes) == Some(false) {
                    self.pieces.push(piece);
                } else {
                    take_away(piece, planes, &mut self.pieces);
                }
            }
            self.pieces.drain(..before);
        }
        let pieces = self.pieces.iter().filter(|piece| !piece.is_empty());
        pieces.map(|piece| over(self.dome, part.cell, piece)).sum()
    }
}

/// ∫ L ω dω over what a cell of the dome has of a piece.
fn over(dome: &Dome, cell: usize, piece: &Outline) -> DVec3 {
    let normal = |(from, to): (DVec3, DVec3)| {
        let cross = from.cross(to);
        (cross.length_squared() > NO_EDGE * from.length_squared() * to.length_squared()).then_some(cross)
    };
    let inner: Vec<DVec3> = piece.edges().filter_map(normal).collect();
    // Less than three are the sides of nothing.
    if inner.len() < 3 { DVec3::ZERO } else { within(dome, cell, piece, &inner) }
}

/// The square of the sine of an edge that is none: two corners that clipping has put in one place, but for rounding.
const NO_EDGE: f64 = 1e-24;

/// The same, with the inward normals of the planes of the piece's edges.
fn within(dome: &Dome, cell: usize, piece: &Outline, inner: &[DVec3]) -> DVec3 {
    let cell = &dome.cells[cell];
    let Some(first) = cell.parts else {
        let mut part = *piece;
        cell.edges.iter().for_each(|edge| part.keep_above(|v| v.dot(*edge)));
        return if part.is_empty() { DVec3::ZERO } else { cell.luminance.moment(part.vertices()) };
    };
    let part = |k: usize| {
        let part = &dome.cells[k];
        let all =
            |is: fn(f64) -> bool| move |edge: &DVec3| part.corners.iter().all(|corner| is(corner.dot(*edge)));
        if piece.lies(&part.edges) == Some(false) || inner.iter().any(all(|height| height <= 0.0)) {
            DVec3::ZERO
        } else if inner.iter().all(all(|height| height >= 0.0)) {
            part.moment
        } else {
            within(dome, k, piece, inner)
        }
    };
    (first..first + 4).map(part).sum()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::model::{Kind, Model};
    use super::*;
    use crate::polygon::Polygon;
    use crate::visibility::Visibility;
    use std::f64::consts::{PI, TAU};

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn box_of(low: DVec3, high: DVec3) -> Vec<Polygon> {
        let size = high - low;
        let (x, y, z) = (size.x * DVec3::X, size.y * DVec3::Y, size.z * DVec3::Z);
        let face = |c: DVec3, a: DVec3, b: DVec3| Polygon::quadrilateral(c, c + a, c + a + b, c + b);
        vec![
            face(low, y, x),
            face(low + z, x, y),
            face(low, x, z),
            face(low + y, z, x),
            face(low, z, y),
            face(low + x, y, z),
        ]
    }

    /// A floor with boxes, a leaning triangle and a picket fence.
    pub(crate) fn yard() -> Vec<Polygon> {
        let mut polygons = vec![Polygon::quadrilateral(
            p(-9.0, -9.0, 0.0),
            p(9.0, -9.0, 0.0),
            p(9.0, 9.0, 0.0),
            p(-9.0, 9.0, 0.0),
        )];
        polygons.extend(box_of(p(1.0, -2.0, 0.0), p(3.0, 1.0, 4.0)));
        polygons.extend(box_of(p(-3.0, 2.0, 0.0), p(2.5, 3.0, 2.0)));
        polygons.extend(box_of(p(-2.0, -2.0, 2.0), p(0.5, 0.5, 2.2)));
        polygons.push(Polygon::triangle(p(-4.0, -1.0, 0.5), p(-2.5, 1.0, 1.0), p(-3.5, 0.0, 3.0)));
        polygons.extend((0..30).map(|k| {
            let y = -3.0 + 0.2 * f64::from(k);
            Polygon::quadrilateral(
                p(-5.0, y, 0.0),
                p(-5.0, y + 0.1, 0.0),
                p(-5.0, y + 0.1, 3.0),
                p(-5.0, y, 3.0),
            )
        }));
        polygons
    }

    /// The same by rays in a fine grid of azimuth and sin² of the elevation over the surface.
    fn by_rays(dome: &Dome, polygons: &[Polygon], point: DVec3, normal: DVec3) -> f64 {
        let visibility = Visibility::new(polygons);
        let (x, y) = normal.any_orthonormal_pair();
        let n = 700;
        let mut sum = 0.0;
        for k in 0..n * n {
            let [s, t] = [k / n, k % n].map(|i| (f64::from(i) + 0.5) / f64::from(n));
            let (sine, cosine) = (TAU * t).sin_cos();
            let omega = (x * cosine + y * sine) * s.sqrt() + normal * (1.0 - s).sqrt();
            if visibility.nearest(point, omega).is_none() {
                sum += dome.model().relative(omega);
            }
        }
        PI * sum / f64::from(n * n)
    }

    #[test]
    fn what_is_clipped_is_what_rays_find() {
        let polygons = yard();
        let cover = Cover::new(&polygons, 1e-9);
        let places = [
            (p(0.3, 0.2, 0.0), DVec3::Z),
            (p(-4.5, 0.1, 0.0), DVec3::Z),
            (p(-1.0, -1.0, 2.2), DVec3::Z),
            (p(1.0, 0.0, 2.0), -DVec3::X),
            (p(0.0, 2.0, 1.0), -DVec3::Y),
            (p(-6.0, 0.0, 1.0), p(0.8, 0.0, -0.6)),
        ];
        for kind in [Kind::Uniform, Kind::Overcast, Kind::General(12)] {
            let dome = Dome::new(Model::new(kind, DVec3::Z, p(-0.5, -0.3, 0.6).normalize()));
            for (point, normal) in places {
                let found = received(&dome, &cover, point, normal);
                let expected = by_rays(&dome, &polygons, point, normal);
                assert!(
                    (found - expected).abs() < 2e-3 * dome.horizontal() && found > 0.01,
                    "{kind:?} at {point}: {found} for {expected}"
                );
            }
            // Under what stands there is no sky, nor within.
            assert_eq!(received(&dome, &cover, p(2.0, 0.0, 0.0), DVec3::Z), 0.0);
            assert_eq!(received(&dome, &cover, p(2.0, 0.0, 1.0), DVec3::X), 0.0);
        }
    }

    #[test]
    fn the_sky_looks_into_what_is_open_above() {
        // A crate without a lid, whose fronts are outside, with a table in it: nothing of the scene is higher.
        let mut polygons = box_of(p(-1.0, -1.0, 0.0), p(1.0, 1.0, 1.0));
        polygons.remove(1);
        let table = Polygon::quadrilateral(
            p(-0.5, -0.5, 0.5),
            p(0.5, -0.5, 0.5),
            p(0.5, 0.5, 0.5),
            p(-0.5, 0.5, 0.5),
        );
        polygons.push(table);
        let dome = Dome::new(Model::new(Kind::Uniform, DVec3::Z, DVec3::X));
        let found = received(&dome, &Cover::new(&polygons, 1e-9), p(0.0, 0.0, 0.5), DVec3::Z);
        let (x, q) = (2.0, 5_f64.sqrt());
        let expected = PI * 4.0 * (2.0 * x / q * (x / q).atan()) / TAU;
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }

    #[test]
    fn a_canyon_and_a_court_have_their_view_factors() {
        let dome = Dome::new(Model::new(Kind::Uniform, DVec3::Z, DVec3::X));
        // A street without end (but for 10⁻⁶ of it): walls of height h at ±w/2 leave cos of the angle to their tops.
        let long = 1e6;
        let wall = |x: f64, h: f64| {
            Polygon::quadrilateral(p(x, -long, 0.0), p(x, long, 0.0), p(x, long, h), p(x, -long, h))
        };
        let canyon = Cover::new(&[wall(-4.0, 9.0), wall(4.0, 9.0)], 1e-9);
        for x in [0.0_f64, 2.0, 3.9] {
            let sine = |across: f64| across / across.hypot(9.0);
            let expected = PI * 0.5 * (sine(4.0 - x) + sine(4.0 + x));
            assert!((received(&dome, &canyon, p(x, 0.0, 0.0), DVec3::Z) - expected).abs() < 1e-5);
        }
        // A square court of side a and depth h: the sky is the square above.
        let (a, h) = (6.0, 4.0);
        let sides = box_of(p(-a / 2.0, -a / 2.0, 0.0), p(a / 2.0, a / 2.0, h));
        let court = Cover::new(&sides[2..], 1e-9);
        let (x, q) = (a / 2.0 / h, (1.0 + (a / 2.0 / h).powi(2)).sqrt());
        let expected = PI * 4.0 * (2.0 * x / q * (x / q).atan()) / TAU;
        let found = received(&dome, &court, DVec3::ZERO, DVec3::Z);
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}
