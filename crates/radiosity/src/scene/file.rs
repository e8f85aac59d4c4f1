//! The scene file (TOML): which meshes, in which unit, of which materials, seen from where, solved how.
//!
//! ```toml
//! name = "Office"                       # optional; else the file's name
//! unit = "mm"                           # of the meshes and of every length here: mm, cm, m, in, ft, or metres as a number
//! meshes = ["room.obj", "desk.stl"]     # beside this file: .obj, .glb, .gltf, .stl, .ply, .vs3
//! up = [0, 0, 1]                        # optional: this, and north = [0, 1, 0], for the sun, the sky and the camera; where
//!                                       # all meshes are glTF, which has y up, [0, 1, 0] and north = [0, 0, -1]
//!
//! [materials.white]                     # a material by its name in the meshes; what is not given stays as it is there
//! reflectance = 0.8                     # or [red, green, blue]
//! radiance = [17, 12, 4]                # W/(m² sr); or `emission`, the exitance π × radiance in W/m²
//!                                       # with `units = "photometric"` in the first lines instead, and one number each:
//!                                       # `luminance` in cd/m², `luminous_exitance` in lm/m², or `luminous_flux` in lm
//!                                       # of each surface of the material
//!
//! [[light]]                             # as many point lights as there are
//! position = [1000, 1000, 2400]
//! intensity = 20                        # W/sr, or [red, green, blue]; or `flux` in W. Photometric: cd, or lm
//! direction = [0, 0, -1]                # if the light is diffuse, I cosθ; else it shines alike in all directions
//! cone = [20, 35]                       # with a direction: a spot, whose beam is whole up to the first angle and ends at the
//!                                       # second, in degrees from the axis; between them it fades as glTF has it
//!
//! [[luminaire]]                         # as many as there are; a point with the intensities of a photometric file
//! file = "downlight.ies"                # IES LM-63 of type C, or EULUMDAT (.ldt), beside this file
//! position = [1000, 1000, 2400]
//! aim = [0, 0, -1]                      # the way that it looks: this unless it is said
//! turn = 90                             # degrees, counter-clockwise seen from above, before it is aimed; C = 0 is east at 0
//! dimming = 0.8                         # of the file's light; or `flux`, in lm or, where the scene is in watts, in W
//!
//! [sun]                                 # from infinity, with sharp shadows
//! azimuth = 135                         # degrees clockwise from north, seen from above
//! elevation = 40                        # degrees over the horizon; or, for both, `direction`, the way that its light goes
//! normal_irradiance = 800               # W/m² across its beam, or [red, green, blue]; photometric: `normal_illuminance` in lx
//!
//! [sky]                                 # around the scene, above the horizon; below it there is nothing
//! kind = "cie"                          # or "uniform", or "cie-overcast", (1 + 2 sin of the elevation)/3
//! type = 12                             # of a "cie" sky: 1 to 15, as ISO 15469:2004 numbers them
//! horizontal_irradiance = 120           # W/m² of the sky alone, or `zenith_radiance` in W/(m² sr); photometric:
//!                                       # `horizontal_illuminance` in lx, or `zenith_luminance` in cd/m²
//! azimuth = 135                         # where the sun is of a sky that depends on it, if there is no [sun]; also `elevation`
//!
//! [camera]
//! position = [1000, -3000, 1500]
//! target = [1000, 0, 1200]              # or `direction`
//! up = [0, 0, 1]                        # optional: what is up in the scene, or north for a camera that looks along it
//! vertical_angle = 40                   # degrees
//!
//! [solve]                               # optional, all of it
//! patch_size = 20
//! method = "galerkin"
//! solver = "gauss-seidel"
//! factor_accuracy = 1e-3
//! tolerance = 1e-6
//! accuracy = "1%"                       # in place of all of these
//! ```

