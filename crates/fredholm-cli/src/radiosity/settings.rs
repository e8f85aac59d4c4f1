//! How to solve: the command line's word before the scene file's, the scene file's before the default.

use super::args::{Method, Operator, Radiosity, Solver, Space};
use crate::args::name;
use anyhow::{Result, bail};
use clap::ValueEnum;
use fredholm::memory;
use fredholm::value::Value;
use radiosity::patches::{count_for_size, size_for_count};
use radiosity::scene::{Scene, SolveOptions};
use radiosity::solve::Options;
use std::path::Path;

/// Patches when nobody says how many: a few seconds of work, and corners without visible steps.
const PATCHES: usize = 5000;

/// So many patches are linked to clusters where nobody says how form factors are to be kept, and those of so many faces, of which
/// hardly a pair is proved to be in sight or out of it: the matrix takes 8 to 175 times as long for 10 000 patches, and 20 times
/// for those of a thousand faces.
const LINKED: usize = 10_000;
const FACES: usize = 1000;

/// Sweeps over all patches; whatever converges in use needs far fewer.
const SWEEPS: usize = 1000;

/// What was decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The discretisation.
    pub method: Method,
    /// What light is on each patch.
    pub space: Space,
    /// The solver.
    pub solver: Solver,
    /// How form factors are kept.
    pub operator: Operator,
    /// The largest side of a patch, in metres; `None` for a number of patches.
    pub patch_size: Option<f64>,
    /// About how many patches, where their size is not given.
    pub patch_count: usize,
    accuracy: f64,
    tolerance: f64,
    iterations: Option<usize>,
    ambient: bool,
}

impl Settings {
    /// What the command line and the scene file say together; `file` is named where its words are wrong.
    pub fn new<V: Value>(
        args: &Radiosity,
        wishes: &SolveOptions,
        scene: &Scene<V>,
        file: &Path,
    ) -> Result<Self> {
        let method = wish("method", wishes.method.as_deref(), file)?;
        let solver = wish("solver", wishes.solver.as_deref(), file)?;
        let size = args.patch_size.or(wishes.patch_size.filter(|_| args.patch_count.is_none()));
        let (patch_count, solver) = (args.patch_count.unwrap_or(PATCHES), args.solver.or(solver));
        let method = args.method.or(method).unwrap_or(Method::Galerkin);
        let faces = scene.polygons().len();
        let many = size.map_or(patch_count.max(faces), |size| count_for_size(scene, size) as usize);
        let linked =
            (many >= LINKED || faces >= FACES) && method == Method::Galerkin && args.space == Space::P0;
        let operator = args.operator.unwrap_or(match solver {
            Some(Solver::Southwell) => Operator::OnTheFly,
            _ if linked => Operator::Hierarchical,
            _ => Operator::Dense,
        });
        let by_rows = operator != Operator::Hierarchical;
        let settings = Self {
            method,
            space: args.space,
            solver: solver.unwrap_or(if by_rows { Solver::GaussSeidel } else { Solver::Gmres }),
            operator,
            patch_size: size,
            patch_count,
            accuracy: args.factor_accuracy.or(wishes.factor_accuracy).unwrap_or(1e-3),
            tolerance: args.tolerance.or(wishes.tolerance).unwrap_or(1e-6),
            iterations: args.iterations,
            ambient: args.ambient,
        };
        if settings.ambient && settings.solver != Solver::Southwell {
            bail!(
                "--ambient estimates the light that is still to be shot; the {} solver does not shoot, southwell does",
                name(&settings.solver)
            );
        }
        let of_links = args.checkpoint.is_some() || args.resume.is_some() || args.links.is_some();
        if of_links && settings.operator != Operator::Hierarchical {
            bail!(
                "--checkpoint, --resume and --links are of the hierarchical operator, and this is {}: say --operator hierarchical, \
                 or leave them out",
                name(&settings.operator)
            );
        }
        Ok(settings)
    }

    /// The size of a patch, in metres.
    pub fn size<V: Value>(&self, scene: &Scene<V>) -> f64 {
        self.patch_size.unwrap_or_else(|| size_for_count(scene, self.patch_count))
    }

    /// Whether a matrix of so many patches fits.
    pub fn check_memory(&self, patches: usize) -> Result<()> {
        let (needed, available) = ((patches as u64).pow(2) * 4, memory::limit());
        match needed > available {
            true => bail!(
                "{patches} patches make a matrix of {} MB, and {} MB are free: take larger patches",
                needed >> 20,
                available >> 20
            ),
            false => Ok(()),
        }
    }

    /// What the solver is told, for so many unknowns.
    pub fn options(&self, unknowns: usize) -> Options {
        let sweep = if self.solver == Solver::Southwell { unknowns } else { 1 };
        Options {
            method: self.method.into(),
            solver: self.solver.into(),
            storage: self.operator.into(),
            accuracy: self.accuracy,
            tolerance: self.tolerance,
            iterations: self.iterations.unwrap_or(SWEEPS * sweep),
            ambient: self.ambient,
            memory: memory::limit(),
        }
    }
}

/// The choice that a scene file names.
pub fn wish<T: ValueEnum>(key: &str, wish: Option<&str>, file: &Path) -> Result<Option<T>> {
    let Some(wish) = wish else { return Ok(None) };
    let Ok(choice) = T::from_str(wish, false) else {
        let known: Vec<String> = T::value_variants().iter().map(name).collect();
        bail!("{}: [solve] {key} = \"{wish}\" is unknown; write one of {}", file.display(), known.join(", "));
    };
    Ok(Some(choice))
}
