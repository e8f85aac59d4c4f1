//! What does not change while the mesh is refined: faces, their materials, and what hides what.

use super::links::{Coarseness, Descent, Link, Looks};
use super::space::{Element, Space};
use super::tree::{Node, Tree};
use crate::form_factor::outlook::{Outlook, Outlooks};
use crate::form_factor::view::{Seen, View};
use crate::kernel::SurfacePoint;
use crate::lights;
use crate::polygon::Polygon;
use crate::reconstruct::Lamps;
use crate::scene::{Light, Scene, Surface};
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::OnceLock;

/// The faces of a scene, with ρ and E.
#[derive(Debug)]
pub struct Domain<'a, V> {
    faces: &'a [Polygon],
    reflectance: Vec<V>,
    emission: Vec<V>,
    /// The faces that emit; none where they are too many to be looked at one by one.
    lamps: Vec<u32>,
    /// What shines and is no face.
    lights: Vec<Light<V>>,
    all: Outlooks<'a>,
    outlooks: Vec<OnceLock<Outlook>>,
}

/// More faces than can be looked at in pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0} faces: what is between any two of them is looked at, for {MOST_FACES} at most; `linked` takes any number"
)]
pub struct TooManyFaces(pub usize);

/// For so many faces what they see of each other takes some 2 GB.
const MOST_FACES: usize = 6000;

/// How far from a corner, on the way to the centre.
const INSIDE: f64 = 1e-6;

/// Points across a node in which it is asked whether something stands there.
const LOOKS: usize = 8;

/// Lamps are looked at from every point.
const MOST_LAMPS: usize = 64;

impl<'a, V: Value> Domain<'a, V> {
    /// `faces` are the polygons of the scene, in its order.
    pub fn new(scene: &Scene<V>, faces: &'a [Polygon]) -> Result<Self, TooManyFaces> {
        if faces.len() > MOST_FACES {
            return Err(TooManyFaces(faces.len()));
        }
        let of_faces = |value: fn(&Surface<V>) -> V| -> Vec<V> {
            scene.surfaces.iter().flat_map(|s| s.polygons.iter().map(move |_| value(s))).collect()
        };
        let emission = of_faces(|s| s.emission);
        let is_lamp = |k: &u32| emission[*k as usize] != V::splat(0.0);
        let lamps: Vec<u32> = (0..faces.len() as u32).filter(is_lamp).take(MOST_LAMPS + 1).collect();
        Ok(Self {
            faces,
            reflectance: of_faces(|s| s.reflectance),
            lamps: if lamps.len() <= MOST_LAMPS { lamps } else { Vec::new() },
            emission,
            lights: scene.lights.clone(),
            all: Outlooks::new(faces),
            outlooks: faces.iter().map(|_| OnceLock::new()).collect(),
        })
    }