use super::compass::Compass;
use super::error::{Error, Place, Problem};
use super::light::entry::LightEntry;
use super::light::sky_entry::SkyEntry;
use super::light::sun_entry::SunEntry;
use super::load::{Loaded, SolveOptions, is_gltf, read_mesh};
use super::luminaire::entry::LuminaireEntry;
use super::material::{Located, Material};
use super::mesh::{self, Assembled, Mesh};
use super::photometric::{self, Units};
use super::{Camera, Light, Scene, text};
use fredholm::value::{Rgb, Spectrum};
use glam::DVec3;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// The scene of a TOML file and what it says on how to solve it.
pub(super) fn load(file: &Path, units: Option<Units>) -> Result<Loaded, Error> {
    let text = text::read(file, &Place::file(file))?;
    let source = Source { file, text: &text };
    let entry: SceneEntry = toml::from_str(&text).map_err(|error| source.syntax(&error))?;
    let units = units.or(entry.units).unwrap_or_default();
    let Unit(metres) = entry.unit;
    let meshes = source.meshes(&entry.meshes, metres)?;
    let places = entry.materials.keys().map(|name| (name.get_ref().as_str(), source.place(&name.span())));
    mesh::check_overrides_are_used(&meshes, places)?;
    let overrides = source.overrides(&entry.materials, units)?;
    if units == Units::Photometric {
        photometric::check_grey(&meshes, &overrides)?;
    }
    let mut lights: Vec<_> = meshes.iter().flat_map(|mesh| mesh.lights.iter().cloned()).collect();
    lights.extend(source.lights(&entry.light, metres, units)?);
    let is_gltf = entry.meshes.get_ref().iter().all(|name| is_gltf(Path::new(name.get_ref())));
    // A scene that says that z is up has turned its meshes.
    let is_turned = entry.up.as_ref().is_some_and(|up| up.get_ref()[2].abs() > up.get_ref()[1].abs());
    let usual = if is_gltf && !is_turned { Compass::OF_GLTF } else { Compass::OF_PLANS };
    let compass = source.compass(usual, entry.up.as_ref(), entry.north.as_ref())?;
    let (luminaires, told) = source.luminaires(&entry.luminaire, metres, &compass, units)?;
    lights.extend(luminaires.into_iter().map(Light::Point));
    if let Some(sun) = &entry.sun {
        lights.push(source.sun(sun, &compass, units)?.into());
    }
    if let Some(sky) = &entry.sky {
        let sun = lights.iter().rev().find_map(|light| match light {
            Light::Sun(sun) => Some(-sun.direction),
            _ => None,
        });
        lights.push(source.sky(sky, &compass, sun, units)?.into());
    }
    let camera = entry.camera.map(|camera| source.camera(&camera, metres, &compass)).transpose()?;
    let camera = camera.or_else(|| meshes.iter().find_map(|mesh| mesh.camera));
    let Assembled { surfaces, faces, mut warnings, clean_up } = mesh::assemble(meshes, &overrides)?;
    warnings.extend(told);
    let name = entry.name.unwrap_or_else(|| super::load::file_name(file));
    let scene = Scene { name, surfaces, lights, camera };
    let mut solve = entry.solve;
    solve.patch_size = solve.patch_size.map(|size| size * metres);
    Ok(Loaded { scene, solve, faces, warnings, clean_up, control: None, units })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneEntry {
    name: Option<String>,
    units: Option<Units>,
    unit: Unit,
    meshes: Spanned<Vec<Spanned<String>>>,
    #[serde(default)]
    materials: BTreeMap<Spanned<String>, MaterialEntry>,
    #[serde(default)]
    light: Vec<LightEntry>,
    #[serde(default)]
    luminaire: Vec<LuminaireEntry>,
    up: Option<Spanned<[f64; 3]>>,
    north: Option<Spanned<[f64; 3]>>,
    sun: Option<Spanned<SunEntry>>,
    sky: Option<Spanned<SkyEntry>>,
    camera: Option<Spanned<CameraEntry>>,
    #[serde(default)]
    solve: SolveOptions,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialEntry {
    reflectance: Option<Spanned<Channels>>,
    radiance: Option<Spanned<Channels>>,
    emission: Option<Spanned<Channels>>,
    luminance: Option<Spanned<f64>>,
    luminous_exitance: Option<Spanned<f64>>,
    luminous_flux: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraEntry {
    position: [f64; 3],
    target: Option<[f64; 3]>,
    direction: Option<[f64; 3]>,
    up: Option<[f64; 3]>,
    vertical_angle: f64,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "expected a number or [red, green, blue]")]
pub(super) enum Channels {
    Grey(f64),
    Colour([f64; 3]),
}

impl Channels {
    pub fn colour(self) -> Rgb {
        match self {
            Self::Grey(grey) => Spectrum([grey; 3]),
            Self::Colour(colour) => Spectrum(colour),
        }
    }
}

/// A unit of length, in metres.
#[derive(Deserialize)]
#[serde(try_from = "UnitEntry")]
pub(super) struct Unit(pub f64);

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected a unit of length: \"mm\", \"cm\", \"m\", \"in\", \"ft\" or metres as a number"
)]
enum UnitEntry {
    Name(String),
    Metres(f64),
}

