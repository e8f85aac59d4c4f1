//! Room 2: the mesh of the domain. Each input polygon is cut into patches P_i on which u is constant (P0).

mod corners;
mod grid;

pub(crate) use corners::Corners;
pub(crate) use grid::inverse_bilinear;

use crate::polygon::Polygon;
use crate::scene::{Light, Scene, Surface};
use fredholm::value::Value;
use glam::DVec3;
use grid::{Divisions, Grid};
use std::ops::Range;

/// The patches of a scene with their reflectance ρ and emission E, in the order of surfaces and polygons.
#[derive(Clone, Debug)]
pub struct Patches<V> {
    /// The patches: planar convex triangles and quadrilaterals.
    pub polygons: Vec<Polygon>,
    /// The area of each patch, in m².
    pub areas: Vec<f64>,
    /// The reflectance ρ of each patch.
    pub reflectance: Vec<V>,
    /// The exitance E of each patch, in W/m².
    pub emission: Vec<V>,
    /// The index of each patch's surface in the scene.
    pub surface: Vec<u32>,
    /// The lights that shine on them beside the surfaces.
    pub lights: Vec<Light<V>>,
    /// Strips of neighbouring patches, in the order of the patches, every patch in one.
    pub strips: Vec<Strip>,
    cuts: Vec<Cut>,
}

/// Up to eight patches side by side in one plane, that together are one convex polygon.
#[derive(Clone, Debug)]
pub struct Strip {
    /// Which patches they are.
    pub patches: Range<usize>,
    /// All of them together.
    pub polygon: Polygon,
}

/// Patch size that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// Not a positive finite length.
    #[error("patch size {0} m: give a positive finite length")]
    Size(f64),
    /// More patches than can be numbered or stored.
    #[error(
        "patches of {size:.2e} m would be {count:.3e}, more than {MAX_PATCHES}: take larger ones, or fewer"
    )]
    TooMany {
        /// The patch size asked for, in m.
        size: f64,
        /// How many patches it makes.
        count: f64,
    },
}

/// 16 million patches take some 4 GB before any form factor is computed.
pub const MAX_PATCHES: usize = 1 << 24;

impl<V: Value> Patches<V> {
    /// Cuts every polygon of the scene into patches whose edges are at most `size` metres long.
    pub fn new(scene: &Scene<V>, size: f64) -> Result<Self, PatchError> {
        if !(size > 0.0 && size.is_finite()) {
            return Err(PatchError::Size(size));
        }
        let count = count_for_size(scene, size);
        if count > MAX_PATCHES as f64 {
            return Err(PatchError::TooMany { size, count });
        }
        let mut patches = Self::empty(scene);
        patches.polygons.reserve(count as usize);
        for (index, surface) in scene.surfaces.iter().enumerate() {
            for polygon in &surface.polygons {
                patches.cut(polygon, size);
            }
            patches.make(index, surface);
        }
        patches.areas = patches.polygons.iter().map(Polygon::area).collect();
        Ok(patches)
    }

    /// The patches that somebody else has cut the polygons of the scene into, polygon by polygon.
    pub fn from_parts(scene: &Scene<V>, parts: impl IntoIterator<Item = Vec<Polygon>>) -> Self {
        let mut patches = Self::empty(scene);
        let mut parts = parts.into_iter();
        for (index, surface) in scene.surfaces.iter().enumerate() {
            for (polygon, parts) in surface.polygons.iter().zip(&mut parts) {
                let first = patches.len();
                let strip = |(k, part): (usize, &Polygon)| Strip {
                    patches: first + k..first + k + 1,
                    polygon: part.clone(),
                };
                patches.strips.extend(parts.iter().enumerate().map(strip));
                patches.polygons.extend(parts);
                patches.cuts.push(Cut::Parts(first..patches.len(), polygon.clone()));
            }
            patches.make(index, surface);
        }
        patches.areas = patches.polygons.iter().map(Polygon::area).collect();
        patches
    }

    fn empty(scene: &Scene<V>) -> Self {
        Self {
            polygons: Vec::new(),
            areas: Vec::new(),
            reflectance: Vec::new(),
            emission: Vec::new(),
            surface: Vec::new(),
            lights: scene.lights.clone(),
            strips: Vec::new(),
            cuts: Vec::new(),
        }
    }

