//! What hides, as few convex polygons: the faces of one plane that a mesh cuts a wall into cast one shadow.
//!
//! Faces that share an edge and a plane are put together where that makes a convex polygon. Faces that close a body are
//! known to: from without it, those that are seen from the front hide all that the body hides. A convex body hides what
//! is inside of its outline ([`Solid`]).

use super::facet::ON_PLANE;
use super::solid::{Plane, Ridge, Solid};
use crate::polygon::Polygon;
use glam::DVec3;
use std::collections::HashMap;

/// The faces of a scene as what hides.
#[derive(Clone, Debug)]
pub(crate) struct Blockers {
    /// Convex, planar, each of them faces or parts of them.
    pub polygons: Vec<Polygon>,
    /// The body that each polygon is of, where it is of one.
    pub body: Vec<Option<u32>>,
    /// The boxes around the bodies.
    pub bodies: Vec<[DVec3; 2]>,
    /// The polygons of each body.
    pub polygons_of: Vec<Vec<u32>>,
    /// Whether each body is convex, with its fronts outside: then what is seen of it from the front covers no place twice.
    pub is_convex: Vec<bool>,
    /// Each convex body that has not too many sides.
    pub solids: Vec<Option<Solid>>,
    /// The body of each face.
    pub body_of_face: Vec<Option<u32>>,
}

type Edge = (u32, u32);

impl Blockers {
    /// From the faces of a scene, for points of it.
    pub fn new(faces: &[Polygon]) -> Self {
        Self::of(faces, true)
    }

    /// From the faces of a scene, for what comes from beyond it and looks in where bodies are open.
    pub fn from_beyond(faces: &[Polygon]) -> Self {
        Self::of(faces, false)
    }

    fn of(faces: &[Polygon], nothing_looks_in: bool) -> Self {
        let mesh = Mesh::new(faces);
        let Closed { body_of_face, boxes: bodies, caps } = mesh.bodies(nothing_looks_in);
        let mut blockers = Self {
            polygons: Vec::new(),
            body: Vec::new(),
            polygons_of: vec![Vec::new(); bodies.len()],
            is_convex: Vec::new(),
            solids: Vec::new(),
            bodies,
            body_of_face,
        };
        let mut sides: Vec<Vec<_>> =
            caps.into_iter().map(|cap| cap.map(Some).into_iter().collect()).collect();
        for plane in mesh.planes() {
            let (body, normal) =
                (blockers.body_of_face[plane[0] as usize], faces[plane[0] as usize].normal());
            let outline = mesh.outline(&plane).map(|outline| mesh.without_straight_corners(&outline));
            let whole = outline.filter(|outline| mesh.is_convex(outline, normal));
            let parts = match &whole {
                Some(outline) => fan(outline),
                None => plane.iter().map(|&face| mesh.corners[face as usize].clone()).collect(),
            };
            if let Some(body) = body {
                let first = blockers.polygons.len();
                blockers.polygons_of[body as usize].extend((first..first + parts.len()).map(|k| k as u32));
                sides[body as usize].push(whole);
            }
            blockers.body.resize(blockers.body.len() + parts.len(), body);
            blockers.polygons.extend(parts.iter().map(|part| mesh.polygon(part)));
        }
        let solid =
            |sides: Vec<Option<Vec<u32>>>| mesh.solid(&sides.into_iter().collect::<Option<Vec<_>>>()?);
        let solids = sides.into_iter().map(solid);
        for solid in solids {
            blockers.is_convex.push(solid.is_some());
            blockers.solids.push(solid.filter(|solid| solid.planes.len() <= MOST_SIDES));
        }
        blockers
    }

    /// Whether no point of a face, by its number, is in a body: their boxes, or a side of the body, tell them apart. The face
    /// may have points under a body that stands on it.
    pub fn is_outside(&self, face: usize, polygon: &Polygon, body: u32) -> bool {
        self.tells_apart(face, polygon, body, |_, _| true)
    }

    /// Whether, besides, it has no points under the body, which see nothing but its inside.
    pub fn is_clear_of(&self, face: usize, polygon: &Polygon, body: u32) -> bool {
        let [least, most] = self.bodies[body as usize];
        let touch = ON_PLANE * (most - least).max_element();
        self.tells_apart(face, polygon, body, |side, highest| {
            highest > touch || polygon.normal().dot(side.normal) > 0.0
        })
    }

