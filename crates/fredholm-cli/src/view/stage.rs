//! u = f + ρ ⊙ (F u), ready to be solved: what all windows share, with F stored in the background.

use super::kept::Kept;
use super::lamps::{Lamp, lamps};
use super::shared::Shared;
use fredholm::operator::{Dense, OnTheFly};
use fredholm::system::row_sums;
use fredholm::value::{Rgb, Spectrum, max_norm};
use radiosity::form_factor::FormFactors;
use radiosity::patches::{PatchError, Patches};
use radiosity::polygon::Polygon;
use radiosity::scene::{Camera, Scene, Units};
use radiosity::visibility::Visibility;
use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// How the scene is made discrete.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discretisation {
    /// The largest side of a patch, in metres.
    pub size: f64,
    /// Whether light is tested over the whole of a patch (Galerkin), and not at its centre (collocation).
    pub whole: bool,
    /// The standard error of a row sum.
    pub accuracy: f64,
    /// The residual at which to stop, relative to ‖f‖∞.
    pub tolerance: f64,
    /// The most bytes that the stored matrix may take.
    pub memory: u64,
}

/// The matrix, or why there is none.
type Assembled = Result<Matrix, String>;

/// F, stored.
pub struct Matrix {
    /// Its entries.
    pub entries: Dense<f32>,
    /// Σ_j F_ij of each row.
    pub sums: Vec<f64>,
}

/// A scene made ready.
pub struct Stage {
    /// The scene, as it was loaded.
    pub scene: Scene<Rgb>,
    /// What its light is measured in.
    pub units: Units,
    /// Its polygons, in the order of its surfaces.
    pub polygons: Vec<Polygon>,
    /// Its patches.
    pub patches: Patches<Rgb>,
    /// Who sees whom.
    pub visibility: Visibility,
    /// The parts of its source that can be dimmed.
    pub lamps: Vec<Lamp>,
    /// How it is made discrete.
    pub how: Discretisation,
    assembled: OnceLock<Assembled>,
    entries: AtomicU64,
    shared: Shared,
}

/// A shot into more patches than this takes longer than a frame. The matrix of so many takes 1.6 GB and, on two cores,
/// half a minute; of 10 000 it would be the windows that wait for nothing, of 50 000 the machine that is gone for minutes.
const STORED: usize = 20_000;

/// Width over height of the window that a camera is looked for.
const ASPECT: f64 = 1.3;

impl Stage {
    /// Cuts the scene into patches, and finds what its lamps do.
    pub fn new(scene: Scene<Rgb>, units: Units, how: Discretisation) -> Result<Self, PatchError> {
        let patches = Patches::new(&scene, how.size)?;
        let polygons = scene.polygons();
        let visibility = Visibility::new(&polygons);
        let lamps = lamps(&scene, &patches, &visibility);
        let (assembled, entries) = (OnceLock::new(), AtomicU64::new(0));
        let shared = Shared::new(patches.len(), how.memory);
        Ok(Self { scene, units, polygons, patches, visibility, lamps, how, assembled, entries, shared })
    }

    /// The form factors, computed when they are asked for.
    pub fn form_factors(&self) -> FormFactors<'_> {
        let Self { patches, visibility, how, .. } = self;
        match how.whole {
            true => FormFactors::patch_to_patch(patches, visibility, how.accuracy),
            false => FormFactors::point_to_patch(patches, visibility, how.accuracy),
        }
    }

    /// Whether F is going to be stored.
    pub fn is_stored(&self) -> bool {
        let n = self.patches.len();
        n <= STORED && (n as u64).pow(2) * 4 <= self.how.memory
    }

    /// Computes and stores F; takes as long as it takes.
    pub fn assemble(&self) {
        let count = |entries: usize| {
            self.entries.fetch_add(entries as u64, Ordering::Relaxed);
        };
        let assembled = Dense::<f32>::assemble(&self.form_factors(), count).map_or_else(
            |error| Err(format!("{error}; do two patches lie in one place?")),
            |entries| {
                let rows: Vec<usize> = (0..self.patches.len()).collect();
                let sums = row_sums(&entries, &rows);
                Ok(Matrix { entries, sums })
            },
        );
        // Nobody else assembles; a second result would be the same.
        let _ = self.assembled.set(assembled);
    }

    /// The matrix, once it is there, or why it never will be.
    pub fn matrix(&self) -> Option<&Assembled> {
        self.assembled.get()
    }

    /// F as it is at hand.
    pub fn kept<'a>(&'a self, computed: &'a FormFactors<'a>) -> Kept<'a> {
        match self.matrix() {
            Some(Ok(matrix)) => Kept::Stored(&matrix.entries),
            _ => Kept::Computed(OnTheFly(computed), &self.shared),
        }
    }

    /// How many form factors are computed, and of how many.
    pub fn progress(&self) -> (u64, u64) {
        let n = self.patches.len() as u64;
        let all = if self.how.whole { n * (n + 1) / 2 } else { n * n };
        (self.entries.load(Ordering::Relaxed), all)
    }

    /// max_i Σ_j F_ij: of the stored rows, or else 1 and three times the standard error, as `radiosity::solve` has it.
    pub fn row_sum(&self) -> f64 {
        match self.matrix() {
            Some(Ok(matrix)) => matrix.sums.iter().copied().fold(0.0, f64::max),
            _ => 1.0 + 3.0 * self.how.accuracy,
        }
    }

    /// ‖ρF‖∞ for these reflectances of patches.
    pub fn norm(&self, reflectance: &[Rgb]) -> f64 {
        match self.matrix() {
            Some(Ok(matrix)) => fredholm::system::norm_bound(reflectance, &matrix.sums),
            _ => max_norm(reflectance) * self.row_sum(),
        }
    }

    /// Where the scene is looked at from at first.
    pub fn camera(&self) -> Camera {
        self.scene.camera.unwrap_or_else(|| Camera::automatic(&self.polygons, &self.visibility, ASPECT))
    }

    /// A value of each surface, for each patch.
    pub fn spread(&self, values: &[[f64; 3]]) -> Vec<Rgb> {
        self.patches.surface.iter().map(|&surface| Spectrum(values[surface as usize])).collect()
    }
}

/// Which patches lie on each of `count` surfaces; they are in their order.
pub fn ranges(surface: &[u32], count: usize) -> Vec<Range<usize>> {
    let end = |s: usize| surface.partition_point(|&own| own as usize <= s);
    (0..count).map(|s| if s == 0 { 0..end(0) } else { end(s - 1)..end(s) }).collect()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use radiosity::patches::size_for_count;
    use radiosity::scene::cornell_box;

    /// The Cornell box in about so many patches, assembled.
    pub fn cornell(count: usize) -> Stage {
        let scene = cornell_box();
        let how = Discretisation {
            size: size_for_count(&scene, count),
            whole: true,
            accuracy: 1e-3,
            tolerance: 1e-6,
            memory: 1 << 30,
        };
        let stage = Stage::new(scene, Units::Radiometric, how).unwrap();
        stage.assemble();
        stage
    }

    #[test]
    fn surfaces_have_their_patches() {
        assert_eq!(ranges(&[0, 0, 2, 2, 2], 4), [0..2, 2..2, 2..5, 5..5]);
    }

    #[test]
    fn what_is_not_stored_is_bounded_from_above() {
        let stage = cornell(200);
        let norm = stage.norm(&stage.patches.reflectance);
        let fresh = Stage::new(cornell_box(), Units::Radiometric, stage.how).unwrap();
        assert!(fresh.matrix().is_none() && fresh.norm(&fresh.patches.reflectance) >= norm && norm > 0.5);
    }
}
