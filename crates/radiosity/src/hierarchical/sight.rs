//! What patches see of a sender: the part of their rays that arrives.

use super::cut::SMALL;
use super::eyes::LANES;
use super::factor::{Column, Element, Factors, Link, Receivers};
use super::random::Random;
use crate::kernel;
use crate::polygon::Polygon;
use fredholm::operator::hierarchical::Cluster;
use glam::DVec3;
use prefetch_index::prefetch_index;

/// Room for the rays of a column, and what they have met.
#[derive(Default)]
pub(super) struct Sight {
    rays: Vec<Ray>,
    seen: Vec<Seen>,
}

/// A ray of a patch, by its number in the column.
struct Ray {
    patch: usize,
    random: Random,
    /// The part of the sender that it goes to, how far into what that sends, and the place of the patch there.
    part: Cluster,
    u: f64,
    place: usize,
    ends: Option<[DVec3; 2]>,
}

/// How many rays of a patch there are, how many of them have two ends that face each other, and how many of these arrive.
#[derive(Clone, Copy, Default)]
struct Seen {
    aimed: u32,
    cast: u32,
    arrived: u32,
}

/// What rays are aimed by.
struct Aim<'a> {
    receivers: &'a Receivers<'a>,
    link: &'a Link,
    elements: &'a [Element],
    shares: &'a [f64],
    /// Where in the sender the first ray goes, of what comes from it.
    begin: f64,
}

/// Rays between two patches: most, and least if they are near and what they exchange is more than this part of what is worth one.
const MOST_RAYS: u32 = 32;
const LEAST_RAYS: u32 = 8;
const NEAR_MATTERS: f64 = 0.25;

/// So much less is worth a ray where others of the column have arrived and others not. A ray that says all or nothing of a link that
/// counts is what most of the noise is made of: with one in twenty rays more it is a sixth to a third less.
const KEENER: f64 = 32.0;

/// Another seed than that of rays.
const COLUMN: u64 = 0xc01a;

/// How often a ray is drawn anew that would leave or arrive at a back.
const TRIES: usize = 4;

/// The golden section: its multiples lie evenly between 0 and 1, however many there are.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// How many rays a form factor is worth.
fn wanted(factor: f64, worth: f64) -> u32 {
    ((factor / worth).ceil() as u32).clamp(1, MOST_RAYS)
}

impl Seen {
    /// The part that arrives, of patches that have rays.
    fn part(&self) -> f64 {
        match self {
            Self { aimed: 0, .. } => 1.0,
            Self { cast: 0, .. } => 0.0,
            Self { cast, arrived, .. } => f64::from(*arrived) / f64::from(*cast),
        }
    }
}

