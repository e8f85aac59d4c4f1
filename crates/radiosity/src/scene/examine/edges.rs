//! How faces hang together: each edge of a closed mesh is walked once in either direction.

use super::boxes::{Bounds, Boxes};
use super::weld::Welded;
use super::{Component, Defect, Findings, Mesh};
use crate::polygon::Polygon;
use glam::DVec3;
use std::ops::ControlFlow;

/// An edge as a polygon walks it.
#[derive(Clone, Copy, Debug)]
struct Half {
    from: u32,
    to: u32,
    polygon: usize,
}

impl Half {
    fn key(&self) -> (u32, u32) {
        (self.from.min(self.to), self.from.max(self.to))
    }

    fn is_forward(&self) -> bool {
        self.from < self.to
    }
}

/// The components of the faces that radiate; open and flipped edges are added to the findings.
pub(super) fn find(mesh: &Mesh<'_>, findings: &mut Findings<'_>) -> Vec<Component> {
    let halves = whole_edges(mesh);
    let mut parts = Parts::new(mesh.faces.len());
    for group in halves.chunk_by(|a, b| a.key() == b.key()) {
        parts.join(mesh, group);
    }
    let resting = Resting::new(mesh);
    let mut defects = Vec::new();
    for group in halves.chunk_by(|a, b| a.key() == b.key()) {
        defects.extend(defects_of(group, &resting, mesh));
    }
    let mut components = parts.components(mesh);
    for &OddEdge { face, other, kind } in &defects {
        let Some(component) = components.get_mut(parts.number(face)) else { continue };
        match kind {
            None => component.resting_edges += 1,
            Some(Defect::Flipped) => {
                component.flipped_edges += 1;
                findings.add(Defect::Flipped, &[face, other]);
            }
            Some(_) => {
                component.open_edges += 1;
                findings.add(Defect::Open, &[face]);
            }
        }
    }
    for component in &mut components {
        if !component.is_closed() || component.resting_edges > 0 {
            component.volume = None;
        }
    }
    components
}

/// The edges of all polygons, those that other corners lie on cut there, sorted so that equal ones are neighbours.
fn whole_edges(mesh: &Mesh<'_>) -> Vec<Half> {
    let mut halves = Vec::new();
    for (polygon, corners) in mesh.welded.polygons.iter().enumerate() {
        if mesh.faces[mesh.face_of[polygon]].is_obstruction {
            continue;
        }
        let ends = (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
        // An edge shorter than the tolerance is a point.
        halves.extend(ends.filter(|(from, to)| from != to).map(|(from, to)| Half { from, to, polygon }));
    }
    sort(&mut halves);
    let groups = halves.chunk_by(|a, b| a.key() == b.key());
    let (even, odd): (Vec<_>, Vec<_>) = groups.partition(|group| balance(group) == 0);
    let odd = odd.concat();
    let mut all = even.concat();
    all.extend(split(&odd, &mesh.welded, mesh.tolerance));
    sort(&mut all);
    all
}

/// In order of the polygons among equal edges, for the first to be told first.
fn sort(halves: &mut [Half]) {
    halves.sort_unstable_by_key(|half| (half.key(), half.polygon));
}

/// How often more an edge is walked forward than backward.
fn balance(group: &[Half]) -> isize {
    group.iter().map(|half| if half.is_forward() { 1 } else { -1 }).sum()
}

/// The edges, cut where ends of others lie on them: walls are drawn from corner to corner, whatever stands at them.
fn split(halves: &[Half], welded: &Welded, tolerance: f64) -> Vec<Half> {
    let at = |vertex: u32| welded.vertices[vertex as usize];
    let bounds = halves.iter().map(|half| Bounds::of(&[at(half.from), at(half.to)], tolerance)).collect();
    let boxes = Boxes::new(bounds);
    let mut between: Vec<Vec<(f64, u32)>> = vec![Vec::new(); halves.len()];
    let mut ends: Vec<u32> = halves.iter().flat_map(|half| [half.from, half.to]).collect();
    ends.sort_unstable();
    ends.dedup();
    for vertex in ends {
        let point = at(vertex);
        let _ = boxes.meeting(&Bounds::of(&[point], 0.0), |k| {
            let (from, to) = (at(halves[k].from), at(halves[k].to));
            let t = (point - from).dot(to - from) / (to - from).length_squared();
            let is_end = vertex == halves[k].from || vertex == halves[k].to;
            if !is_end && t > 0.0 && t < 1.0 && from.lerp(to, t).distance(point) <= tolerance {
                between[k].push((t, vertex));
            }
            ControlFlow::Continue(())
        });
    }
    halves.iter().zip(between).flat_map(|(half, stops)| cut_at(*half, stops)).collect()
}

fn cut_at(half: Half, mut stops: Vec<(f64, u32)>) -> impl Iterator<Item = Half> {
    stops.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let ends = stops.into_iter().map(|(_, vertex)| vertex).chain([half.to]);
    let mut from = half.from;
    ends.map(move |to| {
        let part = Half { from, to, ..half };
        from = to;
        part
    })
}

/// An edge that is not as in a closed mesh; of no kind when it rests on a face.
struct OddEdge {
    face: usize,
    other: usize,
    kind: Option<Defect>,
}

fn defects_of(group: &[Half], resting: &Resting<'_>, mesh: &Mesh<'_>) -> Option<OddEdge> {
    let balance = balance(group);
    if balance == 0 {
        return None;
    }
    let surplus = group.iter().filter(|half| half.is_forward() == (balance > 0));
    let faces: Vec<usize> = surplus.clone().map(|half| mesh.face_of[half.polygon]).collect();
    let face = faces[0];
    if group.len().is_multiple_of(2) {
        return Some(OddEdge {
            face,
            other: faces.get(1).copied().unwrap_or(face),
            kind: Some(Defect::Flipped),
        });
    }
    let rests = surplus.clone().all(|half| resting.rests(half));
    Some(OddEdge { face, other: face, kind: (!rests).then_some(Defect::Open) })
}

/// Which edges stand on faces.
struct Resting<'a> {
    mesh: &'a Mesh<'a>,
    boxes: Boxes,
}

