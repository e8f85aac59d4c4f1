//! IES LM-63 (1986, 1991, 1995, 2002, 2019): keywords up to `TILT=`, then numbers in a fixed order over any lines.
//!
//! I = candela × multiplier × ballast factor, and before 2002 × ballast-lamp factor. Type C is read, the one of all indoor and
//! road luminaires; A (headlamps) and B (floodlights) have other angles, and are refused.

use super::numbers::{Fault, check_angles, count, number, positive};
use super::web::{Symmetry, Web};

/// The web of a file, and what is to be told of it.
pub(super) fn read(text: &str) -> Result<(Web, Vec<String>), Fault> {
    let mut told = Vec::new();
    let mut lines = text.lines().zip(1..);
    let newest = text.lines().next().is_some_and(|first| first.contains("2002") || first.contains("2019"));
    let tilt = |line: &str| {
        let (head, tilt) = line.trim().split_once('=')?;
        (head.trim() == "TILT").then(|| tilt.trim().to_owned())
    };
    let Some(tilt) = lines.by_ref().find_map(|(line, _)| tilt(line)) else {
        let last = text.lines().count();
        return Err(Fault::new(last, "there is no line `TILT=`, from which on an IES file has its numbers"));
    };
    let mut words = Words::of(lines, text.lines().count());
    if tilt != "NONE" {
        told.push(
            "the lamp's light when it is tilted (TILT) is passed over: it is taken as it was measured"
                .to_owned(),
        );
    }
    if tilt == "INCLUDE" {
        words.next("the lamp's geometry")?;
        let (line, pairs) = words.next("a number of tilts")?;
        (0..2 * count(line, pairs, "the number of tilts")?)
            .try_for_each(|_| words.next("a tilt").map(|_| ()))?;
    }
    let head = Head::read(&mut words)?;
    let gammas = words.angles(head.rows, "vertical")?;
    check_angles(&gammas, "vertical", [0.0, 180.0])?;
    let planes = words.angles(head.planes, "horizontal")?;
    check_angles(&planes, "horizontal", [0.0, 360.0])?;
    let symmetry = symmetry(&planes)?;
    let factor = head.multiplier * head.ballast * if newest { 1.0 } else { head.ballast_lamp };
    let mut measured = Vec::new();
    for (_, c) in planes {
        let row = gammas.iter().map(|_| {
            let (line, word) = words.next("an intensity in cd")?;
            positive(line, word, "the intensity").map(|value| value * factor)
        });
        measured.push((c, row.collect::<Result<Vec<f64>, Fault>>()?));
    }
    // 0 and 360 are one plane; that at 0 stays.
    let mut web = Web::new(&measured, gammas.iter().map(|(_, gamma)| *gamma).collect(), symmetry)?;
    web.lamps = (head.lumens > 0.0).then_some(head.lamps * head.lumens);
    web.size = head.size;
    Ok((web, told))
}

/// The thirteen numbers before the angles.
struct Head {
    lamps: f64,
    lumens: f64,
    multiplier: f64,
    rows: usize,
    planes: usize,
    size: f64,
    ballast: f64,
    ballast_lamp: f64,
}

const FEET: f64 = 0.3048;

impl Head {
    fn read(words: &mut Words<'_>) -> Result<Self, Fault> {
        let mut next =
            |name: &str| words.next(name).and_then(|(line, word)| Ok((line, number(line, word, name)?)));
        let lamps = next("the number of lamps")?.1;
        // −1: the luminaire is known as a whole.
        let lumens = next("the lumens of a lamp")?.1;
        let (line, multiplier) = next("the multiplier")?;
        at_least(line, multiplier, "the multiplier")?;
        let rows = next("the number of vertical angles")?;
        let planes = next("the number of horizontal angles")?;
        let rows = count(rows.0, &rows.1.to_string(), "the number of vertical angles")?;
        let planes = count(planes.0, &planes.1.to_string(), "the number of horizontal angles")?;
        let (line, kind) = next("the photometric type")?;
        if kind != 1.0 {
            let name = if kind == 2.0 {
                "B"
            } else if kind == 3.0 {
                "A"
            } else {
                "unknown"
            };
            let what =
                format!("photometry of type {name} ({kind}) is not read; type C (1) is: convert the file");
            return Err(Fault::new(line, what));
        }
        let (line, unit) = next("the unit of length, 1 for feet or 2 for metres")?;
        let metres = if unit == 1.0 { FEET } else { 1.0 };
        if unit != 1.0 && unit != 2.0 {
            return Err(Fault::new(
                line,
                format!("the unit of length is {unit}; expected 1 for feet or 2 for metres"),
            ));
        }
        let mut size: f64 = 0.0;
        for name in ["the width", "the length", "the height"] {
            // Less than nothing is the diameter of what is round.
            size = size.max(next(name)?.1.abs() * metres);
        }
        let (line, ballast) = next("the ballast factor")?;
        at_least(line, ballast, "the ballast factor")?;
        let (line, ballast_lamp) = next("the ballast-lamp factor")?;
        at_least(line, ballast_lamp, "the ballast-lamp factor")?;
        next("the watts")?;
        Ok(Self { lamps, lumens, multiplier, rows, planes, size, ballast, ballast_lamp })
    }
}

fn at_least(line: usize, value: f64, name: &str) -> Result<(), Fault> {
    if value >= 0.0 {
        Ok(())
    } else {
        Err(Fault::new(line, format!("{name} is {value}; it may not be negative")))
    }
}

/// What the horizontal angles say of the planes that are not there.
fn symmetry(planes: &[(usize, f64)]) -> Result<Symmetry, Fault> {
    let (Some(&(_, first)), Some(&(line, last))) = (planes.first(), planes.last()) else {
        return Err(Fault::new(1, "there are no horizontal angles"));
    };
    let step = planes.windows(2).map(|pair| pair[1].1 - pair[0].1).fold(0.0, f64::max);
    match (first, last) {
        (0.0, 90.0) => Ok(Symmetry::AboutBoth),
        (0.0, 180.0) => Ok(Symmetry::AboutC0),
        (90.0, 270.0) => Ok(Symmetry::AboutC90),
        (0.0, 0.0) | (0.0, 360.0) => Ok(Symmetry::None),
        // All around, without the first plane again.
        _ if planes.len() > 2 && first + 360.0 - last <= step * 1.001 => Ok(Symmetry::None),
        _ => Err(Fault::new(
            line,
            format!(
                "the horizontal angles go from {first} to {last}; expected 0, or 0 to 90, 180 or 360, or 90 to 270 degrees"
            ),
        )),
    }
}

/// Words with their lines.
struct Words<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    last: usize,
}

impl<'a> Words<'a> {
    fn of(lines: impl Iterator<Item = (&'a str, usize)> + 'a, last: usize) -> Self {
        let is_between = |c: char| c.is_whitespace() || c == ',';
        let words = lines.flat_map(move |(line, at)| {
            line.split(is_between).filter(|word| !word.is_empty()).map(move |word| (at, word))
        });
        Self { words: Box::new(words), last }
    }

    fn next(&mut self, name: &str) -> Result<(usize, &'a str), Fault> {
        let end = self.last;
        self.words.next().ok_or_else(|| Fault::new(end, format!("the file ends where {name} is expected")))
    }

    fn angles(&mut self, count: usize, kind: &str) -> Result<Vec<(usize, f64)>, Fault> {
        let name = format!("a {kind} angle in degrees");
        (0..count)
            .map(|_| self.next(&name).and_then(|(line, word)| Ok((line, number(line, word, &name)?))))
            .collect()
    }
}