    /// What the last patches, up to all, are made of.
    fn make(&mut self, index: usize, surface: &Surface<V>) {
        let n = self.polygons.len();
        self.reflectance.resize(n, surface.reflectance);
        self.emission.resize(n, surface.emission);
        self.surface.resize(n, index as u32);
    }

    fn cut(&mut self, polygon: &Polygon, size: f64) {
        let grid = Grid {
            first: self.polygons.len(),
            divisions: Divisions::of(polygon, size),
            whole: polygon.clone(),
        };
        self.polygons.extend(grid.patches());
        self.strips.extend(grid.strips());
        self.cuts.push(Cut::Grid(grid));
    }

    /// How many patches there are.
    pub fn len(&self) -> usize {
        self.polygons.len()
    }

    /// The mean of the reflectance by area, of the channel that reflects most at each.
    pub(crate) fn mean_reflectance(&self) -> f64 {
        let total: f64 = self.areas.iter().sum();
        self.areas.iter().zip(&self.reflectance).map(|(area, rho)| area * rho.magnitude()).sum::<f64>()
            / total
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// The patch of input polygon number `polygon` (counted over all surfaces) nearest to a point of it.
    pub fn patch_at(&self, polygon: u32, point: DVec3) -> usize {
        match &self.cuts[polygon as usize] {
            Cut::Grid(grid) => grid.patch_at(point),
            Cut::Parts(parts, _) => {
                let outside = |k: &usize| self.polygons[*k].distance_outside(point);
                parts.clone().min_by(|a, b| outside(a).total_cmp(&outside(b))).unwrap_or(parts.start)
            }
        }
    }

    /// The unit normal of input polygon number `polygon`, on its front.
    pub fn normal_of(&self, polygon: u32) -> DVec3 {
        self.face(polygon).normal()
    }

    /// Input polygon number `polygon`.
    pub(crate) fn face(&self, polygon: u32) -> &Polygon {
        match &self.cuts[polygon as usize] {
            Cut::Grid(Grid { whole, .. }) | Cut::Parts(_, whole) => whole,
        }
    }

    /// How many input polygons there are.
    pub(crate) fn faces(&self) -> u32 {
        self.cuts.len() as u32
    }

    /// The number of the input polygon that each patch lies on.
    pub fn face_of_each(&self) -> Vec<u32> {
        (0..self.faces()).flat_map(|face| self.on_polygon(face).map(move |_| face)).collect()
    }

    /// Which patches lie on input polygon number `polygon`.
    pub fn on_polygon(&self, polygon: u32) -> Range<usize> {
        match &self.cuts[polygon as usize] {
            Cut::Grid(grid) => grid.first..grid.first + grid.divisions.count() as usize,
            Cut::Parts(parts, _) => parts.clone(),
        }
    }
}

/// The largest patch size, in metres, that cuts the scene into `count` patches or more, to a thousandth.
///
/// Whole numbers of patches fit each polygon, so there are somewhat more of them, and never fewer than polygons.
pub fn size_for_count<V: Value>(scene: &Scene<V>, count: usize) -> f64 {
    let polygons = || scene.surfaces.iter().flat_map(|s| &s.polygons);
    let patches = |size: f64| count_for_size(scene, size);
    let mut high = polygons().map(Polygon::diameter).fold(f64::MIN_POSITIVE, f64::max);
    if patches(high) >= count as f64 {
        return high;
    }
    let area: f64 = polygons().map(Polygon::area).sum();
    // Square patches of this size would do if whole numbers of them fitted; patches are no larger than that.
    let mut low = (area / count as f64).sqrt();
    while patches(low) < count as f64 {
        low *= 0.5;
    }
    while high > 1.001 * low {
        let middle = (low * high).sqrt();
        *(if patches(middle) < count as f64 { &mut high } else { &mut low }) = middle;
    }
    low
}

/// How many patches a size makes, in metres.
pub fn count_for_size<V: Value>(scene: &Scene<V>, size: f64) -> f64 {
    let polygons = scene.surfaces.iter().flat_map(|s| &s.polygons);
    polygons.map(|p| Divisions::of(p, size).count()).sum()
}

/// An input polygon, cut into a grid or by somebody else into some parts.
#[derive(Clone, Debug)]
enum Cut {
    Grid(Grid),
    Parts(Range<usize>, Polygon),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Surface;