    /// Whether a face is of a body, or before a plane that the body is behind, for which `and` of its greatest height holds.
    fn tells_apart(
        &self,
        face: usize,
        polygon: &Polygon,
        body: u32,
        and: impl Fn(&Plane, f64) -> bool,
    ) -> bool {
        let [least, most] = self.bodies[body as usize];
        let apart = |side: &Plane| {
            let heights = polygon.vertices().iter().map(|v| side.height_of(*v));
            let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
            low >= 0.0 && and(side, high)
        };
        let sides = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| {
            let plane = |normal: DVec3, corner: DVec3| Plane { normal, offset: normal.dot(corner) };
            [plane(axis, most), plane(-axis, least)]
        });
        self.body_of_face[face] == Some(body)
            || sides.into_iter().any(|side| apart(&side))
            || self.solids[body as usize].as_ref().is_some_and(|solid| solid.planes.iter().any(apart))
    }

    /// The polygons that one stands for: those of its body, if that is a [`Solid`].
    pub fn sides(&self, polygon: u32) -> impl Iterator<Item = u32> + '_ {
        let body = self.body[polygon as usize].filter(|&body| self.solids[body as usize].is_some());
        let all = body.map_or(&[][..], |body| &self.polygons_of[body as usize]);
        body.is_none().then_some(polygon).into_iter().chain(all.iter().copied())
    }
}

/// A body with more sides than that is looked at side by side: its outline has many edges.
const MOST_SIDES: usize = 128;

/// Quadrilaterals and a triangle that a convex outline is made of.
fn fan(outline: &[u32]) -> Vec<Vec<u32>> {
    let ends = (1..outline.len() - 1).step_by(2);
    ends.map(|k| {
        let mut part = vec![outline[0], outline[k], outline[k + 1]];
        part.extend(outline.get(k + 2));
        part
    })
    .collect()
}

fn cyclic(outline: &[u32]) -> impl Iterator<Item = Edge> {
    (0..outline.len()).map(|k| (outline[k], outline[(k + 1) % outline.len()]))
}

/// Every side of a body against every vertex takes time; of one with more sides than that it is not known.
const MOST_EXAMINED: usize = 2000;

/// What is known of bodies that are closed.
struct Closed {
    body_of_face: Vec<Option<u32>>,
    boxes: Vec<[DVec3; 2]>,
    /// The outline of what closes an open one.
    caps: Vec<Option<Vec<u32>>>,
}

/// Faces that know which edges they share.
struct Mesh<'a> {
    faces: &'a [Polygon],
    vertices: Vec<DVec3>,
    corners: Vec<Vec<u32>>,
    owners: HashMap<Edge, Vec<u32>>,
    /// How far from a plane counts as on it, in metres.
    on_plane: f64,
}

impl<'a> Mesh<'a> {
    fn new(faces: &'a [Polygon]) -> Self {
        let mut mesh =
            Self { faces, vertices: Vec::new(), corners: Vec::new(), owners: HashMap::new(), on_plane: 0.0 };
        let mut known = HashMap::new();
        for (face, k) in faces.iter().zip(0..) {
            let number = |v: &DVec3| {
                // + 0 makes −0 the same place as 0.
                let key = v.to_array().map(|x| (x + 0.0).to_bits());
                *known.entry(key).or_insert_with(|| {
                    mesh.vertices.push(*v);
                    (mesh.vertices.len() - 1) as u32
                })
            };
            let corners: Vec<u32> = face.vertices().iter().map(number).collect();
            cyclic(&corners).for_each(|edge| mesh.owners.entry(edge).or_default().push(k));
            mesh.corners.push(corners);
        }
        let [low, high] = bounds(mesh.vertices.iter().copied());
        mesh.on_plane = ON_PLANE * (high - low).max_element();
        mesh
    }

    /// The one face that has the edge in the other direction, if no other has it in any.
    fn across(&self, (u, v): Edge) -> Option<u32> {
        match (self.owners.get(&(v, u))?.as_slice(), self.owners.get(&(u, v))?.as_slice()) {
            (&[other], [_]) => Some(other),
            _ => None,
        }
    }

    /// The faces that are connected, `joined` over edges: the number of each face's component, and how many there are.
    fn components(&self, joined: impl Fn(u32, u32) -> bool) -> (Vec<u32>, u32) {
        const NONE: u32 = u32::MAX;
        let mut component = vec![NONE; self.faces.len()];
        let mut count = 0;
        for seed in 0..self.faces.len() as u32 {
            if component[seed as usize] != NONE {
                continue;
            }
            component[seed as usize] = count;
            let mut waiting = vec![seed];
            while let Some(face) = waiting.pop() {
                for other in cyclic(&self.corners[face as usize]).filter_map(|edge| self.across(edge)) {
                    if component[other as usize] == NONE && joined(seed, other) {
                        component[other as usize] = count;
                        waiting.push(other);
                    }
                }
            }
            count += 1;
        }
        (component, count)
    }

