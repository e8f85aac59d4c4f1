//! From patches to links: a tree, then cuts, then the factors of each link.

use super::block::Blocks;
use super::clusters::{Clusters, Sender, Whole, up_to};
use super::cut::{Cuts, Found, Hidden};
use super::factor::{Column, Factors, Link};
use super::kept::Kept;
use super::spot::Spot;
use super::{Hierarchical, Statistics};
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::krylov::Gmres;
use fredholm::operator::Operator;
use fredholm::operator::hierarchical::Cluster;
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::system::{System, SystemError};
use fredholm::value::{Value, max_norm};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// What is known of the light, or guessed, by patch: how bright it is and what arrives, in W/m², of the brightest channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    pub(super) brightness: Vec<f64>,
    pub(super) arriving: Vec<f64>,
}

/// Patches on which less than this part of the mean arrives are as well known as those on which it does: what counts is the error
/// of all patches together.
const DIM: f64 = 0.25;

impl Light {
    /// As if what is emitted were spread evenly: the ambient term of progressive radiosity (paper, §3.5.2).
    pub fn ambient<V: Value>(patches: &Patches<V>, source: &[V]) -> Self {
        let (areas, rho) = (&patches.areas, &patches.reflectance);
        let total: f64 = areas.iter().sum();
        let mean =
            |values: &[V]| areas.iter().zip(values).map(|(a, v)| a * v.magnitude()).sum::<f64>() / total;
        let ambient = mean(source) / (1.0 - mean(rho).min(MOST_REFLECTED));
        let brightness = source.iter().zip(rho).map(|(f, rho)| f.magnitude() + rho.magnitude() * ambient);
        Self { brightness: brightness.collect(), arriving: vec![ambient; source.len()] }
    }

    /// From a solution: radiosity and irradiance.
    pub fn of<V: Value>(patches: &Patches<V>, radiosity: &[V], irradiance: &[V]) -> Self {
        let areas = &patches.areas;
        let total: f64 = areas.iter().sum();
        let mean = areas.iter().zip(irradiance).map(|(a, h)| a * h.magnitude()).sum::<f64>() / total;
        Self {
            brightness: radiosity.iter().map(V::magnitude).collect(),
            arriving: irradiance.iter().map(|h| h.magnitude().max(DIM * mean)).collect(),
        }
    }
}

/// What links are made for, and how.
struct Work<'a> {
    light: &'a Light,
    part: f64,
    seed: u64,
}

/// How much more a link of a sketch may bring. Sixteen times as much tells the light as well as twice as much.
const COARSER: f64 = 16.0;

/// The residual of a sketch's solution, and the sweeps for it: brightness need not be known better.
const SKETCH: (f64, usize) = (1e-3, 20);

/// A scene that reflects more than that in the mean has this ambient term.
const MOST_REFLECTED: f64 = 0.95;

/// Patches that share a cut.
const TOGETHER: usize = 16;

/// Patches that share what seems hidden, at least and at most: more in large scenes.
const NEIGHBOURS: [usize; 2] = [256, 4096];

/// A scene is done in about so many parts at least, more than there are cores, mostly; in fewer where these would have too few patches.
const REGIONS: usize = 64;

/// Receivers whose links tell how many there will be, and the seed of their rays.
const LOOKS: usize = 64;
const LOOKS_SEED: u64 = 0x100c;

/// A cluster of patches whose links are found one after the other, and the numbers of its receivers.
#[derive(Clone, Debug)]
struct Region {
    cluster: Cluster,
    receivers: Range<usize>,
}

/// Bytes that clusters of so many patches take, two for each.
pub fn clusters_bytes(patches: usize) -> u64 {
    let cluster = size_of::<Whole>() + size_of::<Sender>() + 14 * size_of::<f64>();
    let patch = size_of::<Polygon>() + size_of::<Spot>() + 4 * size_of::<usize>();
    (patches * (2 * cluster + patch)) as u64
}

/// Patches in clusters, before there are links.
pub struct Plan<'a, V> {
    pub(super) patches: &'a Patches<V>,
    pub(super) visibility: &'a Visibility,
    pub(super) clusters: Arc<Clusters>,
    receivers: Vec<Cluster>,
    regions: Vec<Region>,
    shaped: bool,
}

