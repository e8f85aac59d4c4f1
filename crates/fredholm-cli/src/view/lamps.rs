//! f = Σ_k g_k f_k: the source as a sum over lamps, since the solution is the same sum, u = Σ_k g_k u_k.

use fredholm::value::{Rgb, Value};
use radiosity::lights::mean_irradiances;
use radiosity::patches::Patches;
use radiosity::scene::{Light, Scene};
use radiosity::visibility::Visibility;

/// A part of the source that can be dimmed.
pub struct Lamp {
    /// What it is called.
    pub name: String,
    /// The surfaces that emit, by number and in their order; none of what is no surface.
    pub surfaces: Vec<usize>,
    /// The lights of the scene that are no surfaces, by number; none of a surface.
    pub points: Vec<usize>,
    /// What these send to each patch, in the unit of irradiance; empty if it is a surface.
    irradiance: Vec<Rgb>,
}

/// More lamps than this are no use on a page; the rest is dimmed together.
const MOST: usize = 24;

/// The surfaces that emit, in the order of the scene, then what else shines.
pub fn lamps(scene: &Scene<Rgb>, patches: &Patches<Rgb>, visibility: &Visibility) -> Vec<Lamp> {
    let emits = |s: &usize| scene.surfaces[*s].emission.magnitude() > 0.0;
    let of_surface = |s: usize| Lamp {
        name: scene.surfaces[s].name.clone(),
        surfaces: vec![s],
        points: Vec::new(),
        irradiance: Vec::new(),
    };
    let mut lamps: Vec<Lamp> = (0..scene.surfaces.len()).filter(emits).map(of_surface).collect();
    let mut alone = patches.clone();
    for (k, light) in scene.lights.iter().enumerate() {
        alone.lights = vec![light.clone()];
        let irradiance = mean_irradiances(&alone, visibility);
        let name = match light {
            Light::Point(_) => format!("{} {}", light.kind(), k + 1),
            Light::Sun(_) | Light::Sky(_) => light.kind().to_owned(),
        };
        lamps.push(Lamp { name, surfaces: Vec::new(), points: vec![k], irradiance });
    }
    if lamps.len() > MOST {
        let rest = lamps.split_off(MOST - 1);
        lamps.push(together(rest));
    }
    lamps
}

/// Some lamps as one.
fn together(lamps: Vec<Lamp>) -> Lamp {
    let mut all = Lamp {
        name: format!("the other {} lamps", lamps.len()),
        surfaces: Vec::new(),
        points: Vec::new(),
        irradiance: Vec::new(),
    };
    for lamp in lamps {
        all.surfaces.extend(lamp.surfaces);
        all.points.extend(lamp.points);
        if all.irradiance.is_empty() {
            all.irradiance = lamp.irradiance;
        } else {
            all.irradiance.iter_mut().zip(lamp.irradiance).for_each(|(sum, h)| *sum += h);
        }
    }
    all
}

impl Lamp {
    /// Adds g f_k = g (E_k + ρ H_k) to a source.
    pub fn add_to(&self, source: &mut [Rgb], gain: f64, patches: &Patches<Rgb>, reflectance: &[Rgb]) {
        for (i, f) in source.iter_mut().enumerate() {
            if self.surfaces.binary_search(&(patches.surface[i] as usize)).is_ok() {
                *f += patches.emission[i] * gain;
            }
        }
        self.add_points_to(source, gain, reflectance);
    }

    /// Adds the part of it that comes from points, g ρ H_k.
    pub fn add_points_to(&self, source: &mut [Rgb], gain: f64, reflectance: &[Rgb]) {
        let parts = self.irradiance.iter().zip(reflectance);
        source.iter_mut().zip(parts).for_each(|(f, (h, rho))| *f += *rho * *h * gain);
    }

    /// f_k, of this lamp alone.
    pub fn source(&self, patches: &Patches<Rgb>, reflectance: &[Rgb]) -> Vec<Rgb> {
        let mut source = vec![Rgb::splat(0.0); patches.len()];
        self.add_to(&mut source, 1.0, patches, reflectance);
        source
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fredholm::value::{Spectrum, max_norm};
    use radiosity::scene::{PointLight, cornell_box};
    use radiosity::solve;

    /// The Cornell box with two point lights in it.
    fn lit() -> Scene<Rgb> {
        let mut scene = cornell_box();
        let floor = scene.polygons()[0].clone();
        let light = |height: f64, red: f64| {
            let position = floor.centroid() + floor.normal() * height;
            PointLight::uniform(position, Spectrum([red, 1.0, 2.0])).into()
        };
        scene.lights = vec![light(0.2, 1.0), light(0.3, 3.0)];
        scene
    }

    #[test]
    fn the_parts_add_up_to_the_source() {
        let scene = lit();
        let patches = Patches::new(&scene, 0.3).unwrap();
        let visibility = Visibility::new(&scene.polygons());
        let lit = mean_irradiances(&patches, &visibility);
        let mut rest = solve::source(&patches.emission, &patches.reflectance, &lit);
        let size = max_norm(&rest);
        let lamps = lamps(&scene, &patches, &visibility);
        assert_eq!(lamps.len(), 3);
        for lamp in &lamps {
            lamp.add_to(&mut rest, -1.0, &patches, &patches.reflectance);
        }
        assert!(max_norm(&rest) < 1e-12 * size);
    }

    #[test]
    fn many_lamps_are_few_and_none_is_lost() {
        let mut scene = lit();
        let first = scene.lights[0].clone();
        scene.lights.resize(40, first);
        let patches = Patches::new(&scene, 0.5).unwrap();
        let visibility = Visibility::new(&scene.polygons());
        let all = lamps(&scene, &patches, &visibility);
        assert_eq!((all.len(), all[23].name.as_str()), (24, "the other 18 lamps"));
        let sum = all.iter().fold(vec![Rgb::splat(0.0); patches.len()], |mut sum, lamp| {
            lamp.add_to(&mut sum, 1.0, &patches, &patches.reflectance);
            sum
        });
        let lit = mean_irradiances(&patches, &visibility);
        let expected = solve::source(&patches.emission, &patches.reflectance, &lit);
        let off: Vec<Rgb> = sum.iter().zip(&expected).map(|(a, b)| *a - *b).collect();
        assert!(max_norm(&off) < 1e-9 * max_norm(&expected));
    }
}