impl Factors<'_> {
    /// Lets arrive what rays do.
    ///
    /// To each place of a cluster go as many of them as light comes from there: what is near or bright sends more, and less of it is
    /// hidden, as what lies under others is dark.
    pub fn cast(&self, receivers: &Receivers<'_>, link: &Link, column: &mut Column) {
        let Column { factors, cast, shares, elements, sight: Sight { rays, seen } } = column;
        let mut random = Random::new(self.seed ^ COLUMN, receivers.first as u64, link.number);
        let begin = random.next();
        let most = factors.iter().fold(0.0, |most: f64, factor| most.max(*factor));
        let chance = most / (SMALL * link.worth);
        if chance < 1.0 && !self.fine {
            if random.next() >= chance {
                return factors.fill(0.0);
            }
            factors.iter_mut().for_each(|whole| *whole *= chance.recip());
        }
        rays.clear();
        seen.clear();
        seen.resize(factors.len(), Seen::default());
        let aim = Aim { receivers, link, elements, shares, begin };
        for (k, (whole, here)) in factors.iter_mut().zip(receivers.parts).enumerate() {
            let wanted = wanted(*whole, link.worth);
            if *whole > NEAR_MATTERS * link.worth && self.is_near(here, link.sender) {
                *whole *= self.seen_near(receivers, link, (k, wanted.max(LEAST_RAYS)), cast);
            } else if *whole > 0.0 {
                self.aim(&aim, (k, wanted), &mut seen[k], rays);
            }
        }
        self.trace(receivers, rays, seen);
        let first = rays.len();
        let [all, clear] =
            seen.iter().fold([0, 0], |[all, clear], seen| [all + seen.cast, clear + seen.arrived]);
        for (k, whole) in factors.iter().enumerate().filter(|(_, whole)| **whole > 0.0) {
            // What its own rays have met must not say whether a patch has more of them: those that met nothing would stay as they are.
            let [all, clear] = [all - seen[k].cast, clear - seen[k].arrived];
            if seen[k].aimed > 0 && 0 < clear && clear < all {
                self.aim(&aim, (k, wanted(*whole, link.worth / KEENER)), &mut seen[k], rays);
            }
        }
        self.trace(receivers, &mut rays[first..], seen);
        *cast += seen.iter().map(|seen| u64::from(seen.cast)).sum::<u64>();
        factors.iter_mut().zip(seen).for_each(|(factor, seen)| *factor *= seen.part());
    }

    /// Aims rays of a patch until it has so many.
    fn aim(&self, aim: &Aim<'_>, (k, wanted): (usize, u32), seen: &mut Seen, rays: &mut Vec<Ray>) {
        let shares = aim.shares.iter().skip(k).step_by(LANES * aim.receivers.eyes.len()).copied();
        for ray in seen.aimed..wanted {
            let u = (aim.begin + GOLDEN * rays.len() as f64).fract();
            let (part, u) =
                share(shares.clone(), u).map_or((aim.link.sender, u), |(k, u)| (aim.elements[k].part, u));
            // What a look for the place will read is asked for before the first look, so that none waits for memory.
            prefetch_index(&self.before, self.likely(part, u));
            let random = self.random(aim.receivers, aim.link, k, ray);
            rays.push(Ray { patch: k, part, u, place: 0, random, ends: None });
        }
        seen.aimed = seen.aimed.max(wanted);
    }

    /// Casts rays. Where all of them go is looked up before the first, and asked for: so these do not wait for memory either.
    fn trace(&self, receivers: &Receivers<'_>, rays: &mut [Ray], seen: &mut [Seen]) {
        let spots = &self.clusters.spots;
        for ray in &mut *rays {
            ray.place = self.at(ray.part, ray.u);
            spots.fetch(ray.place);
        }
        for ray in &mut *rays {
            // Of a cluster, or beyond a horizon, not all faces the patch: what turns its back has no part in the formula either.
            for _ in 0..TRIES {
                let here = &receivers.parts[ray.patch];
                let ends = [ray.random.point(here), spots.point(&spots.at(ray.place), &mut ray.random)];
                if kernel::unoccluded(&ends[0], &ends[1]) > 0.0 {
                    ray.ends = Some(ends.map(|end| end.position));
                    break;
                }
                ray.place = self.at(ray.part, ray.random.next());
            }
        }
        for (patch, [x, y]) in rays.iter().filter_map(|ray| Some((ray.patch, ray.ends?))) {
            seen[patch].cast += 1;
            seen[patch].arrived += u32::from(self.visibility.unoccluded(x, y));
        }
    }

    /// The place that [`at`](Self::at) finds if all patches of the cluster send alike, as they mostly do.
    fn likely(&self, cluster: Cluster, u: f64) -> usize {
        let range = self.clusters.tree.range(cluster);
        range.start + (u * range.len() as f64) as usize
    }

    /// The place of the patch of a cluster that a part `u` of what comes from it does from, 0 ≤ u < 1.
    fn at(&self, cluster: Cluster, u: f64) -> usize {
        let range = self.clusters.tree.range(cluster);
        let (from, to) = (self.before[range.start], self.before[range.end]);
        let sent = from + u * (to - from);
        // It is looked for from where it is likely to be, farther and farther away.
        let likely = self.likely(cluster, u);
        let is_before = |place: usize| self.before[place] <= sent;
        let (mut low, mut high, mut step) = (likely, likely + 1, 1);
        while low > range.start && !is_before(low) {
            (low, high) = (low.saturating_sub(step).max(range.start), low);
            step *= 2;
        }
        while high < range.end && is_before(high) {
            (low, high) = (high, (high + step).min(range.end));
            step *= 2;
        }
        low + self.before[low + 1..high].partition_point(|before| *before <= sent)
    }

    /// Numbers for a ray of a patch.
    fn random(&self, receivers: &Receivers<'_>, link: &Link, k: usize, ray: u32) -> Random {
        Random::new(
            self.seed,
            (receivers.first + k) as u64,
            link.number * u64::from(MOST_RAYS) + u64::from(ray),
        )
    }

    /// What a patch sees of one that is near, as a part: near patches see each other from where the kernel is large, or do not: rays
    /// are weighed by it, and one tells nothing.
    fn seen_near(
        &self,
        receivers: &Receivers<'_>,
        link: &Link,
        (k, rays): (usize, u32),
        cast: &mut u64,
    ) -> f64 {
        let (mut all, mut clear) = (0.0, 0.0);
        let here = &receivers.parts[k];
        let there = &self.clusters.polygons[self.clusters.tree.range(link.sender).start];
        for ray in 0..rays {
            let mut random = self.random(receivers, link, k, ray);
            let drawn = (0..TRIES).find_map(|_| {
                let ends = [here, there].map(|polygon| random.point(polygon));
                let kernel = kernel::unoccluded(&ends[0], &ends[1]);
                // The kernel is infinite where two patches touch: one point of many.
                (kernel > 0.0 && kernel.is_finite()).then_some((ends, kernel))
            });
            if let Some(([x, y], kernel)) = drawn {
                *cast += 1;
                all += kernel;
                clear += if self.visibility.unoccluded(x.position, y.position) { kernel } else { 0.0 };
            }
        }
        if all > 0.0 { clear / all } else { 0.0 }
    }

    /// Whether a cluster is a patch that is no further than twice the size of the larger of both.
    fn is_near(&self, here: &Polygon, sender: Cluster) -> bool {
        let Some(other) = self.clusters.leaf(sender) else { return false };
        let there = &self.clusters.polygons[other];
        let size = here.area().max(there.area()).sqrt();
        here.centroid().distance_squared(there.centroid()) < 4.0 * size * size
    }
}