impl<'a, V: Value> Plan<'a, V> {
    /// For these patches, which `visibility` is of.
    pub fn new(patches: &'a Patches<V>, visibility: &'a Visibility) -> Self {
        let clusters = Clusters::new(patches, visibility);
        let tree = &clusters.tree;
        let receivers = up_to(tree, TOGETHER);
        let [few, many] = NEIGHBOURS;
        let regions = up_to(tree, (patches.len() / REGIONS).clamp(few, many)).into_iter().map(|cluster| {
            let [first, end] = [tree.range(cluster).start, tree.range(cluster).end]
                .map(|place| receivers.partition_point(|receiver| tree.range(*receiver).start < place));
            Region { cluster, receivers: first..end }
        });
        let regions = regions.collect();
        Self { patches, visibility, clusters: Arc::new(clusters), receivers, regions, shaped: false }
    }

    /// With links that know how bright the parts of a cluster are beside the whole, and send more of what is near and bright: better for
    /// light such as was known before, but no longer form factors, that add up to 1 and are reciprocal.
    pub(crate) fn shaped(self) -> Self {
        Self { shaped: true, ..self }
    }

    /// About how many bytes the clusters and their links will take, where one may bring a `part` of what arrives.
    pub fn bytes(&self, light: &Light, part: f64) -> u64 {
        let step = self.receivers.len().div_ceil(LOOKS).max(1);
        let looked: Vec<Cluster> = self.receivers.iter().copied().step_by(step).collect();
        let work = Work { light, part, seed: LOOKS_SEED };
        let means = self.means(light);
        let (cuts, factors) =
            (self.cuts(&means, part, Some(work.seed)), self.factors(&means, work.seed, false));
        let bytes = |receiver: &Cluster| {
            let (mut found, mut blocks) = (Vec::new(), Blocks::default());
            cuts.of(*receiver, &mut Hidden::from(*receiver), &mut found);
            self.block(*receiver, (&cuts, &factors), &work, &found, &mut blocks);
            blocks.bytes()
        };
        let looks: u64 = looked.par_iter().map(bytes).sum();
        looks * self.receivers.len() as u64 / looked.len().max(1) as u64 + clusters_bytes(self.patches.len())
    }

    /// Brightness, its standard deviation, and what arrives, by cluster.
    pub(super) fn means(&self, light: &Light) -> [Vec<f64>; 3] {
        let squares: Vec<f64> = light.brightness.iter().map(|b| b * b).collect();
        let [brightness, squares, arriving] =
            [&light.brightness, &squares, &light.arriving].map(|values| self.clusters.means(values));
        let deviation =
            brightness.iter().zip(squares).map(|(mean, square)| (square - mean * mean).max(0.0).sqrt());
        [deviation.collect(), brightness, arriving]
    }

