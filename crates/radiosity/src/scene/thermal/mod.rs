//! The thermal scene file (TOML): temperatures or heats and emissivities, of the materials of meshes or of an enclosure.
//!
//! ```toml
//! unit = "mm"                           # meshes, camera and [solve] as in a scene of light
//! meshes = ["furnace.obj"]
//! surroundings = 293.15                 # K, of what is seen beyond all surfaces; 0 if left out
//! bands = [2.5, 8]                      # limits in µm: here three bands; without them surfaces are grey
//!
//! [materials.heater]                    # as named in the meshes
//! emissivity = [0.3, 0.5, 0.8]          # a number, or one for each band
//! temperature = 1200                    # K; or one of the lines below
//! # emissive_power = 4.0e4              # σT⁴ in W/m², the same said in another way
//! # heat_flux = 0                       # W/m², net, out of the surface everywhere; 0 where it is adiabatic
//! # heat = 150                          # W, net, of each surface of the material, evenly spread
//! # linked = "shield"                   # one unknown temperature with all that is linked by this word, no net heat but
//! #                                     # `heat`, if that is given too
//! ```
//!
//! With the view factors known there is no mesh:
//!
//! ```toml
//! [enclosure]
//! view_factors = [[0, 1], [0.25, 0.75]] # row i: the shares of what leaves surface i; or a shape: "plates", "nested"
//! [[enclosure.surface]]
//! name = "inner sphere"
//! area = 1                              # m²
//! emissivity = 0.8
//! temperature = 400
//! # …
//! ```

mod entry;

use self::entry::{EnclosureEntry, Entry, PerBand, SurfaceEntry, condition};
use super::compass::Compass;
use super::error::{Error, Place, Problem, listed};
use super::face;
use super::file::{Source, Unit};
use super::load::SolveOptions;
use super::mesh::{self, Group, MaterialName};
use super::{Scene, Surface, text};
use crate::thermal::{self, Bands, Condition, Enclosure};
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;

/// Surfaces that exchange heat: of meshes, or with view factors that are given.
#[derive(Clone, Debug)]
pub enum Thermal {
    /// Surfaces of meshes.
    Scene(ThermalScene),
    /// Surfaces without a shape: the enclosure's name, and the enclosure.
    Enclosure(String, Enclosure),
}

/// Meshes with temperatures and heats.
#[derive(Clone, Debug)]
pub struct ThermalScene {
    /// The shapes, without any light.
    pub scene: Scene<f64>,
    /// What is known of each of its surfaces, in their order.
    pub surfaces: Vec<thermal::Surface>,
    /// The bands of wavelength.
    pub bands: Bands,
    /// The temperature of the surroundings, in K.
    pub surroundings: f64,
    /// What the file says in place of the defaults.
    pub solve: SolveOptions,
}

/// Reads a thermal scene file.
///
/// # Errors
///
/// When a file cannot be read or understood, or a surface has not just what it needs: see [`Problem`].
pub fn load_thermal(file: &Path) -> Result<Thermal, Error> {
    if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let what = "a mesh alone has no temperatures; name it in a scene file (.toml) that gives its \
                    materials `emissivity` and `temperature` or `heat_flux`";
        return Err(Problem::Malformed(what.to_owned()).at(Place::file(file)));
    }
    let text = text::read(file, &Place::file(file))?;
    let source = Source { file, text: &text };
    let entry: Entry = toml::from_str(&text).map_err(|error| source.syntax(&error))?;
    let reader = Reader::new(&source, &entry)?;
    match &entry.enclosure {
        Some(enclosure) => reader.enclosure(&entry, enclosure),
        None => reader.scene(entry).map(Thermal::Scene),
    }
}

fn malformed(what: impl Into<String>, place: Place) -> Error {
    Problem::Malformed(what.into()).at(place)
}

/// What a file prescribes of a material; how much heat a surface of it has depends on its area.
#[derive(Clone)]
struct Prescribed {
    emissivity: Vec<f64>,
    condition: Condition,
    is_total: bool,
}

impl Prescribed {
    fn surface(&self, name: &str, area: f64) -> thermal::Surface {
        let condition = match self.condition {
            Condition::HeatFlux(heat) if self.is_total => Condition::HeatFlux(heat / area),
            ref other => other.clone(),
        };
        thermal::Surface { name: name.to_owned(), emissivity: self.emissivity.clone(), condition }
    }
}

struct Reader<'a> {
    source: &'a Source<'a>,
    bands: Bands,
    surroundings: f64,
}