impl TryFrom<UnitEntry> for Unit {
    type Error = String;

    fn try_from(entry: UnitEntry) -> Result<Self, String> {
        let metres = match entry {
            UnitEntry::Metres(metres) if metres > 0.0 && metres.is_finite() => metres,
            UnitEntry::Metres(metres) => {
                return Err(format!("a unit of {metres} m is no length; give a positive number of metres"));
            }
            UnitEntry::Name(name) => match name.as_str() {
                "mm" => 1e-3,
                "cm" => 1e-2,
                "m" => 1.0,
                "in" => 0.0254,
                "ft" => 0.3048,
                _ => {
                    return Err(format!(
                        "the unit `{name}` is unknown; write mm, cm, m, in, ft or metres as a number"
                    ));
                }
            },
        };
        Ok(Self(metres))
    }
}

/// For the numbers of [`SolveOptions`]: all are sizes, of which zero and less would never end.
pub(super) fn positive<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    let value = f64::deserialize(deserializer)?;
    if value > 0.0 && value.is_finite() {
        Ok(Some(value))
    } else {
        Err(D::Error::custom(format!("{value} is not a positive number; give one, or leave the entry out")))
    }
}

/// A part of one above 0 and below 1, written as `1%` or `0.01`.
pub fn percent(text: &str) -> Option<f64> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let part = match text.trim().strip_suffix('%') {
        Some(percent) => number(percent)? / 100.0,
        None => number(text)?,
    };
    (part > 0.0 && part < 1.0).then_some(part)
}

/// The same in a file, as text or as a number.
pub(super) fn part<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Text(String),
        Number(f64),
    }
    let text = match Written::deserialize(deserializer)? {
        Written::Text(text) => text,
        Written::Number(number) => number.to_string(),
    };
    let wrong = || D::Error::custom(format!("{text} is no accuracy; give a percentage such as \"1%\""));
    percent(&text).ok_or_else(wrong).map(Some)
}

/// Light in lumens.
enum Luminous {
    /// In lm/m².
    Exitance(Located),
    /// In lm, of each surface.
    Flux(Located),
}

/// Keys of [thermal scenes](super::load_thermal) alone.
const THERMAL: [&str; 9] = [
    "emissivity",
    "temperature",
    "emissive_power",
    "heat_flux",
    "heat",
    "linked",
    "bands",
    "surroundings",
    "enclosure",
];

