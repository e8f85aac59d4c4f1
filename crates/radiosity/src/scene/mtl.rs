//! The MTL reader: `Kd` is the reflectance ρ, `Ke` the radiance L of the front in W/(m² sr), so that E = π L.

use super::error::{Error, Place, Problem};
use super::material::{Located, Material};
use super::text::{self, Statement};
use fredholm::value::{Rgb, Spectrum};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

/// Adds the materials of a file; of two with one name the later holds.
pub(super) fn read(
    file: &Path,
    named_at: &Place,
    materials: &mut BTreeMap<String, Material>,
) -> Result<(), Error> {
    let text = text::read(file, named_at)?;
    let mut current = None;
    for statement in text::statements(&text) {
        let place = Place::line(file, statement.line);
        take(&statement, &place, &mut current, materials).map_err(|problem| problem.at(place))?;
    }
    Ok(())
}

fn take(
    statement: &Statement<'_>,
    place: &Place,
    current: &mut Option<String>,
    materials: &mut BTreeMap<String, Material>,
) -> Result<(), Problem> {
    match statement.split() {
        ("newmtl", "") => {
            return Err(Problem::Malformed("`newmtl` without a name; write `newmtl white`".into()));
        }
        ("newmtl", name) => {
            materials.insert(name.to_owned(), Material::default());
            *current = Some(name.to_owned());
        }
        ("Kd", rest) => {
            let value = colour(rest)?;
            open(current.as_ref(), materials)?.reflectance = Some(Located { value, place: place.clone() });
        }
        ("Ke", rest) => {
            let value = colour(rest)? * PI;
            open(current.as_ref(), materials)?.emission = Some(Located { value, place: place.clone() });
        }
        _ => {}
    }
    Ok(())
}

fn open<'a>(
    current: Option<&String>,
    materials: &'a mut BTreeMap<String, Material>,
) -> Result<&'a mut Material, Problem> {
    current.and_then(|name| materials.get_mut(name)).ok_or_else(|| {
        Problem::Malformed("this stands before the first `newmtl`; name the material first".into())
    })
}

/// `r g b`, or one number for all three.
fn colour(rest: &str) -> Result<Rgb, Problem> {
    let words: Vec<_> = rest.split_whitespace().collect();
    match words[..] {
        [grey] => Ok(Spectrum([text::number(grey)?; 3])),
        [red, green, blue] => Ok(Spectrum([text::number(red)?, text::number(green)?, text::number(blue)?])),
        _ => Err(Problem::Malformed(format!(
            "`{rest}` is not a colour; expected one number or three: `0.7 0.7 0.6`"
        ))),
    }
}
