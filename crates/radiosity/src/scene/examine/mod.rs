//! What may be wrong with a mesh although each of its faces is well: faces twice or through one another, turned round, or
//! missing.
//!
//! All tolerances are relative to the size of the scene, so that it is judged alike in millimetres and in kilometres;
//! nothing is moved or mended. n log n for meshes as they are drawn.

mod boxes;
mod crossing;
mod edges;
mod weld;

use super::face::Face;
use super::{Scene, cut, error::Problem};
use crate::polygon::Polygon;
use glam::DVec3;
use std::collections::HashMap;
use std::fmt;
use weld::Welded;

/// What counts as one place, as a fraction of the scene's size. Exporters write six digits, or the seven of an `f32`, so
/// that less would find cracks in sound meshes; more would lose details of a millimetre in a kilometre.
const NOTHING: f64 = 1e-6;

/// What was found in a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What should be known, each kind once; each is a sentence in [`Display`](fmt::Display).
    pub findings: Vec<Finding>,
    /// The parts that hang together, in the order of their first faces.
    pub components: Vec<Component>,
}

/// One kind of defect.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What it is.
    pub kind: Defect,
    /// How many there are: faces, pairs of faces, or edges.
    pub count: usize,
    /// Whether counting ended here.
    pub is_lower_bound: bool,
    /// The faces of the first, by their numbers: one, or the two of a pair.
    pub faces: Vec<usize>,
    /// Their names, and where they stand.
    pub example: String,
}

/// What a [`Finding`] is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Faces with a polygon of no area.
    WithoutArea,
    /// Faces with a polygon whose outline crosses itself.
    CrossesItself,
    /// Pairs of faces with the same corners that face the same way.
    Duplicate,
    /// Pairs of faces with the same corners, back to back or face to face.
    Opposite,
    /// Pairs of faces that face the same way and lie partly in one place.
    Overlapping,
    /// Pairs of faces of which each goes through the other.
    Crossing,
    /// Edges whose two faces disagree on what is the front.
    Flipped,
    /// Edges with nothing beyond.
    Open,
}

/// Faces that hang together by their edges; obstructions are not among them.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// How many faces it has.
    pub faces: usize,
    /// The first of them, by its number.
    pub first: usize,
    /// Edges, or parts of them, with nothing beyond; those that rest on another face apart.
    pub open_edges: usize,
    /// Edges that stand on another face, as those of a block without a bottom.
    pub resting_edges: usize,
    /// Edges whose two faces disagree on what is the front.
    pub flipped_edges: usize,
    /// What it encloses, in m³, when every edge has its other side: negative for a room, whose faces look inwards.
    pub volume: Option<f64>,
}

impl Component {
    /// Whether nothing is missing and nothing is turned round.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0 && self.flipped_edges == 0
    }
}

impl Report {
    /// Whether every component is closed; then each row of view factors of a room should sum to 1.
    pub fn is_closed(&self) -> bool {
        self.components.iter().all(Component::is_closed)
    }

    /// Whether all is a solid seen from outside: no face of a convex one sees anything, and most likely all are turned
    /// round.
    pub fn faces_outwards(&self) -> bool {
        let volumes: Option<Vec<f64>> = self.components.iter().map(|component| component.volume).collect();
        volumes.is_some_and(|volumes| !volumes.is_empty() && volumes.iter().all(|&volume| volume > 0.0))
    }

    /// The finding of a kind.
    pub fn finding(&self, kind: Defect) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.kind == kind)
    }
}

/// Looks at the mesh of a scene; `faces` are those of [`Loaded`](super::Loaded) or [`Face::of_polygons`].
///
/// A file read by [`load`](fn@super::load) has no face with a coordinate that is not finite, whose outline crosses
/// itself, or without area: the readers refuse these, or leave them out with a [`Warning`](super::Warning).
pub fn examine<V>(scene: &Scene<V>, faces: &[Face]) -> Report {
    let mesh = Mesh::new(scene.polygons(), faces);
    let mut findings = Findings { faces, list: Vec::new() };
    for (face, kind) in mesh.misshapen() {
        findings.add(kind, &[face]);
    }
    for (pair, kind) in mesh.duplicates() {
        findings.add(kind, &pair);
    }
    crossing::find(&mesh, &mut findings);
    let components = edges::find(&mesh, &mut findings);
    Report { findings: findings.list, components }
}

/// The polygons of a scene with their faces and their corners.
struct Mesh<'a> {
    faces: &'a [Face],
    polygons: Vec<Polygon>,
    /// The face of each polygon.
    face_of: Vec<usize>,
    welded: Welded,
    /// The distance, in metres, that counts as none.
    tolerance: f64,
    /// For each face the first with the same corners.
    twin: Vec<usize>,
}

impl<'a> Mesh<'a> {
    fn new(polygons: Vec<Polygon>, faces: &'a [Face]) -> Self {
        let mut face_of = vec![0; polygons.len()];
        for (index, face) in faces.iter().enumerate() {
            face_of[face.polygons.clone()].fill(index);
        }
        let corners = || polygons.iter().flat_map(Polygon::vertices);
        let low = corners().fold(DVec3::INFINITY, |low, &corner| low.min(corner));
        let high = corners().fold(DVec3::NEG_INFINITY, |high, &corner| high.max(corner));
        let tolerance = if polygons.is_empty() { 0.0 } else { NOTHING * low.distance(high) };
        let welded = Welded::new(&polygons, tolerance);
        let twin = twins(faces, &welded);
        Self { faces, polygons, face_of, welded, tolerance, twin }
    }