impl<'a> Resting<'a> {
    fn new(mesh: &'a Mesh<'a>) -> Self {
        let bounds = |polygon: &Polygon| Bounds::of(polygon.vertices(), mesh.tolerance);
        Self { mesh, boxes: Boxes::new(mesh.polygons.iter().map(bounds).collect()) }
    }

    /// Whether its ends, its middle and its quarters all lie on other faces.
    fn rests(&self, half: &Half) -> bool {
        let [from, to] = [half.from, half.to].map(|vertex| self.mesh.welded.vertices[vertex as usize]);
        [0.5, 0.0, 1.0, 0.25, 0.75].into_iter().all(|t| self.is_on_another(from.lerp(to, t), half.polygon))
    }

    fn is_on_another(&self, point: DVec3, own: usize) -> bool {
        let Mesh { face_of, polygons, tolerance, .. } = self.mesh;
        let visit = |k: usize| {
            let on = face_of[k] != face_of[own] && contains(&polygons[k], point, *tolerance);
            if on { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        self.boxes.meeting(&Bounds::of(&[point], 0.0), visit).is_break()
    }
}

fn contains(polygon: &Polygon, point: DVec3, tolerance: f64) -> bool {
    let corners = polygon.vertices();
    let is_inside = |k: usize| {
        let along = corners[(k + 1) % corners.len()] - corners[k];
        let inward = polygon.normal().cross(along).normalize_or_zero();
        inward.dot(point - corners[k]) >= -tolerance
    };
    polygon.height_of(point).abs() <= tolerance && (0..corners.len()).all(is_inside)
}

/// Sets of faces that hang together.
struct Parts {
    parent: Vec<usize>,
    /// The component's number, by the face that stands for the set.
    numbers: Vec<usize>,
}

impl Parts {
    fn new(faces: usize) -> Self {
        Self { parent: (0..faces).collect(), numbers: vec![usize::MAX; faces] }
    }

    fn root(&self, mut face: usize) -> usize {
        while self.parent[face] != face {
            face = self.parent[face];
        }
        face
    }

    /// Joins the faces at an edge: the lower number stands for both, and the way there is halved.
    fn join(&mut self, mesh: &Mesh<'_>, group: &[Half]) {
        for pair in group.windows(2) {
            let [a, b] =
                [pair[0].polygon, pair[1].polygon].map(|polygon| self.shortened(mesh.face_of[polygon]));
            self.parent[a.max(b)] = a.min(b);
        }
    }

    fn shortened(&mut self, mut face: usize) -> usize {
        while self.parent[face] != face {
            self.parent[face] = self.parent[self.parent[face]];
            face = self.parent[face];
        }
        face
    }

    fn number(&self, face: usize) -> usize {
        self.numbers[self.root(face)]
    }

    /// The components, with what they would enclose if they were closed.
    fn components(&mut self, mesh: &Mesh<'_>) -> Vec<Component> {
        let mut components: Vec<Component> = Vec::new();
        for (index, face) in mesh.faces.iter().enumerate().filter(|(_, face)| !face.is_obstruction) {
            let root = self.shortened(index);
            if self.numbers[root] == usize::MAX {
                self.numbers[root] = components.len();
                let (open_edges, resting_edges, flipped_edges, faces) = Default::default();
                let volume = Some(0.0);
                components.push(Component {
                    faces,
                    first: index,
                    open_edges,
                    resting_edges,
                    flipped_edges,
                    volume,
                });
            }
            let component = &mut components[self.numbers[root]];
            component.faces += 1;
            // From a point of its own, lest a room far from the origin lose its digits.
            let origin = mesh.polygons[mesh.faces[component.first].polygons.start].centroid();
            let polygons = &mesh.polygons[face.polygons.clone()];
            let cones = polygons.iter().map(|p| p.area() * p.normal().dot(p.centroid() - origin) / 3.0);
            component.volume = component.volume.map(|volume| volume + cones.sum::<f64>());
        }
        components
    }
}
