//! F_{ia,jb} = coefficient ia of P_n(K φ_jb), P_n the interpolation at the nodes or the orthogonal projection (paper, §3.3).
//!
//! A row sum is that of K 1 = 1 in a closed scene, whatever the degree, since the φ_b add up to 1.

use super::adaptive::Block;
use super::degree::MOST;
use super::exchange::Exchange;
use super::hidden::Hidden;
use super::moments::{Front, Moments};
use super::space::Space;
use crate::form_factor::exchange::may_see;
use crate::form_factor::sampled::{Sight, sight};
use crate::kernel::SurfacePoint;
use crate::patches::{Patches, Strip};
use crate::visibility::{RayCount, Visibility};
use fredholm::discretize::Coupling;
use fredholm::value::Value;
use glam::DVec3;

/// The couplings of the elements of a space.
#[derive(Debug)]
pub struct Elements<'a> {
    space: &'a Space<'a>,
    strips: &'a [Strip],
    visibility: &'a Visibility,
    accuracy: f64,
    test: Test<'a>,
    rays: RayCount,
}

/// What the light that arrives at an element is tested with.
#[derive(Debug)]
enum Test<'a> {
    /// Its nodes: collocation.
    Nodes(Moments<'a>),
    /// Its basis functions: Galerkin.
    Functions(Exchange<'a>),
}

impl<'a> Elements<'a> {
    /// F_{ia,jb} = ∫_{P_j} K(x_ia, y) φ_jb(y) dy at the nodes x_ia: collocation.
    ///
    /// `space` is one on the polygons of `patches`. `accuracy` is the standard error that a row sum may have from partly hidden
    /// patches; moments that nothing hides are integrated ten times as finely, relative to their sum, and add up to
    /// Lambert's factor exactly.
    pub fn collocation<V: Value>(
        space: &'a Space<'a>,
        patches: &'a Patches<V>,
        visibility: &'a Visibility,
        accuracy: f64,
    ) -> Self {
        let test = Test::Nodes(Moments::new(space, 0.1 * accuracy));
        Self::new(space, &patches.strips, visibility, accuracy, test)
    }

    /// F_{ia,jb} = 1/m_ia ∫ φ_ia ∫ K φ_jb: Galerkin. m_ia F_{ia,jb} = m_jb F_{jb,ia} to the last digit, for the weights
    /// m of the space.
    ///
    /// `accuracy` is the standard error that a row sum may have from partly hidden patches; each unoccluded block is
    /// integrated ten times as finely, relative to its sum.
    pub fn galerkin<V: Value>(
        space: &'a Space<'a>,
        patches: &'a Patches<V>,
        visibility: &'a Visibility,
        accuracy: f64,
    ) -> Self {
        let test = Test::Functions(Exchange::new(space, 0.1 * accuracy));
        Self::new(space, &patches.strips, visibility, accuracy, test)
    }

    fn new(
        space: &'a Space<'a>,
        strips: &'a [Strip],
        visibility: &'a Visibility,
        accuracy: f64,
        test: Test<'a>,
    ) -> Self {
        Self { space, strips, visibility, accuracy, test, rays: RayCount::default() }
    }

    /// How many rays have been cast.
    pub fn rays(&self) -> u64 {
        self.rays.total()
    }

    /// (K u)(x) = Σ_jb M_jb(x) u_jb at a point x of element i: the irradiance there.
    ///
    /// With it, f(x) + ρ(x) (K u_n)(x) of a solution u_n is the iterated one (I. Sloan 1976), which satisfies the equation
    /// with one more application of K, not projected. For collocation it passes through the coefficients.
    pub fn irradiance<V: Value>(&self, u: &[V], i: usize, x: DVec3) -> V {
        let x = SurfacePoint { position: x, normal: self.space.polygons()[i].normal() };
        let mut sum = V::splat(0.0);
        self.for_each_sight(i, 0..self.space.polygons().len(), |j, sight| {
            let moments = self.at_point(&x, i, j, sight, 0);
            let terms = u[self.space.range(j)].iter().zip(moments);
            sum += terms.fold(V::splat(0.0), |sum, (u, moment)| sum + *u * moment);
        });
        sum
    }

    fn moments(&self) -> &Moments<'a> {
        match &self.test {
            Test::Nodes(moments) => moments,
            Test::Functions(exchange) => exchange.moments(),
        }
    }

    /// The elements of a range that element i may see, with what is certain of their sight.
    fn for_each_sight(&self, i: usize, among: std::ops::Range<usize>, mut visit: impl FnMut(usize, Sight)) {
        let first = self.strips.partition_point(|strip| strip.patches.end <= among.start);
        for strip in self.strips[first..].iter().take_while(|strip| strip.patches.start < among.end) {
            let seen = self.sight_of(i, strip);
            if seen != Sight::Hidden {
                let range = strip.patches.start.max(among.start)..strip.patches.end.min(among.end);
                range.filter(|&j| j != i).for_each(|j| visit(j, seen));
            }
        }
    }

    /// What element i sees of a whole strip. A strip of one patch is left to the pair, which asks the same.
    fn sight_of(&self, i: usize, strip: &Strip) -> Sight {
        let (patch, whole) = (&self.space.polygons()[i], &strip.polygon);
        match () {
            () if strip.patches.len() == 1 => Sight::Unknown,
            () if !may_see(patch, whole) => Sight::Hidden,
            () => sight(self.visibility, patch, whole, &self.rays),
        }
    }

    /// What is certain of the sight of a pair, where that of a strip was not.
    fn certain(&self, i: usize, j: usize, seen: Sight) -> Sight {
        let polygons = self.space.polygons();
        match seen {
            Sight::Unknown if !self.visibility.hides_anything() => Sight::Clear,
            Sight::Unknown => sight(self.visibility, &polygons[i], &polygons[j], &self.rays),
            known => known,
        }
    }

    /// F_{ia,jb} for all nodes or functions a of element i and b of element j.
    fn block(&self, i: usize, j: usize, seen: Sight) -> Block {
        let mut block = [[0.0; MOST]; MOST];
        match &self.test {
            Test::Nodes(_) => {
                for (a, node) in self.space.nodes(i).enumerate() {
                    block[a] = self.at_point(&node, i, j, seen, a);
                }
            }
            Test::Functions(exchange) => {
                block = self.between(exchange, i, j, seen);
                for (row, m) in block.iter_mut().zip(&self.space.weights()[self.space.range(i)]) {
                    row.iter_mut().for_each(|entry| *entry /= m);
                }
            }
        }
        block
    }

    /// ∫ V K φ_jb from a point of element i, the `sample`-th that is asked about.
    fn at_point(&self, x: &SurfacePoint, i: usize, j: usize, seen: Sight, sample: usize) -> [f64; MOST] {
        let polygons = self.space.polygons();
        let whole = self.moments().at(x, j, &Front::of(&polygons[j], &polygons[i]));
        if whole.iter().all(|moment| *moment == 0.0) {
            return whole;
        }
        match self.certain(i, j, seen) {
            Sight::Clear => whole,
            Sight::Hidden => [0.0; MOST],
            Sight::Unknown => self.hidden().at_point(x, (i, j), sample, whole),
        }
    }

    /// ∫ φ_ia ∫ V K φ_jb, the same for (i, j) and, transposed, (j, i).
    fn between(&self, exchange: &Exchange<'_>, i: usize, j: usize, seen: Sight) -> Block {
        if i > j {
            return super::adaptive::transposed(&self.between(exchange, j, i, seen));
        }
        let whole = exchange.between(i, j);
        if whole.iter().flatten().all(|entry| *entry == 0.0) {
            return whole;
        }
        match self.certain(i, j, seen) {
            Sight::Clear => whole,
            Sight::Hidden => [[0.0; MOST]; MOST],
            Sight::Unknown => self.hidden().between((i, j), whole),
        }
    }

    fn hidden(&self) -> Hidden<'_> {
        Hidden { space: self.space, visibility: self.visibility, rays: &self.rays, accuracy: self.accuracy }
    }

    /// Rows `first` … of one element, the columns from `from` on, `width` of them a row.
    fn fill(&self, first: usize, from: usize, width: usize, rows: &mut [f64]) {
        rows.fill(0.0);
        if width == 0 {
            return;
        }
        let (i, to) = (self.space.element_of(first), from + width);
        let skipped = first - self.space.range(i).start;
        let among = self.space.element_of(from)..self.space.element_of(to - 1) + 1;
        self.for_each_sight(i, among, |j, seen| {
            let block = self.block(i, j, seen);
            let columns = self.space.range(j);
            for (row, entries) in rows.chunks_mut(width).zip(&block[skipped..]) {
                for (column, entry) in columns.clone().zip(entries) {
                    if (from..to).contains(&column) {
                        row[column - from] = *entry;
                    }
                }
            }
        });
    }
}

impl Coupling for Elements<'_> {
    fn dim(&self) -> usize {
        self.space.dim()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let (row, column) = (self.space.element_of(i), self.space.element_of(j));
        // A planar element does not see itself.
        if row == column {
            return 0.0;
        }
        let block = self.block(row, column, Sight::Unknown);
        block[i - self.space.range(row).start][j - self.space.range(column).start]
    }

    /// What an element sees of a strip of others is asked once. The entries are those of [`Self::entry`].
    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        self.fill(i, from, row.len(), row);
    }

    fn band(&self, i: usize) -> usize {
        self.space.range(self.space.element_of(i)).end - i
    }

    fn rows(&self, first: usize, from: usize, rows: &mut [f64]) {
        self.fill(first, from, self.dim() - from, rows);
    }

    fn reciprocity(&self) -> Option<&[f64]> {
        matches!(self.test, Test::Functions(_)).then_some(self.space.weights())
    }
}
