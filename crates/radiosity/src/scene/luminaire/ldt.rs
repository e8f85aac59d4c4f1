//! EULUMDAT (`.ldt`): a line for each number, in a fixed order; I = (cd/klm) × Φ/1000 × conversion factor.

use super::numbers::{Fault, check_angles, count, number, positive};
use super::web::{Symmetry, Web};

/// The web of a file, and what is to be told of it.
pub(super) fn read(text: &str) -> Result<(Web, Vec<String>), Fault> {
    let mut told = Vec::new();
    let lines = Lines(text.lines().collect());
    let symmetry = lines.number(3, "the symmetry")?;
    let around = lines.count(4, "the number of C-planes")?;
    let rows = lines.count(6, "the number of intensities of a plane")?;
    // In mm; what is round has a width of 0.
    let size = [16, 17].into_iter().try_fold(0.0_f64, |size, line| {
        Ok(size.max(positive(line, lines.at(line)?, "the size of the luminous area")? / 1000.0))
    })?;
    let output = lines.positive(23, "the light output ratio in %")?;
    let conversion = lines.positive(24, "the conversion factor for intensities")?;
    let sets = lines.count(26, "the number of sets of lamps")?;
    if sets > 1 {
        told.push(format!("the first of {sets} sets of lamps is taken"));
    }
    let lamps = lines.number(27, "the number of lamps")?;
    let flux = lines.positive(29, "the flux of the lamps in lm")?;
    let tilt = lines.number(25, "the tilt during measurement")?;
    if tilt != 0.0 {
        told.push(format!("it was measured with a tilt of {tilt} degrees, and is taken as it was measured"));
    }

    let angles_at = 26 + 6 * sets + 10 + 1;
    let angles = |from: usize, number_of: usize, name: &str| {
        (from..from + number_of)
            .map(|line| Ok((line, lines.number(line, name)?)))
            .collect::<Result<Vec<(usize, f64)>, Fault>>()
    };
    let all = angles(angles_at, around, "the angle of a C-plane in degrees")?;
    check_angles(&all, "C", [0.0, 360.0])?;
    let gammas = angles(angles_at + around, rows, "an angle from the axis in degrees")?;
    check_angles(&gammas, "γ", [0.0, 180.0])?;
    let (planes, symmetry) = measured(symmetry, &all)?;
    let factor = conversion * flux / 1000.0;
    let mut line = angles_at + around + rows;
    let mut webs = Vec::new();
    for c in planes {
        let plane = (line..line + rows)
            .map(|line| lines.positive(line, "the intensity in cd/klm").map(|value| value * factor));
        webs.push((c, plane.collect::<Result<Vec<f64>, Fault>>()?));
        line += rows;
    }
    let mut web = Web::new(&webs, gammas.iter().map(|(_, gamma)| *gamma).collect(), symmetry)?;
    // Less than no lamps: the flux is that of the luminaire.
    web.lamps = (lamps > 0.0).then_some(flux);
    web.stated = (output > 0.0).then_some(flux * output / 100.0);
    web.size = size;
    Ok((web, told))
}

/// The angles of the planes that the file has, of all, and the mirrors that give the others.
fn measured(symmetry: f64, all: &[(usize, f64)]) -> Result<(Vec<f64>, Symmetry), Fault> {
    let n = all.len();
    let divided = |parts: usize, symmetry| match n % parts {
        0 => Ok(symmetry),
        _ => {
            Err(Fault::new(4, format!("a file of this symmetry has a multiple of {parts} C-planes, not {n}")))
        }
    };
    let (first, count, symmetry) = match symmetry {
        0.0 => (0, n, Symmetry::None),
        1.0 => (0, 1, Symmetry::None),
        2.0 => (0, n / 2 + 1, divided(2, Symmetry::AboutC0)?),
        3.0 => (3 * n / 4, n / 2 + 1, divided(4, Symmetry::AboutC90)?),
        4.0 => (0, n / 4 + 1, divided(4, Symmetry::AboutBoth)?),
        other => {
            return Err(Fault::new(
                3,
                format!("the symmetry is {other}; expected a whole number from 0 to 4"),
            ));
        }
    };
    Ok(((first..first + count).map(|k| all[k % n].1).collect(), symmetry))
}

/// The lines, counted from 1.
struct Lines<'a>(Vec<&'a str>);

impl<'a> Lines<'a> {
    fn at(&self, line: usize) -> Result<&'a str, Fault> {
        let end = self.0.len();
        let missing =
            || Fault::new(end, format!("the file ends after line {end}; there should be a line {line}"));
        self.0.get(line - 1).copied().ok_or_else(missing)
    }

    fn number(&self, line: usize, name: &str) -> Result<f64, Fault> {
        number(line, self.at(line)?, name)
    }

    fn positive(&self, line: usize, name: &str) -> Result<f64, Fault> {
        positive(line, self.at(line)?, name)
    }

    fn count(&self, line: usize, name: &str) -> Result<usize, Fault> {
        count(line, self.at(line)?, name)
    }
}
