//! Room 3: V(s, t) = 1 where no polygon cuts the open segment from s to t, else 0.
//!
//! Rays go against the polygons of the scene, never against the patches that these are cut into: the answer is
//! the same, and there are far fewer of them. Eight boxes, then eight triangles, are tried at a time in f32 with
//! margins that let nothing slip; what they find is decided in f64.
//!
//! A point *on* a polygon (nearer to its plane than 1e-9 of the scene's extent) is never hidden by it, and a
//! segment in its plane never cut. Edges belong to polygons, so no light leaks where two of them meet.

mod beam;
pub(crate) mod blockers;
mod build;
mod buried;
mod bvh;
mod count;
mod end;
mod facet;
mod packet;
mod ray;
pub(crate) mod screens;
mod shaft;
pub(crate) mod solid;
mod walls;

pub use count::{Count, RayCount};

use crate::kernel::SurfacePoint;
use crate::polygon::Polygon;
use crate::reconstruct::Rays;
use crate::sky::cover::Cover;
use crate::sky::{self, Dome};
use beam::{Beam, MOST};
use bvh::Bvh;
pub(crate) use end::End;
use facet::{Facet, Frame, ON_PLANE};
use glam::DVec3;
use ray::{Blocker, Nearest, Ray, bits};
use shaft::Shaft;
use std::sync::OnceLock;

/// How far off a surface rays begin, in the scene's unit: a hundred times what is on it, a thousandth of what lamps hang below
/// ceilings.
const LIFT: f64 = 1e-7;

/// May s and t see each other?
#[derive(Clone, Debug)]
pub struct Visibility {
    frame: Frame,
    facets: Vec<Facet>,
    /// What can hide something.
    occluders: Bvh,
    /// What has the whole scene on one side of its plane and hides nothing: the walls of a convex room.
    walls: Bvh,
    /// What hides the sky, once somebody has asked.
    cover: OnceLock<Cover>,
}

/// Where a ray meets the first polygon on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The polygon, by its index in the slice given to [`Visibility::new`].
    pub polygon: u32,
    /// How far from the ray's origin, in metres.
    pub distance: f64,
}

impl Visibility {
    /// Prepares the polygons of a scene; their indices in this slice are what answers name them by.
    pub fn new(polygons: &[Polygon]) -> Self {
        let frame = Frame::around(polygons);
        let facets: Vec<Facet> = polygons.iter().map(|p| Facet::new(p, &frame)).collect();
        let triangles: Vec<_> = polygons
            .iter()
            .zip(0..)
            .flat_map(|(p, k)| p.triangles().map(move |t| (t.map(|v| frame.point(v)), k)))
            .collect();
        let all = Bvh::new(&triangles, &facets);
        let is_wall = walls::walls(&facets, &all);
        let (walls, occluders): (Vec<_>, Vec<_>) =
            triangles.into_iter().partition(|&(_, k)| is_wall[k as usize]);
        let occluders = if walls.is_empty() { all } else { Bvh::new(&occluders, &facets) };
        let walls = Bvh::new(&walls, &facets);
        Self { frame, facets, occluders, walls, cover: OnceLock::new() }
    }

    /// How far off a surface rays begin so that they do not within it, in metres.
    pub(crate) fn lift(&self) -> f64 {
        self.frame.metres(LIFT)
    }

    /// Whether any polygon can be between two points of the scene: in an empty convex room none can.
    pub fn hides_anything(&self) -> bool {
        !self.occluders.is_empty()
    }

    /// Whether no polygon cuts the open segment from s to t, two points of the scene, in metres.
    pub fn unoccluded(&self, s: DVec3, t: DVec3) -> bool {
        self.blocker(s, t).is_none()
    }

    /// Any polygon that cuts the open segment from s to t.
    ///
    /// Polygons whose plane has the whole scene on one side are left out: they are between no two points of it.
    /// From points outside, ask [`nearest`](Self::nearest), which leaves out nothing.
    pub fn blocker(&self, s: DVec3, t: DVec3) -> Option<u32> {
        if self.occluders.is_empty() {
            return None;
        }
        let (s, t) = (self.frame.point(s), self.frame.point(t));
        let mut query = Blocker { facets: &self.facets, s, t, ray: Ray::new(s, t)?, found: None };
        self.occluders.walk(&mut query);
        query.found
    }

    /// Of each segment between two points of the scene whether it is [`unoccluded`](Self::unoccluded), into `clear`: the same
    /// answers, many times as fast where segments that follow each other go from about one place to about another.
    pub fn unoccluded_each(&self, segments: &[[DVec3; 2]], clear: &mut Vec<bool>) {
        clear.clear();
        clear.resize(segments.len(), true);
        let within = |k: usize| segments[k].map(|v| self.frame.point(v));
        let (mut alone, mut eights) = (Vec::new(), Vec::new());
        for (k, (segments, clear)) in segments.chunks(MOST).zip(clear.chunks_mut(MOST)).enumerate() {
            match Beam::new(&self.facets, &self.frame, segments, &mut eights) {
                Some(mut beam) => {
                    self.occluders.walk(&mut beam);
                    let hidden = beam.hidden();
                    clear.iter_mut().zip(0..).for_each(|(clear, k)| *clear = hidden >> k & 1 == 0);
                    alone.extend(bits(beam.unknown()).map(|lane| k * MOST + lane));
                }
                None => alone.extend((0..segments.len()).map(|lane| k * MOST + lane)),
            }
        }
        let queries = alone.into_iter().filter_map(|k| {
            let [s, t] = within(k);
            Some((k, Blocker { facets: &self.facets, s, t, ray: Ray::new(s, t)?, found: None }))
        });
        self.occluders.walk_each(queries, |k, query| clear[k] = query.found.is_none());
    }