    /// Connected faces of one plane with one front.
    fn planes(&self) -> Vec<Vec<u32>> {
        let in_plane = |seed: u32, other: u32| {
            let (plane, face) = (&self.faces[seed as usize], &self.faces[other as usize]);
            plane.normal().dot(face.normal()) > 0.0
                && face.vertices().iter().all(|v| plane.height_of(*v).abs() <= self.on_plane)
        };
        let (component, count) = self.components(in_plane);
        let mut planes = vec![Vec::new(); count as usize];
        component.iter().zip(0..).for_each(|(c, face)| planes[*c as usize].push(face));
        planes
    }

    /// The body that each face is of, if it is of a closed one, the boxes around the bodies, and what closes them.
    ///
    /// Closed is also what stands with its open end on a plane that has the whole scene on one side, if nothing looks in there.
    fn bodies(&self, nothing_looks_in: bool) -> Closed {
        let (component, count) = self.components(|_, _| true);
        let mut open = vec![HashMap::new(); count as usize];
        for (corners, c) in self.corners.iter().zip(&component) {
            let edges = cyclic(corners).filter(|&edge| self.across(edge).is_none());
            open[*c as usize].extend(edges.map(|(u, v)| (v, u)));
        }
        let caps: Vec<_> =
            open.iter().map(|edges| if nothing_looks_in { self.cap(edges) } else { None }).collect();
        let closed: Vec<bool> =
            open.iter().zip(&caps).map(|(o, cap)| o.is_empty() || cap.is_some()).collect();
        let mut boxes = vec![bounds(std::iter::empty()); count as usize];
        for (face, c) in self.faces.iter().zip(&component) {
            let [low, high] = &mut boxes[*c as usize];
            face.vertices().iter().for_each(|v| (*low, *high) = (low.min(*v), high.max(*v)));
        }
        let body_of_face = component.iter().map(|&c| closed[c as usize].then_some(c)).collect();
        Closed { body_of_face, boxes, caps }
    }

    /// The convex outline that these edges make on a plane with the whole scene behind it.
    fn cap(&self, edges: &HashMap<u32, u32>) -> Option<Vec<u32>> {
        let start = *edges.keys().min()?;
        let mut outline = vec![start];
        let mut at = *edges.get(&start)?;
        while at != start && outline.len() < edges.len() {
            outline.push(at);
            at = *edges.get(&at)?;
        }
        let whole = at == start && outline.len() == edges.len();
        let outline = self.without_straight_corners(&outline);
        if !whole || outline.len() < 3 {
            return None;
        }
        let plane = self.polygon(&outline[..3]);
        let height = |v: &u32| plane.height_of(self.vertices[*v as usize]);
        let behind = self.vertices.iter().all(|v| plane.height_of(*v) <= self.on_plane);
        let flat = outline.iter().all(|v| height(v) >= -self.on_plane);
        (behind && flat && self.is_convex(&outline, plane.normal())).then_some(outline)
    }

    /// The outline of faces of a plane, if it is one without holes that touches itself nowhere.
    fn outline(&self, plane: &[u32]) -> Option<Vec<u32>> {
        let mine: std::collections::HashSet<u32> = plane.iter().copied().collect();
        let mut next = HashMap::new();
        for edge in plane.iter().flat_map(|&face| cyclic(&self.corners[face as usize])) {
            let inner = self.across(edge).is_some_and(|other| mine.contains(&other));
            if !inner && next.insert(edge.0, edge.1).is_some() {
                return None;
            }
        }
        let start =
            plane.iter().flat_map(|&face| &self.corners[face as usize]).find(|v| next.contains_key(v))?;
        let mut outline = vec![*start];
        let mut at = *next.get(start)?;
        while at != *start {
            outline.push(at);
            at = *next.get(&at)?;
        }
        (outline.len() == next.len()).then_some(outline)
    }

    /// A polygon from the numbers of its three or four corners.
    fn polygon(&self, corners: &[u32]) -> Polygon {
        let at = |v: u32| self.vertices[v as usize];
        match *corners {
            [a, b, c, d] => Polygon::quadrilateral(at(a), at(b), at(c), at(d)),
            _ => Polygon::triangle(at(corners[0]), at(corners[1]), at(corners[2])),
        }
    }

