//! I(C, γ): intensities on a grid of directions, linear in each angle between its lines; Φ = ∫∫ I sinγ dγ dC.

use super::numbers::Fault;

/// A measured distribution of intensity, with what its file says of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Web {
    /// The name of the file.
    pub name: String,
    /// The angles of the planes, in degrees from 0 on, growing, less than 360; one plane is that of all.
    planes: Vec<f64>,
    /// The angles from the axis, in degrees from 0 to 180, growing. Where they end, the light does.
    gammas: Vec<f64>,
    /// The intensities in cd, plane by plane.
    intensities: Vec<f64>,
    largest: f64,
    /// The flux of the lamps in lm; none where the file knows of the luminaire as a whole alone.
    pub lamps: Option<f64>,
    /// The flux of the luminaire in lm, where the file says it.
    pub stated: Option<f64>,
    /// The largest side of what shines, in metres.
    pub size: f64,
}

/// What of the planes is measured; the rest is the same in the mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    /// All planes, or one that is all.
    None,
    /// C and −C are the same.
    AboutC0,
    /// C and 180 − C are.
    AboutC90,
    /// Both.
    AboutBoth,
}

impl Web {
    /// From the planes that were measured, each with the intensities at the angles from the axis, in cd.
    pub(super) fn new(
        measured: &[(f64, Vec<f64>)],
        gammas: Vec<f64>,
        symmetry: Symmetry,
    ) -> Result<Self, Fault> {
        let images = |c: f64| match symmetry {
            Symmetry::None => vec![c],
            Symmetry::AboutC0 => vec![c, -c],
            Symmetry::AboutC90 => vec![c, 180.0 - c],
            Symmetry::AboutBoth => vec![c, -c, 180.0 - c, 180.0 + c],
        };
        let mut all: Vec<(f64, &Vec<f64>)> = measured
            .iter()
            .flat_map(|(c, values)| images(*c).into_iter().map(move |c| (c.rem_euclid(360.0), values)))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.dedup_by(|later, first| (later.0 - first.0).abs() < SAME);
        let intensities: Vec<f64> = all.iter().flat_map(|(_, values)| values.iter().copied()).collect();
        let largest = intensities.iter().copied().fold(0.0, f64::max);
        if !largest.is_finite() {
            return Err(Fault::new(1, "an intensity is too large for a number"));
        }
        let planes = all.iter().map(|(c, _)| *c).collect();
        let (name, lamps, stated, size) = Default::default();
        Ok(Self { name, planes, gammas, intensities, largest, lamps, stated, size })
    }

    pub(super) fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    /// The intensity in a direction, in cd: C in degrees as it comes, γ from 0 to 180.
    pub fn at(&self, c: f64, gamma: f64) -> f64 {
        let Some((row, down)) = between(&self.gammas, gamma) else { return 0.0 };
        let (first, second, across) = self.beside(c.rem_euclid(360.0));
        let along = |plane: usize| {
            let values = &self.intensities[plane * self.gammas.len()..];
            let next = (row + 1).min(self.gammas.len() - 1);
            values[row] * (1.0 - down) + values[next] * down
        };
        along(first) * (1.0 - across) + along(second) * across
    }

    /// The planes before and after an angle, and how far it is between them, as a part of one.
    fn beside(&self, c: f64) -> (usize, usize, f64) {
        let n = self.planes.len();
        let after = self.planes.partition_point(|plane| *plane <= c);
        let (first, second) = ((after + n - 1) % n, after % n);
        let width = (self.planes[second] - self.planes[first]).rem_euclid(360.0);
        let along = (c - self.planes[first]).rem_euclid(360.0);
        (first, second, if width > 0.0 { (along / width).min(1.0) } else { 0.0 })
    }

    /// The largest intensity, in cd.
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// The flux by integration of the intensities, in lm: exact for what is between the lines of the grid.
    pub fn flux(&self) -> f64 {
        let n = self.planes.len();
        let rings: Vec<f64> =
            self.intensities.chunks_exact(self.gammas.len()).map(|plane| ring(&self.gammas, plane)).collect();
        let width = |k: usize| match n {
            1 => 360.0,
            _ => (self.planes[(k + 1) % n] - self.planes[k]).rem_euclid(360.0),
        };
        (0..n).map(|k| width(k).to_radians() * 0.5 * (rings[k] + rings[(k + 1) % n])).sum()
    }

    /// Half of the space between the lines of the grid, in radians, as it is at most places; not less than a degree.
    pub(crate) fn resolution(&self) -> f64 {
        let rows = self.gammas.len().max(2);
        let step = (self.gammas[self.gammas.len() - 1] - self.gammas[0]) / (rows - 1) as f64;
        (step / 2.0).clamp(1.0, 90.0).to_radians()
    }
}