impl<'a> Reader<'a> {
    fn new(source: &'a Source<'a>, entry: &Entry) -> Result<Self, Error> {
        let bands = match &entry.bands {
            Some(limits) => Bands::new(limits.get_ref().clone())
                .map_err(|error| malformed(error.to_string(), source.place(&limits.span())))?,
            None => Bands::grey(),
        };
        let surroundings = entry.surroundings.as_ref().map_or(0.0, |kelvin| *kelvin.get_ref());
        if let Some(kelvin) = &entry.surroundings
            && !(surroundings >= 0.0 && surroundings.is_finite())
        {
            let problem = Problem::from(thermal::ThermalError::Surroundings(surroundings));
            return Err(problem.at(source.place(&kelvin.span())));
        }
        Ok(Self { source, bands, surroundings })
    }

    fn scene(&self, entry: Entry) -> Result<ThermalScene, Error> {
        let file = || Place::file(self.source.file);
        let (Some(Unit(metres)), Some(names)) = (entry.unit, &entry.meshes) else {
            return Err(malformed("a thermal scene needs `unit` and `meshes`, or an [enclosure]", file()));
        };
        let groups = mesh::named(self.source.meshes(names, metres)?);
        if let Some((name, group)) = groups.iter().find(|(_, group)| group.masks.is_some()) {
            let place = group.material.as_ref().map_or_else(file, |material| material.place.clone());
            return Err(malformed(face::masking_message(name), place));
        }
        let materials = self.materials(&entry.materials, &groups)?;
        let (mut shapes, mut surfaces) = (Vec::new(), Vec::new());
        for (name, group) in groups {
            let material = group.material.clone().ok_or_else(|| {
                malformed(
                    format!("the faces of `{name}` have no material; give them one in the mesh"),
                    file(),
                )
            })?;
            let shape = Surface { name, reflectance: 0.0, emission: 0.0, polygons: group.polygons };
            surfaces.push(self.of_material(&material, &materials)?.surface(&shape.name, shape.area()));
            shapes.push(shape);
        }
        if shapes.iter().all(|shape| shape.polygons.is_empty()) {
            return Err(Problem::NoFaces.at(file()));
        }
        let name = entry.name.unwrap_or_else(|| super::load::file_name(self.source.file));
        let camera =
            entry.camera.map(|camera| self.source.camera(&camera, metres, &Compass::OF_PLANS)).transpose()?;
        let scene = Scene { name, surfaces: shapes, lights: Vec::new(), camera };
        let solve =
            SolveOptions { patch_size: entry.solve.patch_size.map(|size| size * metres), ..entry.solve };
        let (bands, surroundings) = (self.bands.clone(), self.surroundings);
        Ok(ThermalScene { scene, surfaces, bands, surroundings, solve })
    }

    fn materials(
        &self,
        entries: &BTreeMap<Spanned<String>, Spanned<SurfaceEntry>>,
        groups: &[(String, Group)],
    ) -> Result<BTreeMap<String, Prescribed>, Error> {
        let used = || groups.iter().filter_map(|(_, group)| group.material.as_ref()).map(|m| m.name.as_str());
        let mut materials = BTreeMap::new();
        for (name, entry) in entries {
            let (place, name) = (self.source.place(&name.span()), name.get_ref().clone());
            if !used().any(|used| used == name) {
                let known = listed(used().collect::<std::collections::BTreeSet<_>>().into_iter());
                return Err(Problem::UnusedMaterial { name, known }.at(place));
            }
            let surface = entry.get_ref();
            if let Some(span) =
                surface.area.as_ref().map(Spanned::span).or(surface.name.as_ref().map(Spanned::span))
            {
                let what =
                    "`name` and `area` belong to surfaces of an [enclosure]; those of a mesh have them";
                return Err(malformed(what, self.source.place(&span)));
            }
            let owner = format!("material `{name}`");
            let prescribed = self.prescribed(&owner, &name, surface, &place)?;
            materials.insert(name, prescribed);
        }
        Ok(materials)
    }

