//! Σ_j F_ij = 1 in a closed scene: what an enclosure lets escape, and by how much the rows miss 1.

use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The closure test of a scene's form factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closure {
    /// Light escapes to infinity: row sums need not be 1.
    Open {
        /// The part of the sampled rays that meet nothing.
        escaping: f64,
    },
    /// No sampled ray escapes.
    Closed {
        /// max |Σ_j F_ij − 1| over the rows checked.
        defect: f64,
        /// How many rows were checked: those of patches that see nothing but fronts. A patch under a block that
        /// stands on it sees the block's inside, whose back sends nothing, and its row is rightly less than 1.
        rows: usize,
    },
}

impl Closure {
    /// From the sums of some `rows` of F; which rows they are is given with them.
    pub fn test<V: Value>(patches: &Patches<V>, visibility: &Visibility, rows: &[(usize, f64)]) -> Self {
        let normal = |polygon| patches.normal_of(polygon);
        let sight = |i: usize| Sight::from(&patches.polygons[i], visibility, normal);
        let sights: Vec<Sight> = rows.par_iter().map(|&(i, _)| sight(i)).collect();
        // A patch lying on another's front sees past it, and the other hides all: it is out of the enclosure.
        let buried = |sum: f64, sight: &Sight| sum == 0.0 && sight.escaped == RAYS;
        let all_buried = rows.iter().zip(&sights).all(|((_, sum), sight)| buried(*sum, sight));
        let escaped: u32 = rows
            .iter()
            .zip(&sights)
            .filter(|((_, sum), sight)| all_buried || !buried(*sum, sight))
            .map(|(_, sight)| sight.escaped)
            .sum();
        if escaped > 0 {
            return Self::Open { escaping: f64::from(escaped) / (sights.len() as f64 * f64::from(RAYS)) };
        }
        let whole = rows.iter().zip(&sights).filter(|(_, sight)| sight.backs == 0 && sight.escaped == 0);
        let defects = whole.map(|((_, sum), _)| (sum - 1.0).abs());
        let (defect, rows) = defects.fold((0.0_f64, 0), |(worst, n), defect| (worst.max(defect), n + 1));
        Self::Closed { defect, rows }
    }
}

/// Whether some faces are an enclosure, and the rows of which of them are to add up to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    /// The part of the sampled rays that meet nothing; 0 in an enclosure.
    pub escaping: f64,
    /// Of each row, whether its faces see nothing but fronts. A face under a block that stands on it sees the block's
    /// inside, whose back sends nothing, and its row is rightly less than 1.
    pub whole: Vec<bool>,
}

impl Enclosure {
    /// From rows of faces: the polygons of each row, and the sum of its factors.
    pub fn test(
        polygons: &[Polygon],
        visibility: &Visibility,
        rows: impl IndexedParallelIterator<Item = (Vec<usize>, f64)>,
    ) -> Self {
        let normal = |polygon: u32| polygons[polygon as usize].normal();
        let sight_of = |faces: &[usize]| {
            let sights = faces.iter().map(|&k| Sight::from(&polygons[k], visibility, normal));
            sights.fold(Sight { escaped: 0, backs: 0 }, |sum, sight| Sight {
                escaped: sum.escaped + sight.escaped,
                backs: sum.backs + sight.backs,
            })
        };
        // As in `Closure::test`: what lies on another's front and sees past it is out of the enclosure.
        let look = |(faces, sum): (Vec<usize>, f64)| {
            let (sight, rays) = (sight_of(&faces), RAYS * faces.len() as u32);
            (sum == 0.0 && sight.escaped == rays, sight, rays)
        };
        let looks: Vec<(bool, Sight, u32)> = rows.map(look).collect();
        let all_buried = looks.iter().all(|(buried, ..)| *buried);
        let counted = || looks.iter().filter(|(buried, ..)| all_buried || !buried);
        let escaped: u32 = counted().map(|(_, sight, _)| sight.escaped).sum();
        let rays: u32 = counted().map(|(.., rays)| rays).sum();
        let whole = looks.iter().map(|(_, sight, _)| sight.escaped == 0 && sight.backs == 0);
        Self { escaping: f64::from(escaped) / f64::from(rays.max(1)), whole: whole.collect() }
    }

    /// Whether no sampled ray escapes.
    pub fn is_closed(&self) -> bool {
        self.escaping == 0.0
    }
}

/// Rays from each patch. A leak of a hundredth of the sky is met by half the patches.
const RAYS: u32 = 64;

/// What the rays from a patch meet that is no front.
struct Sight {
    escaped: u32,
    backs: u32,
}

impl Sight {
    fn from(patch: &Polygon, visibility: &Visibility, normal_of: impl Fn(u32) -> DVec3) -> Self {
        let across = (patch.vertices()[1] - patch.vertices()[0]).normalize();
        let along = patch.normal().cross(across);
        let mut sight = Self { escaped: 0, backs: 0 };
        for k in 0..RAYS {
            // R₄ would do as well; the fractional parts of the golden ratio's kin spread start and direction.
            let [s, t, u, v] =
                [0.8566, 0.7338, 0.6287, 0.5385].map(|step| (0.5 + step * f64::from(k)).fract());
            let direction = cosine_direction(u, v);
            let direction = across * direction.x + along * direction.y + patch.normal() * direction.z;
            match visibility.nearest(patch.point(s, t), direction) {
                None => sight.escaped += 1,
                Some(hit) if normal_of(hit.polygon).dot(direction) > 0.0 => sight.backs += 1,
                Some(_) => (),
            }
        }
        sight
    }
}

/// A direction of the upper half space with density cosθ/π, for u, v uniform in [0, 1).
pub fn cosine_direction(u: f64, v: f64) -> DVec3 {
    let (sin, cos) = (TAU * v).sin_cos();
    let radius = u.sqrt();
    DVec3::new(radius * cos, radius * sin, (1.0 - u).sqrt())
}
