//! Surfaces whose view factors are known exactly: the enclosures of textbooks.

use super::error::ThermalError;
use super::{Answer, Bands, Exchange, Node, Options, Surface};
use fredholm::discretize::Coupling;
use fredholm::operator::{Dense, Rows};
use fredholm::system::row_sums;

/// Surfaces, each a node, and their view factors.
#[derive(Clone, Debug)]
pub struct Enclosure {
    surfaces: Vec<Surface>,
    nodes: Vec<Node>,
    view_factors: Dense<f64>,
    bands: Bands,
    surroundings: f64,
}

/// What a row may miss of 1, or have too much, and be an enclosure's: the seventh digit of what people type.
const CLOSED: f64 = 1e-6;

/// How far A_i F_ij may be from A_j F_ji, relative to the larger area: view factors are at times read off a chart.
const RECIPROCAL: f64 = 1e-2;

impl Enclosure {
    /// From areas in m² and view factors: `F[i][j]` is the share of what leaves i that reaches j, and by reciprocity the
    /// share of what i sees that is j. What a row misses of 1 are the surroundings, black and at 0 K unless
    /// [`Self::in_surroundings`] says otherwise.
    ///
    /// # Errors
    ///
    /// When sizes differ, an area is not positive, a factor lies outside [0, 1], a row adds up to more than 1, or
    /// A_i F_ij is not A_j F_ji.
    pub fn new(
        surfaces: Vec<Surface>,
        areas: &[f64],
        view_factors: &[Vec<f64>],
        bands: Bands,
    ) -> Result<Self, ThermalError> {
        let n = surfaces.len();
        let given = |row: usize| view_factors.get(row).map_or(0, Vec::len);
        if let Some(row) = (0..n.max(view_factors.len())).find(|&row| row >= n || given(row) != n) {
            return Err(ThermalError::Shape { surfaces: n, row: row + 1, given: given(row) });
        }
        check_areas(&surfaces, areas)?;
        let entries = Entries(view_factors);
        entries.check(&surfaces, areas)?;
        let view_factors = Dense::assemble(&entries, |_| ())?;
        let node = |(surface, area): (usize, &f64)| Node { surface, area: *area };
        let nodes = areas.iter().enumerate().map(node).collect();
        Ok(Self { surfaces, nodes, view_factors, bands, surroundings: 0.0 })
    }

    /// Surfaces that face each other in pairs, each inside the next and convex: plates where the two areas are equal,
    /// else coaxial cylinders or concentric spheres. The second and the third are the two sides of the first shield,
    /// and so on.
    ///
    /// # Errors
    ///
    /// When their number is odd, or the first of a pair is larger than the second.
    pub fn nested(surfaces: Vec<Surface>, areas: &[f64], bands: Bands) -> Result<Self, ThermalError> {
        let n = surfaces.len();
        if n % 2 == 1 || areas.len() != n {
            let what = format!(
                "{n} surfaces and {} areas do not face each other in pairs; a shield has two surfaces, one for each side",
                areas.len()
            );
            return Err(ThermalError::Pairs(what));
        }
        let mut view_factors = vec![vec![0.0; n]; n];
        for k in (0..n).step_by(2) {
            let share = areas[k] / areas[k + 1];
            if share > 1.0 {
                let (inner, outer) = (&surfaces[k].name, &surfaces[k + 1].name);
                return Err(ThermalError::Pairs(format!(
                    "`{inner}` is within `{outer}` and has the larger area; list surfaces from the inside out"
                )));
            }
            view_factors[k][k + 1] = 1.0;
            view_factors[k + 1][k] = share;
            view_factors[k + 1][k + 1] = 1.0 - share;
        }
        Self::new(surfaces, areas, &view_factors, bands)
    }

    /// The same in black surroundings of a temperature in K.
    #[must_use]
    pub fn in_surroundings(self, temperature: f64) -> Self {
        Self { surroundings: temperature, ..self }
    }

    /// Its surfaces.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// max |Σ_j F_ij − 1|.
    pub fn closure_defect(&self) -> f64 {
        let all: Vec<usize> = (0..self.nodes.len()).collect();
        row_sums(&self.view_factors, &all).iter().map(|sum| (sum - 1.0).abs()).fold(0.0, f64::max)
    }

    /// Whether nothing is seen beyond the surfaces: all rows add up to 1 within 10⁻⁶.
    pub fn is_closed(&self) -> bool {
        self.closure_defect() <= CLOSED
    }

    /// Who exchanges heat with whom.
    pub fn exchange(&self) -> Exchange<'_, impl Rows + use<>> {
        Exchange {
            surfaces: &self.surfaces,
            nodes: &self.nodes,
            bands: &self.bands,
            operator: &self.view_factors,
            surroundings: self.surroundings,
            closed: self.is_closed(),
        }
    }

    /// Solves for the temperatures and heats that are not given.
    ///
    /// # Errors
    ///
    /// As of [`Exchange::solve`].
    pub fn solve(&self, options: &Options) -> Result<Answer, ThermalError> {
        self.exchange().solve(options)
    }
}

fn check_areas(surfaces: &[Surface], areas: &[f64]) -> Result<(), ThermalError> {
    let named = surfaces.iter().zip(areas.iter().copied().chain(std::iter::repeat(0.0)));
    match named.into_iter().find(|(_, area)| !(*area > 0.0 && area.is_finite())) {
        Some((surface, value)) => Err(ThermalError::Area { surface: surface.name.clone(), value }),
        None => Ok(()),
    }
}

/// F as it is typed.
struct Entries<'a>(&'a [Vec<f64>]);

impl Coupling for Entries<'_> {
    fn dim(&self) -> usize {
        self.0.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self.0[i][j]
    }
}

impl Entries<'_> {
    fn check(&self, surfaces: &[Surface], areas: &[f64]) -> Result<(), ThermalError> {
        for (i, row) in self.0.iter().enumerate() {
            if let Some(j) = row.iter().position(|f| !(0.0..=1.0).contains(f)) {
                return Err(ThermalError::ViewFactor { row: i + 1, column: j + 1, value: row[j] });
            }
            let sum: f64 = row.iter().sum();
            if sum > 1.0 + CLOSED {
                return Err(ThermalError::RowSum { surface: surfaces[i].name.clone(), sum });
            }
            for (j, factor) in row.iter().enumerate() {
                let (there, back) = (areas[i] * factor, areas[j] * self.0[j][i]);
                let is_small = (there - back).abs() <= RECIPROCAL * there.max(back);
                if !is_small || (there > 0.0) != (back > 0.0) {
                    let (from, to) = (surfaces[i].name.clone(), surfaces[j].name.clone());
                    return Err(ThermalError::Reciprocity { from, to, there, back });
                }
            }
        }
        Ok(())
    }
}