/// The share that a part `u` of the sum of all is in, 0 ≤ u < 1, and how far in; none if there are no shares.
fn share(shares: impl Iterator<Item = f64> + Clone, u: f64) -> Option<(usize, f64)> {
    let mut rest = u * shares.clone().sum::<f64>();
    let mut last = None;
    for (k, share) in shares.enumerate().filter(|(_, share)| *share > 0.0) {
        if rest < share {
            return Some((k, rest / share));
        }
        rest -= share;
        last = Some((k, ALMOST_ONE));
    }
    last
}

/// The largest part of a whole that is none.
const ALMOST_ONE: f64 = 1.0 - f64::EPSILON;

#[cfg(test)]
mod tests {
    use super::super::clusters::cornell_clusters;
    use super::*;

    #[test]
    fn rays_go_to_where_light_comes_from() {
        let (visibility, clusters) = cornell_clusters(0.1);
        // Some patches are a thousand times as bright as their neighbours, some are black.
        let brightness: Vec<f64> = (0..clusters.wholes.len())
            .map(|k| [0.0, 1.0, 1000.0, 2.0][(4.0 * Random::new(1, k as u64, 0).next()) as usize])
            .collect();
        let factors = Factors::new(&clusters, &visibility, &brightness, 0);
        let sent = |place: usize| factors.before[place + 1] - factors.before[place];
        for cluster in clusters.tree.top_down() {
            let range = clusters.tree.range(cluster);
            let all: f64 = range.clone().map(sent).sum();
            if all == 0.0 {
                continue;
            }
            for k in 0..64 {
                let u = (f64::from(k) + 0.5) / 64.0;
                let place = factors.at(cluster, u);
                let before: f64 = (range.start..place).map(sent).sum();
                let is_there =
                    before <= u * all * (1.0 + 1e-12) && u * all <= (before + sent(place)) * (1.0 + 1e-12);
                assert!(range.contains(&place) && is_there, "{place} of {range:?} for {u}");
            }
        }
    }

