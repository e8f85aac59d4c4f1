//! The visible part Σ K V / Σ K of a form factor, from as many rays as the error asked for needs.
//!
//! A row of F adds up factors F_ij of which a visible part p_j is estimated with N_j rays: its variance is
//! Σ_j F_ij² p_j (1 − p_j) / N_j. With N_j = F_ij p_j (1 − p_j) / ε² that is ε² Σ_j F_ij ≤ ε²: large factors and
//! penumbrae get many rays, small factors few, and the row sum has a standard error below ε. The points are
//! low-discrepancy ones, so that the error is mostly smaller.

use crate::kernel::{self, SurfacePoint};
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use glam::DVec3;

/// The rays of a first look, on which the number needed is judged.
const FIRST: u32 = 16;

/// A bound on the work of one pair, at a standard error of 10⁻³ of its factor.
const MOST: u32 = 1 << 18;

/// The part of patch b visible from the centroid of a, and the rays cast.
///
/// `weight` is F/ε²: the number of rays is `weight` p (1 − p) for a visible part p.
pub(super) fn from_point(
    visibility: &Visibility,
    a: &Polygon,
    b: &Polygon,
    pair: (usize, usize),
    weight: f64,
) -> (f64, u32) {
    sample(visibility, a, b, pair, weight, |_, _| (a.centroid(), 1.0))
}

/// The part of the light exchanged between patches a and b that arrives, and the rays cast; `weight` as above.
pub(super) fn from_area(
    visibility: &Visibility,
    a: &Polygon,
    b: &Polygon,
    pair: (usize, usize),
    weight: f64,
) -> (f64, u32) {
    sample(visibility, a, b, pair, weight, |s, t| (a.point(s, t), a.density(s, t)))
}

fn sample(
    visibility: &Visibility,
    a: &Polygon,
    b: &Polygon,
    pair: (usize, usize),
    weight: f64,
    start: impl Fn(f64, f64) -> (DVec3, f64),
) -> (f64, u32) {
    if visibility.certainly_clear(a, b) {
        return (1.0, 0);
    }
    if let Some(id) = visibility.blocker(a.centroid(), b.centroid())
        && visibility.certainly_blocks(id, a, b)
    {
        return (0.0, 1);
    }
    let mut look = Look::default();
    let mut sequence = Sequence::new(pair);
    let mut cast = 1;
    let mut needed = FIRST;
    while cast <= needed {
        let [s, t, u, v] = sequence.next();
        let ((x, density_x), (y, density_y)) = (start(s, t), (b.point(u, v), b.density(u, v)));
        let k = kernel::unoccluded(
            &SurfacePoint { position: x, normal: a.normal() },
            &SurfacePoint { position: y, normal: b.normal() },
        );
        // An infinite kernel: the two points coincide, where the patches touch. It is one point of many.
        if k > 0.0 && k.is_finite() {
            look.add(k * density_x * density_y, visibility.blocker(x, y));
        }
        cast += 1;
        if cast == FIRST + 1 {
            needed = look.needed(weight);
        }
    }
    (look.visible_part(), cast)
}

/// What the rays have seen.
#[derive(Default)]
struct Look {
    rays: u32,
    clear_rays: u32,
    all: f64,
    clear: f64,
    /// The polygon that has stopped every ray so far.
    one_blocker: Option<u32>,
}

impl Look {
    fn add(&mut self, weight: f64, blocker: Option<u32>) {
        self.one_blocker = if self.rays == 0 || self.one_blocker == blocker { blocker } else { None };
        self.rays += 1;
        self.all += weight;
        if blocker.is_none() {
            self.clear_rays += 1;
            self.clear += weight;
        }
    }

    /// Rays for the error asked for. (k + 1)/(n + 2), Laplace's rule, keeps a part unseen in a few rays from
    /// being taken for none.
    fn needed(&self, weight: f64) -> u32 {
        let p = f64::from(self.clear_rays + 1) / f64::from(self.rays + 2);
        ((weight * p * (1.0 - p)).ceil() as u32).clamp(FIRST, MOST)
    }

    fn visible_part(&self) -> f64 {
        if self.all > 0.0 { self.clear / self.all } else { 0.0 }
    }
}

/// A low-discrepancy sequence in [0,1)⁴ (Roberts' R₄: multiples of the powers of the inverse of the root of
/// x⁵ = x + 1), shifted by a hash of the pair so that the errors of different pairs do not add up.
struct Sequence([f64; 4]);

impl Sequence {
    fn new((i, j): (usize, usize)) -> Self {
        let seed = mix(((i as u64) << 32) ^ j as u64);
        Self(std::array::from_fn(|k| unit(mix(seed ^ (k as u64 + 1)))))
    }

    fn next(&mut self) -> [f64; 4] {
        const STEPS: [f64; 4] =
            [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_037_808_6, 0.538_597_257_223_61];
        for (x, step) in self.0.iter_mut().zip(STEPS) {
            *x = (*x + step).fract();
        }
        self.0
    }
}

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A hash as a number in [0, 1).
fn unit(hash: u64) -> f64 {
    (hash >> 11) as f64 / (1_u64 << 53) as f64
}