    fn of_material<'m>(
        &self,
        material: &MaterialName,
        materials: &'m BTreeMap<String, Prescribed>,
    ) -> Result<&'m Prescribed, Error> {
        let MaterialName { name, place } = material;
        materials.get(name).ok_or_else(|| {
            let what = format!(
                "the material `{name}` has no emissivity; add `[materials.{name}]` with `emissivity` and `temperature` or \
                 `heat_flux` to {}",
                self.source.file.display()
            );
            malformed(what, place.clone())
        })
    }

    fn enclosure(&self, entry: &Entry, enclosure: &Spanned<EnclosureEntry>) -> Result<Thermal, Error> {
        let place = self.source.place(&enclosure.span());
        if entry.meshes.is_some()
            || entry.unit.is_some()
            || !entry.materials.is_empty()
            || entry.camera.is_some()
        {
            let what =
                "an [enclosure] has its own surfaces; leave out unit, meshes, materials and camera, or it";
            return Err(malformed(what, place));
        }
        let EnclosureEntry { shape, view_factors, surface } = enclosure.get_ref();
        let (mut surfaces, mut areas) = (Vec::new(), Vec::new());
        for (number, entry) in (1..).zip(surface) {
            let (surface, area) = self.surface_of_enclosure(number, entry, shape.as_ref())?;
            surfaces.push(surface);
            areas.push(area);
        }
        let (made, span) = match (shape, view_factors) {
            (Some(shape), None) if matches!(shape.get_ref().as_str(), "plates" | "nested") => {
                (Enclosure::nested(surfaces, &areas, self.bands.clone()), shape.span())
            }
            (Some(shape), None) => {
                let what = format!(
                    "the shape `{}` is unknown; write plates or nested, or give view_factors",
                    shape.get_ref()
                );
                return Err(malformed(what, self.source.place(&shape.span())));
            }
            (None, Some(rows)) => {
                (Enclosure::new(surfaces, &areas, rows.get_ref(), self.bands.clone()), rows.span())
            }
            _ => return Err(malformed("an [enclosure] needs either a `shape` or `view_factors`", place)),
        };
        let made = made.map_err(|error| Problem::from(error).at(self.source.place(&span)))?;
        let name = entry.name.clone().unwrap_or_else(|| super::load::file_name(self.source.file));
        Ok(Thermal::Enclosure(name, made.in_surroundings(self.surroundings)))
    }

    fn surface_of_enclosure(
        &self,
        number: usize,
        entry: &Spanned<SurfaceEntry>,
        shape: Option<&Spanned<String>>,
    ) -> Result<(thermal::Surface, f64), Error> {
        let (place, surface) = (self.source.place(&entry.span()), entry.get_ref());
        let name = surface.name.as_ref().map_or_else(|| number.to_string(), |name| name.get_ref().clone());
        let is_plate = shape.is_some_and(|shape| shape.get_ref() == "plates");
        let area = match &surface.area {
            Some(area) if *area.get_ref() > 0.0 && area.get_ref().is_finite() => *area.get_ref(),
            Some(area) => {
                let problem = thermal::ThermalError::Area { surface: name, value: *area.get_ref() };
                return Err(Problem::from(problem).at(self.source.place(&area.span())));
            }
            None if is_plate => 1.0,
            None => return Err(malformed(format!("`{name}` needs an `area`, in m²"), place)),
        };
        let owner = format!("surface `{name}`");
        Ok((self.prescribed(&owner, &name, surface, &place)?.surface(&name, area), area))
    }

    /// Emissivity and condition, each mistake at its line.
    fn prescribed(
        &self,
        owner: &str,
        name: &str,
        entry: &SurfaceEntry,
        place: &Place,
    ) -> Result<Prescribed, Error> {
        for (key, value) in [
            ("reflectance", &entry.reflectance),
            ("radiance", &entry.radiance),
            ("emission", &entry.emission),
        ] {
            if let Some(value) = value {
                let what = format!(
                    "`{key}` belongs to a scene of light; in a thermal one {owner} reflects 1 − `emissivity` and emits by its \
                     `temperature`"
                );
                return Err(malformed(what, self.source.place(&value.span())));
            }
        }
        let emissivity = entry.emissivity.as_ref().ok_or_else(|| {
            malformed(
                format!("{owner} has no `emissivity`; give a number from 0 to 1, or one for each band"),
                place.clone(),
            )
        })?;
        let given = match emissivity.get_ref().clone() {
            PerBand::Grey(number) => vec![number; self.bands.count()],
            PerBand::Bands(numbers) => numbers,
        };
        let (condition, span) = condition(owner, entry).map_err(|what| malformed(what, place.clone()))?;
        let check = |condition: &Condition, span: &std::ops::Range<usize>| {
            let surface = thermal::Surface {
                name: name.to_owned(),
                emissivity: given.clone(),
                condition: condition.clone(),
            };
            surface.check(&self.bands).map_err(|error| Problem::from(error).at(self.source.place(span)))
        };
        check(&Condition::HeatFlux(0.0), &emissivity.span())?;
        check(&condition, &span)?;
        Ok(Prescribed { emissivity: given, condition, is_total: entry.heat.is_some() })
    }
}