/// The file, to turn places in its text into lines.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    pub fn place(&self, span: &Range<usize>) -> Place {
        let before = self.text.as_bytes().iter().take(span.start);
        Place::line(self.file, 1 + before.filter(|&&byte| byte == b'\n').count())
    }

    pub fn syntax(&self, error: &toml::de::Error) -> Error {
        let place = error.span().map_or_else(|| Place::file(self.file), |span| self.place(&span));
        let message = error.message().replace('\n', "; ");
        let hint = if THERMAL.iter().any(|key| message.starts_with(&format!("unknown field `{key}`"))) {
            "; a thermal scene is solved with --thermal"
        } else {
            ""
        };
        Problem::Malformed(message + hint).at(place)
    }

    pub fn meshes(&self, names: &Spanned<Vec<Spanned<String>>>, metres: f64) -> Result<Vec<Mesh>, Error> {
        if names.get_ref().is_empty() {
            let problem = Problem::Malformed("`meshes` is empty; name at least one mesh".to_owned());
            return Err(problem.at(self.place(&names.span())));
        }
        let read = |name: &Spanned<String>| {
            read_mesh(&self.file.with_file_name(name.get_ref()), metres, &self.place(&name.span()))
        };
        names.get_ref().iter().map(read).collect()
    }

    fn overrides(
        &self,
        entries: &BTreeMap<Spanned<String>, MaterialEntry>,
        units: Units,
    ) -> Result<BTreeMap<String, Material>, Error> {
        let material = |(name, entry): (&Spanned<String>, &MaterialEntry)| {
            let name = name.get_ref();
            let material = self.material(entry)?;
            let material = match self.luminous(name, entry, units)? {
                Some(Luminous::Exitance(exitance)) => Material { emission: Some(exitance), ..material },
                Some(Luminous::Flux(flux)) => Material { power: Some(flux), ..material },
                None => material,
            };
            Ok((name.clone(), material))
        };
        entries.iter().map(material).collect()
    }

    /// The light of a photometric entry; none where it says nothing of light.
    fn luminous(&self, name: &str, entry: &MaterialEntry, units: Units) -> Result<Option<Luminous>, Error> {
        let MaterialEntry { luminance, luminous_exitance, luminous_flux, .. } = entry;
        let at = |what: &str, span: &Range<usize>| Problem::Malformed(what.to_owned()).at(self.place(span));
        let given: Vec<_> = [
            ("luminance", luminance, PI),
            ("luminous_exitance", luminous_exitance, 1.0),
            ("luminous_flux", luminous_flux, 1.0),
        ]
        .into_iter()
        .filter_map(|(key, value, factor)| value.as_ref().map(|value| (key, value, factor)))
        .collect();
        let watts = entry.radiance.as_ref().or(entry.emission.as_ref());
        match (units, watts, &given[..]) {
            (Units::Photometric, Some(watts), _) => Err(at(
                "`radiance` and `emission` are in watts, and the scene is photometric; give `luminance` in cd/m², \
                 `luminous_exitance` in lm/m² or `luminous_flux` in lm",
                &watts.span(),
            )),
            (_, _, []) => Ok(None),
            (Units::Radiometric, _, [(_, value, _), ..]) => Err(at(
                "this is photometric; write `units = \"photometric\"` above all tables, or give `radiance` or `emission`",
                &value.span(),
            )),
            (_, _, [_, (_, second, _), ..]) => Err(at(
                "`luminance`, `luminous_exitance` and `luminous_flux` say the same; give one of them",
                &second.span(),
            )),
            (_, _, [(key, value, factor)]) => {
                let place = self.place(&value.span());
                photometric::check_photometric(name, key, *value.get_ref(), &place)?;
                let located = Located { value: Spectrum([value.get_ref() * factor; 3]), place };
                let kind = if *key == "luminous_flux" { Luminous::Flux } else { Luminous::Exitance };
                Ok(Some(kind(located)))
            }
        }
    }

    fn material(&self, entry: &MaterialEntry) -> Result<Material, Error> {
        let located = |channels: &Spanned<Channels>, factor: f64| Located {
            value: channels.get_ref().colour() * factor,
            place: self.place(&channels.span()),
        };
        let emission = match (&entry.radiance, &entry.emission) {
            (Some(_), Some(emission)) => {
                let both =
                    "`radiance` and `emission` say the same, emission = π × radiance; give one of them";
                return Err(Problem::Malformed(both.to_owned()).at(self.place(&emission.span())));
            }
            (Some(radiance), None) => Some(located(radiance, PI)),
            (None, emission) => emission.as_ref().map(|emission| located(emission, 1.0)),
        };
        Ok(Material {
            reflectance: entry.reflectance.as_ref().map(|channels| located(channels, 1.0)),
            emission,
            power: None,
        })
    }

    pub fn camera(
        &self,
        entry: &Spanned<CameraEntry>,
        metres: f64,
        compass: &Compass,
    ) -> Result<Camera, Error> {
        let camera = entry.get_ref().camera(metres, compass);
        camera
            .and_then(|camera| camera.check().map(|()| camera))
            .map_err(|problem| problem.at(self.place(&entry.span())))
    }
}

impl CameraEntry {
    fn camera(&self, metres: f64, compass: &Compass) -> Result<Camera, Problem> {
        let position = DVec3::from(self.position) * metres;
        let direction = match (self.target, self.direction) {
            (Some(target), None) => DVec3::from(target) * metres - position,
            // Of length 1, so that it survives beside a distant position; zero and NaN stay, for `check` to see.
            (None, Some(direction)) => DVec3::from(direction).normalize_or(direction.into()),
            _ => {
                let one = "the camera needs either a `target` or a `direction`; give one of them";
                return Err(Problem::Malformed(one.to_owned()));
            }
        };
        Ok(Camera {
            position,
            target: position + direction,
            up: self.up.map_or_else(|| compass.up_for(direction), DVec3::from),
            vertical_angle: self.vertical_angle.to_radians(),
        })
    }
}