    /// Whether no polygon at all cuts the open segment from s to t, wherever these are: beyond the walls too.
    pub fn is_clear(&self, s: DVec3, t: DVec3) -> bool {
        let (s, t) = (self.frame.point(s), self.frame.point(t));
        let Some(ray) = Ray::new(s, t) else { return true };
        let mut query = Blocker { facets: &self.facets, s, t, ray, found: None };
        self.occluders.walk(&mut query);
        if query.found.is_none() {
            self.walls.walk(&mut query);
        }
        query.found.is_none()
    }

    /// The irradiance at a point of a surface with a unit normal from what the polygons leave of a sky, in sr: its zenith has a
    /// radiance of 1. Of few polygons what they hide is clipped away, of more it is found by rays.
    pub(crate) fn received_from(&self, sky: &Dome, at: &SurfacePoint, rays: Rays) -> f64 {
        if !self.clips_sky() {
            return sky::received_by_rays(sky, at.normal, rays, |to| self.escape(at.position, to));
        }
        let polygon = |facet: &Facet| match *facet.vertices() {
            [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
            _ => Polygon::triangle(facet.corners()[0], facet.corners()[1], facet.corners()[2]),
        };
        let cover = self.cover.get_or_init(|| {
            let polygons: Vec<Polygon> = self.facets.iter().map(polygon).collect();
            Cover::new(&polygons, ON_PLANE)
        });
        sky::received(sky, cover, self.frame.point(at.position), at.normal)
    }

    /// Whether polygons are few enough for the light of a sky to be found without rays.
    pub fn clips_sky(&self) -> bool {
        self.facets.len() <= sky::FEW
    }

    /// How many of the rays from a point in unit directions meet nothing.
    fn escape(&self, origin: DVec3, directions: &[DVec3]) -> usize {
        let s = self.frame.point(origin);
        let reach = self.frame.metres(s.length() + 1.0);
        let segments: Vec<[DVec3; 2]> =
            directions.iter().map(|direction| [origin, origin + reach * *direction]).collect();
        let mut eights = Vec::new();
        let mut of_chunk = |segments: &[[DVec3; 2]]| {
            let clear_alone = |&k: &usize| self.is_clear(segments[k][0], segments[k][1]);
            let Some(mut beam) = Beam::new(&self.facets, &self.frame, segments, &mut eights) else {
                return (0..segments.len()).filter(clear_alone).count();
            };
            self.occluders.walk(&mut beam);
            self.walls.walk(&mut beam);
            let (hidden, unknown) = (beam.hidden(), beam.unknown());
            let known_clear = segments.len() - (hidden | unknown).count_ones() as usize;
            known_clear + bits(unknown).filter(clear_alone).count()
        };
        segments.chunks(MOST).map(&mut of_chunk).sum()
    }

    /// The first polygon, seen from either side, that a ray meets; `direction` is a unit vector.
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let s = self.frame.point(origin);
        // The scene lies within √3/2 of its centre.
        let reach = s.length() + 1.0;
        let t = s + reach * direction;
        let mut query = Nearest { facets: &self.facets, s, t, ray: Ray::new(s, t)?, found: None };
        self.occluders.walk(&mut query);
        self.walls.walk(&mut query);
        query.found.map(|(polygon, at)| Hit { polygon, distance: self.frame.metres(at * reach) })
    }

    /// Whether it is proved that no polygon cuts any segment from a to b; false means "not known".
    ///
    /// The segments fill the convex hull of a and b, so a plane with the hull on one side and a polygon on the other
    /// is the proof. Spoken of are segments along which light goes, in front of both: what lies behind either, or only
    /// touches its plane, is out of their way too. What only touches the hull does not count, so segments on the
    /// hull's boundary, which carry no light, are not spoken of.
    pub fn certainly_clear(&self, a: &Polygon, b: &Polygon) -> bool {
        if self.occluders.is_empty() {
            return true;
        }
        if a.normal() == DVec3::ZERO || b.normal() == DVec3::ZERO {
            return false;
        }
        let (a, b) = (Facet::new(a, &self.frame), Facet::new(b, &self.frame));
        let mut query = Shaft::new(&self.facets, &a, &b);
        self.occluders.walk(&mut query);
        query.clear
    }

    /// Whether it is proved that the one polygon `id` cuts every segment from a to b; false means "not known".
    ///
    /// It is, when it cuts each segment between a vertex a_i and a vertex b_j. For then its plane has a on one side, at
    /// heights g_i, and b on the other, at depths h_j, and the segment from s = Σ α_i a_i to t = Σ β_j b_j goes
    /// through the plane at a weighted mean of the points x_ij where the vertices' segments do, with the weights
    /// α_i β_j (g_i + h_j) ≥ 0. The x_ij are in the polygon, it is convex, so their mean is in it.
    pub fn certainly_blocks(&self, id: u32, a: &Polygon, b: &Polygon) -> bool {
        let unit = |p: &Polygon| Facet::new(p, &self.frame);
        self.facets[id as usize].separates(unit(a).vertices(), unit(b).vertices())
    }

    /// The same of all segments between the convex hulls of two clouds of points, such as the corners of boxes.
    pub fn certainly_blocks_hulls<const N: usize>(&self, id: u32, a: &[DVec3; N], b: &[DVec3; N]) -> bool {
        let unit = |points: &[DVec3; N]| points.map(|point| self.frame.point(point));
        self.facets[id as usize].separates(&unit(a), &unit(b))
    }
}
