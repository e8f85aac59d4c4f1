//! u = f + ρ ⊙ (F u), ready to be solved: what all windows share, with each F that is wanted stored in the background.

use super::discrete::{Discrete, Kind};
use fredholm::value::Rgb;
use radiosity::patches::{PatchError, Patches};
use radiosity::polygon::Polygon;
use radiosity::scene::{Camera, Scene, Units};
use radiosity::visibility::Visibility;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Condvar, Mutex, OnceLock, PoisonError};

/// How the scene is made discrete.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discretisation {
    /// The largest side of a patch, in metres.
    pub size: f64,
    /// The method and the polynomials that a window begins with.
    pub kind: Kind,
    /// The standard error of a row sum.
    pub accuracy: f64,
    /// The residual at which to stop, relative to ‖f‖∞.
    pub tolerance: f64,
    /// The most bytes that the stored matrices may take.
    pub memory: u64,
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
    /// How it is made discrete.
    pub how: Discretisation,
    discrete: [OnceLock<Discrete>; Kind::COUNT],
    wanted: Mutex<VecDeque<Kind>>,
    bell: Condvar,
}

/// Width over height of the window that a camera is looked for.
const ASPECT: f64 = 1.3;

impl Stage {
    /// Cuts the scene into patches.
    pub fn new(scene: Scene<Rgb>, units: Units, how: Discretisation) -> Result<Self, PatchError> {
        let patches = Patches::new(&scene, how.size)?;
        let polygons = scene.polygons();
        let visibility = Visibility::new(&polygons);
        let discrete = std::array::from_fn(|_| OnceLock::new());
        let (wanted, bell) = (Mutex::default(), Condvar::new());
        Ok(Self { scene, units, polygons, patches, visibility, how, discrete, wanted, bell })
    }

    /// The unknowns of a kind, and its matrix.
    pub fn discrete(&self, kind: Kind) -> &Discrete {
        let taken = || self.discrete.iter().filter_map(OnceLock::get).map(Discrete::bytes).sum();
        self.discrete[kind.number()].get_or_init(|| Discrete::new(self, kind, taken()))
    }

    /// Those that a window begins with.
    pub fn first(&self) -> &Discrete {
        self.discrete(self.how.kind)
    }

    /// Has the matrix of a kind stored, if it can be and nobody has wanted it yet.
    pub fn want(&self, kind: Kind) {
        if self.discrete(kind).is_new() {
            self.wanted.lock().unwrap_or_else(PoisonError::into_inner).push_back(kind);
            self.bell.notify_one();
        }
    }

    /// Waits for the next kind that is wanted.
    pub fn wanted(&self) -> Kind {
        let mut wanted = self.wanted.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            match wanted.pop_front() {
                Some(kind) => return kind,
                None => wanted = self.bell.wait(wanted).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    /// Where the scene is looked at from at first.
    pub fn camera(&self) -> Camera {
        self.scene.camera.unwrap_or_else(|| Camera::automatic(&self.polygons, &self.visibility, ASPECT))
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
    use crate::radiosity::args::{Method, Space};
    use radiosity::patches::size_for_count;
    use radiosity::scene::cornell_box;

    /// Patch to patch, constant on each.
    pub const GALERKIN: Kind = Kind { method: Method::Galerkin, space: Space::P0 };

    /// The Cornell box in about so many patches, assembled.
    pub fn cornell(count: usize) -> Stage {
        let scene = cornell_box();
        let how = Discretisation {
            size: size_for_count(&scene, count),
            kind: GALERKIN,
            accuracy: 1e-3,
            tolerance: 1e-6,
            memory: 1 << 30,
        };
        let stage = Stage::new(scene, Units::Radiometric, how).unwrap();
        stage.first().assemble(&stage);
        stage
    }

    #[test]
    fn surfaces_have_their_patches() {
        assert_eq!(ranges(&[0, 0, 2, 2, 2], 4), [0..2, 2..2, 2..5, 5..5]);
    }

    #[test]
    fn what_is_not_stored_is_bounded_from_above() {
        let stage = cornell(200);
        let reflectance = &stage.patches.reflectance;
        let norm = stage.first().norm(reflectance, stage.how.accuracy);
        let fresh = Stage::new(cornell_box(), Units::Radiometric, stage.how).unwrap();
        assert!(fresh.first().matrix().is_none());
        assert!(fresh.first().norm(reflectance, stage.how.accuracy) >= norm && norm > 0.5);
        // Nothing is known of what factors between points add up to.
        let points = fresh.discrete(Kind { method: Method::Nystrom, ..GALERKIN });
        assert_eq!(points.norm(reflectance, stage.how.accuracy), f64::INFINITY);
    }

    #[test]
    fn a_matrix_is_wanted_once_and_only_where_there_is_room() {
        let how = Discretisation { memory: 1 << 20, ..cornell(200).how };
        let stage = Stage::new(cornell_box(), Units::Radiometric, how).unwrap();
        let linear = Kind { space: Space::P1, ..GALERKIN };
        for kind in [GALERKIN, GALERKIN, linear, Kind { method: Method::Nystrom, ..GALERKIN }] {
            stage.want(kind);
        }
        assert!(stage.discrete(linear).dim() > 3 * stage.patches.len());
        assert!(!stage.discrete(linear).is_stored, "{} unknowns", stage.discrete(linear).dim());
        let first = stage.wanted();
        assert_eq!((first, stage.wanted().method), (GALERKIN, Method::Nystrom));
    }
}
