//! F_ij as a method of the paper has it, on polynomials of some degree: its unknowns, and F once it is stored.

use super::kept::Kept;
use super::lamps::{Lamp, lamps};
use super::shared::Shared;
use super::stage::Stage;
use crate::radiosity::args::{Method, Space as Degrees};
use fredholm::discretize::{Coupling, Nystrom};
use fredholm::operator::{Dense, OnTheFly};
use fredholm::quadrature::Quadrature;
use fredholm::system::{norm_bound, row_sums};
use fredholm::value::{Rgb, max_norm};
use radiosity::elements::{Degree, Elements, Space};
use radiosity::form_factor::FormFactors;
use radiosity::kernel::{Lambertian, SurfacePoint};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How the equation becomes numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Kind {
    /// What F_ij is.
    pub method: Method,
    /// What light is on each patch.
    pub space: Degrees,
}

impl Kind {
    /// How many there are.
    pub const COUNT: usize = 9;

    /// Its number among them.
    pub fn number(self) -> usize {
        3 * self.method as usize + self.space as usize
    }

    fn degree(self) -> Degree {
        self.space.degree().unwrap_or(Degree::Constant)
    }
}

/// The space of a kind on the patches of a stage.
pub fn space(stage: &Stage, kind: Kind) -> Space<'_> {
    Space::new(&stage.patches.polygons, kind.degree())
}

/// F, computed when it is asked for.
pub enum Factors<'a> {
    /// From patches, or from their centres, to patches on which light is constant.
    Patches(FormFactors<'a>),
    /// From point to point.
    Points(Nystrom<Lambertian<'a>, SurfacePoint>),
    /// To patches on which light is a polynomial.
    Elements(Elements<'a>),
}

impl<'a> Factors<'a> {
    /// Of a kind, whose space that is.
    pub fn new(stage: &'a Stage, kind: Kind, space: &'a Space<'a>) -> Self {
        let Stage { patches, visibility, how, .. } = stage;
        let accuracy = how.accuracy;
        match (kind.method, kind.degree()) {
            (Method::Nystrom, _) => {
                let nodes = space.interpolate(|node| *node);
                let rule = Quadrature { nodes, weights: space.weights().to_vec() };
                Self::Points(Nystrom::new(Lambertian::new(visibility), rule))
            }
            (Method::Galerkin, Degree::Constant) => {
                Self::Patches(FormFactors::patch_to_patch(patches, visibility, accuracy))
            }
            (Method::Collocation, Degree::Constant) => {
                Self::Patches(FormFactors::point_to_patch(patches, visibility, accuracy))
            }
            (Method::Galerkin, _) => Self::Elements(Elements::galerkin(space, patches, visibility, accuracy)),
            (Method::Collocation, _) => {
                Self::Elements(Elements::collocation(space, patches, visibility, accuracy))
            }
        }
    }

    fn coupling(&self) -> &dyn Coupling {
        match self {
            Self::Patches(factors) => factors,
            Self::Points(factors) => factors,
            Self::Elements(factors) => factors,
        }
    }
}

/// A row is asked for at once, so that one call that is looked up costs nothing.
impl Coupling for Factors<'_> {
    fn dim(&self) -> usize {
        self.coupling().dim()
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        self.coupling().entry(i, j)
    }
    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        self.coupling().row(i, from, row);
    }
    fn band(&self, i: usize) -> usize {
        self.coupling().band(i)
    }
    fn rows(&self, first: usize, from: usize, rows: &mut [f64]) {
        self.coupling().rows(first, from, rows);
    }
    fn reciprocity(&self) -> Option<&[f64]> {
        self.coupling().reciprocity()
    }
}

/// The matrix, or why there is none.
type Assembled = Result<Matrix, String>;

/// F, stored.
pub struct Matrix {
    /// Its entries.
    pub entries: Dense<f32>,
    /// Σ_j |F_ij| of each row.
    sums: Vec<f64>,
}