    fn scene(polygons: Vec<Polygon>) -> Scene<f64> {
        let surface = Surface { name: "s".into(), reflectance: 0.5, emission: 1.0, polygons };
        Scene { name: "test".into(), surfaces: vec![surface], lights: Vec::new(), camera: None }
    }

    fn odd_shapes() -> Vec<Polygon> {
        let o = DVec3::new(1.0, 2.0, 3.0);
        let p = |x: f64, y: f64| o + x * DVec3::X + y * DVec3::new(0.0, 0.6, 0.8);
        vec![
            Polygon::quadrilateral(p(0.0, 0.0), p(4.0, 0.5), p(2.5, 3.0), p(-0.5, 2.0)),
            Polygon::triangle(p(5.0, 0.0), p(8.0, 1.0), p(6.0, 4.0)),
        ]
    }

    #[test]
    fn patches_cover_their_polygon_and_face_its_way() {
        let scene = scene(odd_shapes());
        let patches = Patches::new(&scene, 0.3).unwrap();
        assert!((patches.areas.iter().sum::<f64>() - scene.surfaces[0].area()).abs() < 1e-12);
        for (k, whole) in odd_shapes().iter().enumerate() {
            for patch in &patches.polygons[patches.on_polygon(k as u32)] {
                assert!(patch.normal().distance(whole.normal()) < 1e-12);
                let v = patch.vertices();
                assert!((0..v.len()).all(|i| v[i].distance(v[(i + 1) % v.len()]) <= 0.3 + 1e-12));
            }
        }
    }

    #[test]
    fn strips_are_their_patches_together() {
        for size in [0.2, 0.3, 0.9, 9.0] {
            let patches = Patches::new(&scene(odd_shapes()), size).unwrap();
            let mut next = 0;
            for Strip { patches: range, polygon } in &patches.strips {
                assert_eq!((range.start, range.len() <= 8), (next, true));
                next = range.end;
                let sum: f64 = patches.areas[range.clone()].iter().sum();
                assert!((polygon.area() - sum).abs() < 1e-13);
                let vertices = patches.polygons[range.clone()].iter().flat_map(|p| p.vertices().to_vec());
                let inside = |v: DVec3| {
                    let corners = polygon.vertices();
                    let edges = (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
                    edges.map(|(p, q)| (q - p).cross(v - p).dot(polygon.normal())).all(|side| side > -1e-12)
                };
                assert!(vertices.into_iter().all(inside));
            }
            assert_eq!(next, patches.len());
        }
    }

    #[test]
    fn a_point_finds_the_patch_that_it_lies_on() {
        let patches = Patches::new(&scene(odd_shapes()), 0.3).unwrap();
        for k in 0..2 {
            for i in patches.on_polygon(k) {
                for (s, t) in [(0.5, 0.5), (0.1, 0.1), (0.9, 0.2), (0.8, 0.9)] {
                    let point = patches.polygons[i].point(s, t);
                    assert_eq!(patches.patch_at(k, point), i, "at {s} {t}");
                }
            }
        }
    }

    #[test]
    fn nonsensical_sizes_are_refused() {
        let scene = scene(odd_shapes());
        for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Patches::new(&scene, size), Err(PatchError::Size(_))));
        }
        assert!(matches!(Patches::new(&scene, 1e-5), Err(PatchError::TooMany { .. })));
    }

    #[test]
    fn the_size_for_a_count_makes_that_many_and_few_more() {
        let scene = scene(odd_shapes());
        for (count, most) in [(1, 2), (2, 2), (10, 16), (100, 115), (1000, 1040), (30_000, 30_200)] {
            let n = Patches::new(&scene, size_for_count(&scene, count)).unwrap().len();
            assert!((count..=most).contains(&n), "{n} for {count}");
        }
    }
}