    pub(super) fn faces(&self) -> &'a [Polygon] {
        self.faces
    }

    pub(super) fn reflectance(&self, face: u32) -> V {
        self.reflectance[face as usize]
    }

    pub(super) fn emission(&self, face: u32) -> V {
        self.emission[face as usize]
    }

    /// Whether lamps are looked at one by one.
    pub(super) fn has_lamps(&self) -> bool {
        !self.lamps.is_empty()
    }

    /// ρ at the nodes of a space.
    pub(super) fn reflectances(&self, tree: &Tree, space: &Space) -> Vec<V> {
        let of_patch = |(k, &patch): (usize, &u32)| {
            let rho = self.reflectance(tree.node(patch).face);
            space.range(k).map(move |_| rho)
        };
        space.patches.iter().enumerate().flat_map(of_patch).collect()
    }

    /// The lamps that are looked at one by one, for rays.
    pub(super) fn lamps(&self) -> Lamps<'_, V> {
        let lamp = |&k: &u32| (&self.faces[k as usize], self.emission(k));
        Lamps::of(self.lamps.iter().map(lamp).collect(), self.rays())
    }

    /// What casts rays between the faces.
    pub(super) fn rays(&self) -> &Visibility {
        self.all.rays()
    }

    /// What shines and is no face.
    pub(super) fn lights(&self) -> &[Light<V>] {
        &self.lights
    }

    /// The longest side of the box around the faces, in metres.
    pub(super) fn extent(&self) -> f64 {
        let vertices = || self.faces.iter().flat_map(|face| face.vertices());
        let low = vertices().fold(DVec3::INFINITY, |low, v| low.min(*v));
        vertices().fold(0.0, |extent, v| extent.max((*v - low).max_element()))
    }

    /// What the points of a face see.
    fn outlook(&self, face: u32) -> &Outlook {
        self.outlooks[face as usize].get_or_init(|| self.all.from(face as usize))
    }

    /// Whether something stands on a face.
    pub(super) fn is_stood_on(&self, face: u32) -> bool {
        self.outlook(face).is_stood_on()
    }

    /// Whether a point of a face is under something that stands on it, where no light comes.
    pub(super) fn is_buried(&self, face: u32, point: DVec3) -> bool {
        self.outlook(face).is_buried(point)
    }

    /// The faces in patches of some diameter at most.
    pub(super) fn tree(&self, size: f64) -> Tree {
        let mut tree = Tree::new(self.faces, size);
        self.expose(&mut tree.nodes);
        tree
    }

    /// Cuts patches in four.
    pub(super) fn cut(&self, tree: &mut Tree, patches: &[u32]) {
        let known = tree.nodes.len();
        patches.iter().for_each(|&patch| tree.cut(patch));
        self.expose(&mut tree.nodes[known..]);
    }

    /// Finds what of nodes is not under something.
    fn expose(&self, nodes: &mut [Node]) {
        for node in nodes.iter_mut().filter(|node| self.is_stood_on(node.face)) {
            let in_sight = looked_at(node).filter(|x| !self.is_buried(node.face, *x)).count();
            node.exposed = node.area * in_sight as f64 / (LOOKS * LOOKS) as f64;
        }
    }

    /// The point of a leaf at which it is asked what comes straight from the lamps: its centre, or where something stands
    /// on that a point beside it.
    fn point_of(&self, leaf: &Node) -> DVec3 {
        let centre = leaf.polygon.centroid();
        if !self.is_buried(leaf.face, centre) {
            return centre;
        }
        // Of what a convex body leaves of a leaf some corner is a part.
        let corners = leaf.polygon.vertices().iter().map(|v| v.lerp(centre, INSIDE));
        let mut points = looked_at(leaf).chain(corners);
        points.find(|x| !self.is_buried(leaf.face, *x)).unwrap_or(centre)
    }

    /// The way to the parts of the tree that a point of a face sees, and their form factors.
    pub(super) fn descent<'b>(
        &'b self,
        tree: &'b Tree,
        coarseness: Coarseness<'b>,
        (face, point): (u32, DVec3),
    ) -> Descent<'b> {
        let normal = self.faces[face as usize].normal();
        Descent { tree, outlook: self.outlook(face), coarseness, point, normal }
    }

    /// D at the points of the leaves that are not among the first nodes, of which it is known already, in W/m².
    pub(super) fn direct_at_leaves(&self, tree: &Tree, known: Vec<V>) -> Vec<V> {
        let new = known.len() as u32..tree.nodes.len() as u32;
        let at_leaf = |view: &mut View, node: u32| {
            let of_leaf = |leaf: &Node| self.direct(leaf.face, self.point_of(leaf), view);
            Some(tree.node(node)).filter(|_| tree.is_leaf(node)).map_or(V::splat(0.0), of_leaf)
        };
        let direct = new.into_par_iter().map_init(View::default, at_leaf);
        let mut all = known;
        all.par_extend(direct);
        all
    }

    /// What every patch of a tree sees, of which some is known.
    pub(super) fn looks(&self, tree: &Tree, coarseness: Coarseness<'_>, known: Vec<Looks>) -> Vec<Looks> {
        let look = |view: &mut View, (node, known): (&Node, Looks)| {
            let Node { polygon, face, is_patch: true, .. } = node else { return Looks::new() };
            let from = |(point, known): (DVec3, Vec<Link>)| {
                let descent = self.descent(tree, coarseness, (*face, point));
                if known.is_empty() { descent.links(view) } else { descent.further(known, view) }
            };
            let known = known.into_iter().chain(std::iter::repeat(Vec::new()));
            Element::of(polygon).points(polygon).zip(known).map(from).collect()
        };
        tree.nodes.par_iter().zip(known).map_init(View::default, look).collect()
    }

    /// The irradiance at a point of a face straight from what shines and is no face, in W/m².
    pub(super) fn sent_by_lights(&self, face: u32, position: DVec3) -> V {
        let at = SurfacePoint { position, normal: self.faces[face as usize].normal() };
        lights::irradiance(&self.lights, self.all.rays(), &at)
    }

    /// The irradiance that arrives at a point of a face straight from the lamps and from what is no face, in W/m².
    pub(super) fn direct(&self, face: u32, point: DVec3, view: &mut View) -> V {
        let outlook = self.outlook(face);
        let mut sum = self.sent_by_lights(face, point);
        view.go(outlook, point);
        for &lamp in &self.lamps {
            let Some(hiders) = outlook.hiders_of(lamp) else { continue };
            let polygon = &self.faces[lamp as usize];
            if let Seen::Behind(kept) = view.enter(polygon, hiders) {
                sum += self.emission[lamp as usize] * view.factor(outlook, polygon, &kept);
                view.leave(&kept);
            }
        }
        sum
    }
}

/// Points spread over a node.
fn looked_at(node: &Node) -> impl Iterator<Item = DVec3> + '_ {
    let place = |k: usize| (k as f64 + 0.5) / LOOKS as f64;
    (0..LOOKS * LOOKS).map(move |k| node.polygon.point(place(k % LOOKS), place(k / LOOKS)))
}