/// The unknowns of a kind, and its matrix: what all windows share.
pub struct Discrete {
    /// Which it is.
    pub kind: Kind,
    /// The area that each unknown stands for, in m².
    pub weights: Vec<f64>,
    /// The surface of each.
    pub surface: Vec<u32>,
    /// The parts of the source that can be dimmed.
    pub lamps: Vec<Lamp>,
    /// Whether there is room for its matrix.
    pub is_stored: bool,
    wanted: AtomicBool,
    assembled: OnceLock<Assembled>,
    entries: AtomicU64,
    shared: Shared,
}

/// A shot into more unknowns than this takes longer than a frame. The matrix of so many takes 1.6 GB and, on two cores,
/// half a minute; of 10 000 it would be the windows that wait for nothing, of 50 000 the machine that is gone for minutes.
const STORED: usize = 20_000;

impl Discrete {
    /// Of a kind; `taken` is what the matrices of others take, in bytes.
    pub fn new(stage: &Stage, kind: Kind, taken: u64) -> Self {
        let space = space(stage, kind);
        let n = space.dim();
        Self {
            kind,
            weights: space.weights().to_vec(),
            surface: space.spread(&stage.patches.surface),
            lamps: lamps(&stage.scene, &stage.patches, &space, &stage.visibility),
            is_stored: n <= STORED && taken + bytes(n) <= stage.how.memory,
            wanted: AtomicBool::new(false),
            assembled: OnceLock::new(),
            entries: AtomicU64::new(0),
            shared: Shared::new(n, stage.how.memory),
        }
    }

    /// The number of unknowns.
    pub fn dim(&self) -> usize {
        self.weights.len()
    }

    /// What its matrix takes, in bytes.
    pub fn bytes(&self) -> u64 {
        if self.is_stored { bytes(self.dim()) } else { 0 }
    }

    /// Whether nobody has wanted it before, and it can be stored.
    pub fn is_new(&self) -> bool {
        self.is_stored && !self.wanted.swap(true, Ordering::Relaxed)
    }

    /// Computes and stores F; takes as long as it takes.
    pub fn assemble(&self, stage: &Stage) {
        let count = |entries: usize| {
            self.entries.fetch_add(entries as u64, Ordering::Relaxed);
        };
        let space = space(stage, self.kind);
        let factors = Factors::new(stage, self.kind, &space);
        let assembled = Dense::<f32>::assemble(&factors, count).map_or_else(
            |error| Err(format!("{error}; do two patches lie in one place?")),
            |entries| {
                let rows: Vec<usize> = (0..self.dim()).collect();
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
    pub fn kept<'a>(&'a self, computed: &'a Factors<'a>) -> Kept<'a> {
        match self.matrix() {
            Some(Ok(matrix)) => Kept::Stored(&matrix.entries),
            _ => Kept::Computed(OnTheFly(computed), &self.shared),
        }
    }

    /// How many form factors are computed, and of how many.
    pub fn progress(&self) -> (u64, u64) {
        let n = self.dim() as u64;
        let all = if self.kind.method == Method::Galerkin { n * (n + 1) / 2 } else { n * n };
        (self.entries.load(Ordering::Relaxed), all)
    }

    /// max_i Σ_j |F_ij|: of the stored rows, or else for factors of patches 1 and three times the standard error, as
    /// `radiosity::solve` has it. Others may add up to anything.
    pub fn row_sum(&self, accuracy: f64) -> f64 {
        match self.matrix() {
            Some(Ok(matrix)) => matrix.sums.iter().copied().fold(0.0, f64::max),
            _ if self.kind.method != Method::Nystrom && self.kind.space == Degrees::P0 => {
                1.0 + 3.0 * accuracy
            }
            _ => f64::INFINITY,
        }
    }

    /// ‖ρF‖∞ for these reflectances of unknowns.
    pub fn norm(&self, reflectance: &[Rgb], accuracy: f64) -> f64 {
        match self.matrix() {
            Some(Ok(matrix)) => norm_bound(reflectance, &matrix.sums),
            _ => max_norm(reflectance) * self.row_sum(accuracy),
        }
    }

    /// A value of each surface, for each unknown.
    pub fn spread<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.surface.iter().map(|&surface| values[surface as usize]).collect()
    }
}

fn bytes(n: usize) -> u64 {
    (n as u64).pow(2) * 4
}