    /// The body of these sides, if it is convex with its fronts outside.
    fn solid(&self, sides: &[Vec<u32>]) -> Option<Solid> {
        let at = |v: u32| self.vertices[v as usize];
        let mut vertices: Vec<u32> = sides.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let plane = |side: &Vec<u32>| {
            let normal = self.polygon(&side[..3]).normal();
            Plane { normal, offset: normal.dot(at(side[0])) }
        };
        let planes: Vec<Plane> = sides.iter().map(plane).collect();
        let behind = |plane: &Plane| vertices.iter().all(|&v| plane.height_of(at(v)) <= self.on_plane);
        if sides.is_empty() || sides.len() > MOST_EXAMINED || !planes.iter().all(behind) {
            return None;
        }
        let edges = || sides.iter().zip(0..).flat_map(|(side, k)| cyclic(side).map(move |edge| (edge, k)));
        let side_of: HashMap<Edge, u32> = edges().collect();
        let mut ridges = Vec::new();
        for ((u, v), k) in edges() {
            // An edge that one of its sides has in two pieces is in no outline.
            let across = *side_of.get(&(v, u))?;
            if u < v {
                ridges.push(Ridge { ends: [at(u), at(v)], sides: [k, across] });
            }
        }
        Some(Solid { planes, ridges, vertices: vertices.into_iter().map(at).collect() })
    }

    fn without_straight_corners(&self, outline: &[u32]) -> Vec<u32> {
        let n = outline.len();
        let at = |k: usize| self.vertices[outline[k % n] as usize];
        let turns = |k: usize| {
            let (before, after) = (at(k) - at(k + n - 1), at(k + 1) - at(k));
            before.cross(after).length() > STRAIGHT * before.length() * after.length()
                || before.dot(after) < 0.0
        };
        (0..n).filter(|&k| turns(k)).map(|k| outline[k]).collect()
    }

    fn is_convex(&self, outline: &[u32], normal: DVec3) -> bool {
        let n = outline.len();
        let at = |k: usize| self.vertices[outline[k % n] as usize];
        let left = |k: usize| (at(k + 1) - at(k)).cross(at(k + 2) - at(k + 1)).dot(normal) > 0.0;
        // Turned once about, not twice: every corner is left of the first edge.
        let once = |k: usize| (at(1) - at(0)).cross(at(k) - at(0)).dot(normal) > 0.0;
        n >= 3 && (0..n).all(left) && (2..n).all(once)
    }
}

/// The sine of a turn that is none: far above the rounding of coordinates, far below any corner.
const STRAIGHT: f64 = 1e-9;

fn bounds(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    points.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The six faces of the box, n × n squares each, each square two triangles.
    fn cube(low: f64, high: f64, n: usize) -> Vec<Polygon> {
        let at = |k: usize| low + (high - low) * k as f64 / n as f64;
        let mut faces = Vec::new();
        for (axis, far) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            let point = |i: usize, j: usize| {
                let mut p = [if far { high } else { low }; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (at(i), at(j));
                DVec3::from_array(p)
            };
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut c = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
                if !far {
                    c.reverse();
                }
                faces.extend([Polygon::triangle(c[0], c[1], c[2]), Polygon::triangle(c[0], c[2], c[3])]);
            }
        }
        faces
    }

    #[test]
    fn the_faces_of_a_cut_cube_are_six_squares() {
        for n in [1, 4] {
            let blockers = Blockers::new(&cube(0.3, 0.7, n));
            assert_eq!(blockers.polygons.len(), 6);
            for polygon in &blockers.polygons {
                assert!((polygon.area() - 0.16).abs() < 1e-15 && polygon.vertices().len() == 4);
                assert!((polygon.centroid() - DVec3::splat(0.5)).dot(polygon.normal()) > 0.1);
            }
            assert!(blockers.body.iter().all(Option::is_some));
            let [Some(solid)] = blockers.solids.as_slice() else { panic!("a convex body") };
            assert_eq!((solid.planes.len(), solid.ridges.len(), solid.vertices.len()), (6, 12, 8));
        }
    }

    #[test]
    fn what_is_not_convex_or_not_closed_stays_as_it_is() {
        let mut faces = cube(0.0, 1.0, 2);
        faces.truncate(8 * 5 - 1);
        let blockers = Blockers::new(&faces);
        // Four whole sides, and one that lacks a triangle.
        assert_eq!(blockers.polygons.len(), 4 + 7);
        assert!(blockers.body.iter().all(Option::is_none));
        let total: f64 = blockers.polygons.iter().map(Polygon::area).sum();
        assert!((total - 4.875).abs() < 1e-14);
    }
}
