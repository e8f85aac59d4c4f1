//! A scene solved to an accuracy: of few faces by what is between any two of them, of many by links.

use super::Progress;
use anyhow::Result;
use fredholm::memory;
use fredholm::value::Value;
use radiosity::adaptive::{self, Bound, Domain, Round};
use radiosity::linked;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::reconstruct::Lit;
use radiosity::scene::{Light, Scene};
use radiosity::visibility::Visibility;

/// Faces up to which each is held against each: with some thousand of them, hardly a pair of which is proved to be in sight, that takes
/// minutes.
const FEW: usize = 1000;

/// A scene before it is solved.
pub struct Ground<'a, V> {
    scene: &'a Scene<V>,
    polygons: &'a [Polygon],
    /// Who sees whom.
    pub visibility: Visibility,
    few: Option<Domain<'a, V>>,
}

impl<'a, V: Value> Ground<'a, V> {
    /// `polygons` are those of the scene, in its order.
    pub fn new(scene: &'a Scene<V>, polygons: &'a [Polygon]) -> Result<Self> {
        let visibility = Visibility::new(polygons);
        let has_sky = scene.lights.iter().any(|light| matches!(light, Light::Sky(_)));
        // Rays to a sky, in other directions from point to point, make no light that a polynomial would follow.
        let is_few = polygons.len() <= FEW && (!has_sky || visibility.clips_sky());
        let few = is_few.then(|| Domain::new(scene, polygons)).transpose()?;
        Ok(Self { scene, polygons, visibility, few })
    }

    /// Solves, with a bar on the terminal, and tells of the rounds.
    pub fn solve(&self, accuracy: f64) -> Result<(Solved<'_, V>, Vec<Round>)> {
        let mut rounds = Vec::new();
        let progress = Progress::new(accuracy);
        let observe = |round: &Round| {
            progress.tell(round);
            rounds.push(*round);
            true
        };
        let solved = match &self.few {
            Some(domain) => {
                let request = adaptive::Request { accuracy, ..adaptive::Request::default() };
                Solved::Few(Box::new(adaptive::solve(domain, &request, observe)))
            }
            None => {
                let request =
                    linked::Request { accuracy, memory: memory::limit(), ..linked::Request::default() };
                let faces = (self.polygons, &self.visibility);
                Solved::Many(Box::new(linked::solve(self.scene, faces, &request, observe)?))
            }
        };
        progress.finish();
        Ok((solved, rounds))
    }
}

/// The answer.
pub enum Solved<'a, V> {
    /// Of few faces.
    Few(Box<adaptive::Field<'a, V>>),
    /// Of many.
    Many(Box<linked::Field<'a, V>>),
}

impl<'a, V: Value> Solved<'a, V> {
    /// The error.
    pub fn bound(&self) -> Bound {
        match self {
            Self::Few(field) => field.bound(),
            Self::Many(field) => field.bound(),
        }
    }

    /// What light is on a patch.
    pub fn elements(&self) -> &'static str {
        match self {
            Self::Few(_) => "patches of degree 2 with",
            Self::Many(_) => "patches, linear between middles and corners, with",
        }
    }

    /// The mesh of the answer, with means over its parts.
    pub fn parts(&self, scene: &Scene<V>) -> Parts<V> {
        match self {
            Self::Few(field) => Parts::new(scene, field),
            Self::Many(field) => Parts {
                patches: field.patches().clone(),
                radiosity: field.radiosity().to_vec(),
                irradiance: field.irradiance().to_vec(),
            },
        }
    }

    /// The same answer, to be looked at in so many points.
    pub fn for_points(self, count: usize) -> Box<dyn Lit<V> + 'a> {
        match self {
            Self::Few(field) => Box::new(field.for_points(count)),
            Self::Many(field) => field,
        }
    }
}

/// The mesh of the answer, with means over its parts.
pub struct Parts<V> {
    /// The parts.
    pub patches: Patches<V>,
    /// Their radiosity, in W/m².
    pub radiosity: Vec<V>,
    /// Their irradiance, in W/m².
    pub irradiance: Vec<V>,
}

impl<V: Value> Parts<V> {
    fn new(scene: &Scene<V>, field: &adaptive::Field<'_, V>) -> Self {
        let parts = field.parts();
        let by_face = parts.chunk_by(|a, b| a.face == b.face);
        let polygons = by_face.map(|parts| parts.iter().map(|part| part.polygon.clone()).collect());
        Self {
            patches: Patches::from_parts(scene, polygons),
            radiosity: parts.iter().map(|part| part.radiosity).collect(),
            irradiance: parts.iter().map(|part| part.irradiance).collect(),
        }
    }
}
