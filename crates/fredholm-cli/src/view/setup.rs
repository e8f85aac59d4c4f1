//! f = Σ_k g_k f_k and ρ, as a page asks for them: what is solved, and by which solvers.

use super::discrete::{Discrete, Kind};
use super::solvers::Solver;
use super::stage::Stage;
use anyhow::{Result, bail};
use fredholm::value::{Rgb, Spectrum, Value, max_norm};
use radiosity::patches::Patches;
use radiosity::scene::{Scene, Surface};

/// What is to be solved, checked.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The method, and the polynomials on patches.
    pub kind: Kind,
    /// One solver, or two that race.
    pub solvers: Vec<Solver>,
    /// A factor for each lamp.
    pub gains: Vec<f64>,
    /// ρ of each surface.
    of_surfaces: Vec<[f64; 3]>,
    /// ρ of each unknown.
    pub reflectance: Vec<Rgb>,
    /// f of each unknown.
    pub source: Vec<Rgb>,
    /// H from point lights of each unknown.
    pub lit: Vec<Rgb>,
    /// The residual at which to stop.
    pub target: f64,
}

/// A lamp may be so many times as bright as in the file; more would only be a slip.
const BRIGHTEST: f64 = 1e3;

/// The reflectance up to which a page may go. At 1 light would never end.
const WHITEST: f64 = 0.99;

impl Setup {
    /// As the file says.
    pub fn of(stage: &Stage, solver: Solver) -> Self {
        let reflectance = stage.scene.surfaces.iter().map(|surface| surface.reflectance.0).collect();
        let first = stage.first();
        Self::made(stage, first, vec![solver], vec![1.0; first.lamps.len()], reflectance)
    }

    /// As a page says, if that makes sense.
    pub fn new(
        stage: &Stage,
        kind: Kind,
        solvers: Vec<Solver>,
        gains: Vec<f64>,
        reflectance: Vec<[f64; 3]>,
    ) -> Result<Self> {
        if solvers.is_empty() || solvers.len() > 2 {
            bail!("{} solvers are asked for; one runs, or two race", solvers.len());
        }
        let discrete = stage.discrete(kind);
        let lamps = discrete.lamps.len();
        if gains.len() != lamps {
            bail!("{} factors for {lamps} lamps: give one for each", gains.len());
        }
        if let Some(bad) = gains.iter().find(|gain| !(0.0..=BRIGHTEST).contains(*gain)) {
            bail!("a lamp {bad} times as bright: give a factor from 0 to {BRIGHTEST}");
        }
        check(stage, &reflectance)?;
        Ok(Self::made(stage, discrete, solvers, gains, reflectance))
    }

    fn made(
        stage: &Stage,
        discrete: &Discrete,
        solvers: Vec<Solver>,
        gains: Vec<f64>,
        of_surfaces: Vec<[f64; 3]>,
    ) -> Self {
        let colours: Vec<Rgb> = of_surfaces.iter().map(|rho| Spectrum(*rho)).collect();
        let reflectance = discrete.spread(&colours);
        let (zeros, ones) =
            (vec![Rgb::splat(0.0); reflectance.len()], vec![Rgb::splat(1.0); reflectance.len()]);
        let (mut source, mut lit) = (zeros.clone(), zeros);
        for (lamp, gain) in discrete.lamps.iter().zip(&gains) {
            lamp.add_to(&mut source, *gain, (&stage.scene, &discrete.surface), &reflectance);
            lamp.add_points_to(&mut lit, *gain, &ones);
        }
        let target = stage.how.tolerance * max_norm(&source);
        Self { kind: discrete.kind, solvers, gains, of_surfaces, reflectance, source, lit, target }
    }

    /// The scene and its patches with these lamps and reflectances.
    pub fn applied(&self, stage: &Stage) -> (Scene<Rgb>, Patches<Rgb>) {
        let mut scene = stage.scene.clone();
        for (surface, rho) in scene.surfaces.iter_mut().zip(&self.of_surfaces) {
            surface.reflectance = Spectrum(*rho);
        }
        for (lamp, gain) in stage.discrete(self.kind).lamps.iter().zip(&self.gains) {
            for &s in &lamp.surfaces {
                scene.surfaces[s].emission = stage.scene.surfaces[s].emission * *gain;
            }
            for &k in &lamp.points {
                scene.lights[k] = stage.scene.lights[k].scaled(*gain);
            }
        }
        let mut patches = stage.patches.clone();
        for (rho, &s) in patches.reflectance.iter_mut().zip(&patches.surface) {
            *rho = scene.surfaces[s as usize].reflectance;
        }
        patches.lights.clone_from(&scene.lights);
        for (e, &s) in patches.emission.iter_mut().zip(&patches.surface) {
            *e = scene.surfaces[s as usize].emission;
        }
        (scene, patches)
    }
}

/// Refuses reflectances that are none.
pub fn check(stage: &Stage, reflectance: &[[f64; 3]]) -> Result<()> {
    let surfaces = stage.scene.surfaces.len();
    if reflectance.len() != surfaces {
        bail!("{} reflectances for {surfaces} surfaces: give one for each", reflectance.len());
    }
    // A file may go further than a page, up to 1.
    let own = stage.scene.surfaces.iter().map(|surface| surface.reflectance.0);
    for (given, own) in reflectance.iter().zip(own) {
        let is_fine = |(rho, own): (&f64, f64)| (0.0..=WHITEST.max(own)).contains(rho);
        if !given.iter().zip(own).all(is_fine) {
            bail!("a reflectance of {given:?}: give numbers from 0 to {WHITEST}");
        }
    }
    Ok(())
}

/// The one channel of a photometric scene.
pub fn grey(scene: &Scene<Rgb>) -> Scene<f64> {
    let surface = |surface: &Surface<Rgb>| Surface {
        name: surface.name.clone(),
        reflectance: surface.reflectance.0[0],
        emission: surface.emission.0[0],
        polygons: surface.polygons.clone(),
    };
    Scene {
        name: scene.name.clone(),
        surfaces: scene.surfaces.iter().map(surface).collect(),
        lights: scene.lights.iter().map(|light| light.with(light.amount().0[0])).collect(),
        camera: scene.camera,
    }
}