/// Planes so near to each other, in degrees, are one: 1/3 of a degree is written with many digits, or few.
const SAME: f64 = 1e-6;

/// How far beyond the last angle an angle is still at it, in degrees: rounding.
const BEYOND: f64 = 1e-9;

/// The line before an angle, and how far it is from that to the next, as a part of one; none outside of all.
fn between(angles: &[f64], angle: f64) -> Option<(usize, f64)> {
    let (first, last) = (*angles.first()?, *angles.last()?);
    if !(first - BEYOND..=last + BEYOND).contains(&angle) {
        return None;
    }
    let after = angles.partition_point(|other| *other <= angle).clamp(1, angles.len());
    let before = after - 1;
    let step = angles.get(after).map_or(1.0, |next| next - angles[before]);
    Some((before, ((angle - angles[before]) / step).clamp(0.0, 1.0)))
}

/// ∫ I sinγ dγ of what is linear between angles: in sr/rad times the unit of I.
fn ring(gammas: &[f64], values: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (g, i) in gammas.windows(2).zip(values.windows(2)) {
        let [a, b] = [g[0].to_radians(), g[1].to_radians()];
        let slope = (i[1] - i[0]) / (b - a);
        // ∫ (i + s (γ − a)) sinγ dγ = [−(i + s (γ − a)) cosγ + s sinγ].
        sum += i[0] * a.cos() - i[1] * b.cos() + slope * (b.sin() - a.sin());
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn web(planes: &[(f64, [f64; 3])], symmetry: Symmetry) -> Web {
        let planes: Vec<_> = planes.iter().map(|(c, values)| (*c, values.to_vec())).collect();
        Web::new(&planes, vec![0.0, 90.0, 180.0], symmetry).unwrap_or_else(|fault| panic!("{}", fault.what))
    }

    #[test]
    fn between_its_lines_it_is_linear() {
        let web =
            web(&[(0.0, [4.0, 2.0, 0.0]), (90.0, [4.0, 6.0, 0.0]), (270.0, [4.0, 0.0, 0.0])], Symmetry::None);
        assert_eq!(
            [web.at(0.0, 0.0), web.at(0.0, 45.0), web.at(45.0, 90.0), web.at(180.0, 90.0)],
            [4.0, 3.0, 4.0, 3.0]
        );
        // Over the seam, and beyond a turn.
        assert_eq!([web.at(315.0, 90.0), web.at(-45.0, 90.0), web.at(675.0, 90.0)], [1.0; 3]);
        assert_eq!([web.at(12.0, 180.0), web.at(12.0, 180.1)], [0.0; 2]);
    }

    #[test]
    fn mirrors_give_the_planes_that_were_not_measured() {
        let measured = [(0.0, [1.0, 1.0, 1.0]), (90.0, [1.0, 2.0, 1.0])];
        let both = web(&measured, Symmetry::AboutBoth);
        assert_eq!([0.0, 90.0, 180.0, 270.0].map(|c| both.at(c, 90.0)), [1.0, 2.0, 1.0, 2.0]);
        let half = [(0.0, [1.0; 3]), (90.0, [1.0, 2.0, 1.0]), (180.0, [1.0, 3.0, 1.0])];
        let about = web(&half, Symmetry::AboutC0);
        assert_eq!([0.0, 90.0, 180.0, 270.0].map(|c| about.at(c, 90.0)), [1.0, 2.0, 3.0, 2.0]);
        let half = [(90.0, [1.0; 3]), (180.0, [1.0, 2.0, 1.0]), (270.0, [1.0, 3.0, 1.0])];
        let about = web(&half, Symmetry::AboutC90);
        assert_eq!([0.0, 90.0, 180.0, 270.0].map(|c| about.at(c, 90.0)), [2.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn the_flux_is_the_integral() {
        let even = web(&[(0.0, [100.0; 3])], Symmetry::None);
        assert!((even.flux() - 400.0 * PI).abs() < 1e-10);
        // Against a midpoint rule of what `at` says.
        let web =
            web(&[(0.0, [4.0, 2.0, 1.0]), (90.0, [4.0, 6.0, 1.0]), (200.0, [4.0, 0.0, 1.0])], Symmetry::None);
        let n = 720;
        let cell = |k: u32, of: f64| of * (f64::from(k) + 0.5) / f64::from(n);
        let sum: f64 = (0..n * n)
            .map(|k| {
                let (c, gamma) = (cell(k % n, 360.0), cell(k / n, 180.0));
                web.at(c, gamma) * gamma.to_radians().sin()
            })
            .sum();
        let rule = sum * (2.0 * PI / f64::from(n)) * (PI / f64::from(n));
        assert!((web.flux() / rule - 1.0).abs() < 1e-5, "{} {rule}", web.flux());
    }
}