    fn normal(&self, face: usize) -> DVec3 {
        self.polygons[self.faces[face].polygons.clone()].iter().map(|p| p.area() * p.normal()).sum()
    }

    fn misshapen(&self) -> impl Iterator<Item = (usize, Defect)> {
        self.polygons.iter().zip(&self.face_of).filter_map(|(polygon, &face)| {
            let crosses = || matches!(cut(polygon.vertices()), Err(Problem::SelfIntersecting { .. }));
            if !(polygon.area() > 0.0 && polygon.area().is_finite()) {
                Some((face, Defect::WithoutArea))
            } else {
                (polygon.vertices().len() == 4 && crosses()).then_some((face, Defect::CrossesItself))
            }
        })
    }

    fn duplicates(&self) -> impl Iterator<Item = ([usize; 2], Defect)> {
        let pairs = self.twin.iter().enumerate().filter(|&(face, &twin)| twin != face);
        pairs.map(|(face, &twin)| {
            let agree = self.normal(face).dot(self.normal(twin)) > 0.0;
            ([twin, face], if agree { Defect::Duplicate } else { Defect::Opposite })
        })
    }
}

/// For each face the first with the same corners.
fn twins(faces: &[Face], welded: &Welded) -> Vec<usize> {
    let mut first = HashMap::new();
    let corners = |face: &Face| {
        let mut corners: Vec<u32> =
            welded.polygons[face.polygons.clone()].iter().flatten().copied().collect();
        corners.sort_unstable();
        corners.dedup();
        corners
    };
    faces.iter().enumerate().map(|(index, face)| *first.entry(corners(face)).or_insert(index)).collect()
}

/// Findings as they come, by kind.
struct Findings<'a> {
    faces: &'a [Face],
    list: Vec<Finding>,
}

impl Findings<'_> {
    /// Counts one more of a kind, and keeps the faces of the first.
    fn add(&mut self, kind: Defect, faces: &[usize]) {
        if let Some(finding) = self.list.iter_mut().find(|finding| finding.kind == kind) {
            finding.count += 1;
            return;
        }
        let labels: Vec<_> = faces.iter().map(|&face| self.faces[face].label()).collect();
        let (faces, example) = (faces.to_vec(), labels.join(" and "));
        self.list.push(Finding { kind, count: 1, is_lower_bound: false, faces, example });
    }

    fn end_counting(&mut self, kind: Defect) {
        if let Some(finding) = self.list.iter_mut().find(|finding| finding.kind == kind) {
            finding.is_lower_bound = true;
        }
    }
}

impl Defect {
    /// One of them, several of them, and what it means.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::WithoutArea => ["face has no area", "faces have no area", "remove them"],
            Self::CrossesItself => ["face crosses itself", "faces cross themselves", "reorder the corners"],
            Self::Duplicate => [
                "face is there twice",
                "faces are there twice",
                "they hide each other or not, as it happens; remove one",
            ],
            Self::Opposite => [
                "pair of faces has the same corners and opposite fronts",
                "pairs of faces have the same corners and opposite fronts",
                "a thin plate has such, and so have solids that touch",
            ],
            Self::Overlapping => [
                "pair of faces lies partly in one place",
                "pairs of faces lie partly in one place",
                "they hide each other or not, as it happens; cut one out of the other",
            ],
            Self::Crossing => [
                "pair of faces goes through each other",
                "pairs of faces go through each other",
                "what is behind is hidden, but whole patches are cut by it; cut them where they meet",
            ],
            Self::Flipped => [
                "edge joins faces with opposite fronts",
                "edges join faces with opposite fronts",
                "only the front exchanges radiation; reverse the corners of one",
            ],
            Self::Open => [
                "edge is open",
                "edges are open",
                "radiation is lost there; a closed mesh has a face on either side of each edge",
            ],
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, several, meaning] = self.kind.words();
        let bound = if self.is_lower_bound { "at least " } else { "" };
        let what = if self.count == 1 { one } else { several };
        let (count, example) = (self.count, &self.example);
        let first = if count == 1 { "" } else { "the first " };
        write!(f, "{bound}{count} {what}, {first}at {example}: {meaning}")
    }
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} face{}, ", self.faces, if self.faces == 1 { "" } else { "s" })?;
        match (self.is_closed(), self.volume) {
            (false, _) => write!(f, "{} edges open, {} turned round", self.open_edges, self.flipped_edges),
            (true, Some(volume)) if volume > 0.0 => write!(f, "closed, a solid of {volume:.3e} m³"),
            (true, Some(volume)) => write!(f, "closed, a room of {:.3e} m³", -volume),
            (true, None) => write!(f, "closed by the faces that it stands on"),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for finding in &self.findings {
            writeln!(f, "{finding}")?;
        }
        for (component, number) in self.components.iter().zip(1..) {
            writeln!(f, "component {number}: {component}")?;
        }
        Ok(())
    }
}