    #[test]
    fn a_share_is_found_by_its_size() {
        let shares = [0.0, 1.0, 0.0, 3.0, 0.0];
        let at = |u: f64| share(shares.into_iter(), u);
        assert_eq!(at(0.0), Some((1, 0.0)));
        assert_eq!(at(0.125), Some((1, 0.5)));
        assert_eq!(at(0.25), Some((3, 0.0)));
        assert_eq!(at(0.625), Some((3, 0.5)));
        assert_eq!(at(ALMOST_ONE).map(|(k, _)| k), Some(3));
        assert_eq!(share(std::iter::empty(), 0.5), None);
        assert_eq!(share(std::iter::once(0.0), 0.5), None);
    }

    /// Rays that tell what is seen, and seeds.
    const RAYS: usize = 20_000;
    const SEEDS: u64 = 4000;

    #[test]
    fn patches_that_have_more_rays_see_the_same_in_the_mean() {
        let (visibility, clusters) = cornell_clusters(0.1);
        let ones = vec![1.0; clusters.wholes.len()];
        let leaves: Vec<Cluster> = clusters.tree.leaves().collect();
        let seen = |here: &Polygon, there: &Polygon, rays: usize| {
            let mut random = Random::new(7, 0, 0);
            let mut ends = || [here, there].map(|polygon| random.point(polygon));
            let faces = std::iter::from_fn(|| Some(ends())).filter(|[x, y]| kernel::unoccluded(x, y) > 0.0);
            let clear =
                |[x, y]: &[crate::kernel::SurfacePoint; 2]| visibility.unoccluded(x.position, y.position);
            faces.take(rays).filter(clear).count() as f64 / rays as f64
        };
        let faces = |here: &Polygon, there: &Polygon| {
            here.vertices().iter().all(|x| there.height_of(*x) > 1e-3)
                && there.vertices().iter().all(|y| here.height_of(*y) > 1e-3)
        };
        // Three patches side by side that see a fifth or so of a fourth.
        let triples = (0..leaves.len() - 3).flat_map(|i| (0..leaves.len()).map(move |j| (i, j)));
        let in_part = |(i, j): &(usize, usize)| {
            let there = &clusters.polygons[*j];
            clusters.polygons[*i..*i + 3].iter().all(|here| {
                faces(here, there)
                    && here.centroid().distance(there.centroid()) > 0.3
                    && (0.1..0.3).contains(&seen(here, there, 40))
            })
        };
        let (i, j) = triples.into_iter().find(in_part).unwrap();
        let receivers =
            Factors::new(&clusters, &visibility, &ones, 0).receivers(&clusters.polygons[i..i + 3], i);
        let link = |clear: bool, worth: f64| Link { sender: leaves[j], weight: 1.0, number: 0, clear, worth };
        let mut column = Column::default();
        Factors::new(&clusters, &visibility, &ones, 0).column(&receivers, &link(true, 1.0), &mut column);
        let wholes = column.factors.clone();
        let link = link(false, wholes.iter().fold(0.0, |most: f64, whole| most.max(*whole)));
        let (mut sums, mut cast) = ([0.0; 3], 0);
        for seed in 0..SEEDS {
            Factors::new(&clusters, &visibility, &ones, seed).column(&receivers, &link, &mut column);
            sums.iter_mut().zip(&column.factors).for_each(|(sum, factor)| *sum += factor);
            cast += column.cast;
        }
        assert!(cast > 6 * SEEDS, "many have more than one: {cast}");
        for (k, (sum, whole)) in sums.iter().zip(&wholes).enumerate() {
            let part = sum / SEEDS as f64 / whole;
            let exact = seen(&clusters.polygons[i + k], &clusters.polygons[j], RAYS);
            assert!((part - exact).abs() < 0.02, "{part} of {exact}");
        }
    }
}
