//! What shines in a scene beside its surfaces, as reports tell it.

use crate::text::{percent, short};
use fredholm::value::Value;
use radiosity::lights::{FAR, nearest_lit};
use radiosity::reconstruct::Rays;
use radiosity::scene::{Aimed, Distribution, Light, PointLight, Scene, Units};
use radiosity::sky::{self, Kind};
use serde::Serialize;

/// The lights of a scene that are no surfaces.
#[derive(Clone, Debug, Serialize)]
pub struct Lights {
    /// How many are points: spots and luminaires among them.
    point_lights: usize,
    /// Points with the intensities of photometric files.
    luminaires: Vec<Luminaire>,
    /// Those infinitely far away.
    suns: Vec<Sun>,
    /// What is around the scene.
    sky: Option<Sky>,
    /// The unit of their flux.
    flux_unit: &'static str,
    #[serde(skip)]
    unit: &'static str,
}

/// A luminaire.
#[derive(Clone, Debug, Serialize)]
struct Luminaire {
    file: String,
    /// As it shines in the scene, by channel.
    flux: Vec<f64>,
    /// Of the intensities in the file, in lm.
    integrated_lumens: f64,
    /// Of its lamps, as the file says.
    lamp_lumens: Option<f64>,
    /// Of the luminaire, as the file says.
    stated_lumens: Option<f64>,
    /// The largest side of what shines, in metres.
    size: f64,
    /// How far it is to the nearest surface that it shines on, in metres; nothing where it has no size.
    nearest_surface: Option<f64>,
    /// Whether that is so near that the luminaire is no point.
    is_near: bool,
}

impl Luminaire {
    fn of<V: Value>(light: &PointLight<V>, scene: &Scene<V>) -> Option<Self> {
        let Distribution::Measured(Aimed { web, .. }) = &light.distribution else { return None };
        let flux = light.intensity * light.distribution.flux_of_unit();
        let nearest = nearest_lit(light, scene).filter(|distance| distance.is_finite());
        Some(Self {
            file: web.name.clone(),
            flux: flux.channels().to_vec(),
            integrated_lumens: web.flux(),
            lamp_lumens: web.lamps,
            stated_lumens: web.stated,
            size: web.size,
            nearest_surface: nearest,
            is_near: nearest.is_some_and(|distance| distance < FAR * web.size),
        })
    }

    fn line(&self, unit: &str) -> String {
        let mut words = vec![format!("{}: {}", self.file, amount(&self.flux, unit))];
        let mut file = vec![format!("{} lm by integration", four(self.integrated_lumens))];
        file.extend(self.stated_lumens.map(|flux| format!("{} lm as it says", four(flux))));
        file.extend(self.lamp_lumens.map(|flux| format!("{} lm of its lamps", four(flux))));
        words.push(format!("of the file {}", file.join(", ")));
        if let (true, Some(distance)) = (self.is_near, self.nearest_surface) {
            words.push(format!(
                "NEAR: it is {} m large and {} m from a surface, where it is no point; from {} m on it is one",
                short(self.size),
                four(distance),
                four(FAR * self.size)
            ));
        }
        words.join("; ")
    }
}

/// A sun.
#[derive(Clone, Debug, Serialize)]
struct Sun {
    /// Of a plane across its beam, by channel, in the unit of irradiance.
    normal_irradiance: Vec<f64>,
    /// The way that its light goes.
    direction: [f64; 3],
}

/// A sky.
#[derive(Clone, Debug, Serialize)]
struct Sky {
    /// Its kind, with its number.
    kind: String,
    /// By channel, in the unit of radiance.
    zenith_radiance: Vec<f64>,
    /// Of a horizontal from which all of it is seen, by channel, in the unit of irradiance.
    horizontal_irradiance: Vec<f64>,
    zenith_unit: &'static str,
    /// In how many parts it is integrated.
    cells: usize,
    /// By how much it may differ from its formula in any direction, and so any irradiance from it: relative.
    largest_relative_error: f64,
    /// The rays from each point that find how much of it is seen; none where that is found without.
    rays: Option<usize>,
}