    pub(super) fn cuts<'b>(
        &'b self,
        [deviation, brightness, arriving]: &'b [Vec<f64>; 3],
        part: f64,
        draws: Option<u64>,
    ) -> Cuts<'b> {
        let (clusters, visibility) = (&*self.clusters, self.visibility);
        Cuts { clusters, visibility, brightness, deviation, arriving, part, draws }
    }

    pub(super) fn factors<'b>(
        &'b self,
        [_, brightness, _]: &'b [Vec<f64>; 3],
        seed: u64,
        fine: bool,
    ) -> Factors<'b> {
        let shaped = self.shaped;
        Factors { fine, shaped, ..Factors::new(&self.clusters, self.visibility, brightness, seed) }
    }

    /// All links. `progress` is told of how many patches more they are there, from any thread.
    pub fn assemble(
        &self,
        light: &Light,
        part: f64,
        seed: u64,
        progress: impl Fn(usize) + Sync,
    ) -> Hierarchical {
        let work = Work { light, part, seed };
        self.gathered(self.built(&work, self.unbuilt(), (progress, || false)))
    }

    /// The light, brightness and all that arrives, by coarser links, found for light that is the same everywhere. `lit` is what arrives from
    /// what is no patch.
    ///
    /// Of every patch, though few would say how bright a cluster is: what stands on a floor hides its dark places, and links that think it as
    /// bright there as anywhere lose light, 2 to 6 % of it on the sides of a hall with boxes.
    pub(crate) fn sketched(
        &self,
        source: &[V],
        lit: &[V],
        part: f64,
        seed: u64,
    ) -> Result<Light, SystemError> {
        let ambient = Light::ambient(self.patches, source);
        let sketch = self.assemble(&ambient, COARSER * part, seed, |_| ());
        let system = System::new(source, &self.patches.reflectance, &sketch)?;
        let mut relaxation = Gmres::new(system);
        let stop = Stop { residual: SKETCH.0 * max_norm(source), sweeps: SKETCH.1 };
        relax(&mut relaxation, stop, |_, _, _| true);
        let u = relaxation.solution();
        let mut irradiance = vec![V::splat(0.0); u.len()];
        sketch.apply(&u, &mut irradiance);
        irradiance.iter_mut().zip(lit).for_each(|(h, lit)| *h += *lit);
        Ok(Light::of(self.patches, &u, &irradiance))
    }

    /// The links that are still missing, unless `stops`, asked from any thread, says that there is no time: then what there is.
    pub fn go_on(
        &self,
        kept: Kept,
        part: f64,
        seed: u64,
        hooks: (impl Fn(usize) + Sync, impl Fn() -> bool + Sync),
    ) -> Result<Hierarchical, Kept> {
        let Kept { digest, light, regions } = kept;
        regions.iter().flat_map(Blocks::iter).for_each(|block| hooks.0(block.patches()));
        let built = self.built(&Work { light: &light, part, seed }, regions, hooks);
        if self.receivers.len() > built.iter().map(Blocks::len).sum() {
            return Err(Kept { digest, light, regions: built });
        }
        Ok(self.gathered(built))
    }

    /// No links yet, of any region.
    pub(super) fn unbuilt(&self) -> Vec<Blocks> {
        vec![Blocks::default(); self.regions.len()]
    }

    /// The links of each region, of which some may be there; fewer than all where `stops` said so.
    fn built(
        &self,
        work: &Work<'_>,
        known: Vec<Blocks>,
        (progress, stops): (impl Fn(usize) + Sync, impl Fn() -> bool + Sync),
    ) -> Vec<Blocks> {
        let means = self.means(work.light);
        let (cuts, factors) =
            (self.cuts(&means, work.part, Some(work.seed)), self.factors(&means, work.seed, false));
        let tree = &self.clusters.tree;
        let build = |(region, mut blocks): (&Region, Blocks)| {
            let (mut hidden, mut found) = (Hidden::from(region.cluster), Vec::new());
            for receiver in self.receivers[region.receivers.clone()].iter().skip(blocks.len()) {
                if stops() {
                    return blocks;
                }
                cuts.of(*receiver, &mut hidden, &mut found);
                self.block(*receiver, (&cuts, &factors), work, &found, &mut blocks);
                progress(tree.range(*receiver).len());
            }
            blocks.shrink();
            blocks
        };
        self.regions.par_iter().zip(known).map(build).collect()
    }

    /// Adds the links of a receiver.
    fn block(
        &self,
        receiver: Cluster,
        (cuts, factors): (&Cuts<'_>, &Factors<'_>),
        work: &Work<'_>,
        found: &[Found],
        blocks: &mut Blocks,
    ) {
        let range = self.clusters.tree.range(receiver);
        let receivers = factors.receivers(&self.clusters.polygons[range.clone()], range.start);
        let worth = work.part * cuts.arriving[receiver.index()];
        let (mut rays, mut column) = (0, Column::default());
        for (number, &Found { cluster: sender, weight, clear }) in (0_u64..).zip(found) {
            let worth = worth / cuts.brightness[sender.index()];
            factors.column(&receivers, &Link { sender, weight, number, clear, worth }, &mut column);
            rays += column.cast;
            blocks.add(sender, &column.factors);
        }
        blocks.close(receiver, range.len(), rays);
    }

    /// The receivers of a region.
    pub(super) fn receivers(&self, region: usize) -> &[Cluster] {
        &self.receivers[self.regions[region].receivers.clone()]
    }

    fn gathered(&self, regions: Vec<Blocks>) -> Hierarchical {
        let tree = &self.clusters.tree;
        let mut order_of = vec![0; tree.order().len()];
        tree.order().iter().zip(0..).for_each(|(patch, place)| order_of[*patch] = place);
        let sum = |of: fn(&Blocks) -> u64| regions.iter().map(of).sum::<u64>();
        let statistics = Statistics {
            patches: self.patches.len(),
            clusters: tree.len(),
            receivers: self.receivers.len(),
            links: sum(Blocks::links),
            rays: sum(Blocks::rays),
            link_bytes: sum(Blocks::bytes),
            bytes: sum(Blocks::bytes) + clusters_bytes(self.patches.len()),
        };
        Hierarchical::new(Arc::clone(&self.clusters), regions, order_of, statistics)
    }
}