impl Sky {
    fn of<V: Value>(light: &Light<V>, scene: &Scene<V>, units: Units) -> Option<Self> {
        let Light::Sky(sky) = light else { return None };
        let polygons: usize = scene.surfaces.iter().map(|surface| surface.polygons.len()).sum();
        let kind = match sky.dome.model().kind() {
            Kind::Uniform => "uniform".to_owned(),
            Kind::Overcast => "CIE overcast (1 + 2 sin of the elevation)/3".to_owned(),
            Kind::General(number) => format!("CIE general sky {number}"),
        };
        Some(Self {
            kind,
            zenith_radiance: sky.zenith.channels().to_vec(),
            horizontal_irradiance: (sky.zenith * sky.dome.horizontal()).channels().to_vec(),
            zenith_unit: units.radiance(),
            cells: sky.dome.cells(),
            largest_relative_error: sky.dome.error(),
            rays: (polygons > sky::FEW).then_some(Rays::MANY),
        })
    }

    fn line(&self, unit: &str) -> String {
        let error = match (self.rays, self.largest_relative_error) {
            (Some(rays), _) => format!("seen by {rays} rays from a point, mostly to 0.5 % of it"),
            (None, rounding) if rounding < 1e-9 => "exact".to_owned(),
            (None, error) => format!("to {} in any direction", percent(error)),
        };
        format!(
            "{}: {} on a free horizontal, {} at the zenith; {error}",
            self.kind,
            amount(&self.horizontal_irradiance, unit),
            amount(&self.zenith_radiance, self.zenith_unit)
        )
    }
}

impl Lights {
    /// Those of a scene.
    pub fn new<V: Value>(scene: &Scene<V>, units: Units) -> Self {
        let sun = |light: &Light<V>| match light {
            Light::Sun(sun) => Some(Sun {
                normal_irradiance: sun.irradiance.channels().to_vec(),
                direction: sun.direction.to_array(),
            }),
            Light::Point(_) | Light::Sky(_) => None,
        };
        let points = || {
            scene.lights.iter().filter_map(|light| match light {
                Light::Point(light) => Some(light),
                Light::Sun(_) | Light::Sky(_) => None,
            })
        };
        Self {
            luminaires: points().filter_map(|light| Luminaire::of(light, scene)).collect(),
            flux_unit: if units == Units::Photometric { "lm" } else { "W" },
            point_lights: points().count(),
            suns: scene.lights.iter().filter_map(sun).collect(),
            sky: scene.lights.iter().find_map(|light| Sky::of(light, scene, units)),
            unit: units.irradiance(),
        }
    }

    /// Whether what leaves the scene meets a sky.
    pub fn has_sky(&self) -> bool {
        self.sky.is_some()
    }

    /// A line of a table for each.
    pub fn lines(&self) -> impl Iterator<Item = (&'static str, String)> {
        let points = (self.point_lights > 0).then(|| ("point lights", self.point_lights.to_string()));
        let sun = |sun: &Sun| {
            let text =
                format!("{} across its beam, with sharp shadows", amount(&sun.normal_irradiance, self.unit));
            ("sun", text)
        };
        let luminaires = self.luminaires.iter().map(|light| ("luminaire", light.line(self.flux_unit)));
        let sky = self.sky.iter().map(|sky| ("sky", sky.line(self.unit)));
        points.into_iter().chain(luminaires).chain(self.suns.iter().map(sun)).chain(sky)
    }
}

/// One number where all channels are the same.
fn amount(channels: &[f64], unit: &str) -> String {
    let one = channels.iter().all(|c| *c == channels[0]);
    let shown = if one { &channels[..1] } else { channels };
    let words: Vec<String> = shown.iter().map(|c| four(*c)).collect();
    format!("{} {unit}", words.join(", "))
}

/// Four digits.
fn four(number: f64) -> String {
    short(format!("{number:.3e}").parse().unwrap_or(number))
}
