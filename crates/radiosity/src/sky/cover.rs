//! What hides the sky from a point: convex bodies and polygons, each of which hides what is between the planes through the point
//! and its outline.

use crate::polygon::Polygon;
use crate::visibility::blockers::Blockers;
use crate::visibility::solid::Solid;
use glam::DVec3;
use std::ops::Range;

/// The polygons of a scene as what hides.
#[derive(Clone, Debug)]
pub(crate) struct Cover {
    hiders: Vec<Hider>,
    /// How far from a plane counts as on it.
    touch: f64,
}

#[derive(Clone, Debug)]
enum Hider {
    Body(Solid),
    Side(Polygon),
}

impl Cover {
    /// Of these polygons; what is nearer to a plane than `touch` is on it.
    pub fn new(polygons: &[Polygon], touch: f64) -> Self {
        let blockers = Blockers::from_beyond(polygons);
        let is_solid = |body: &Option<u32>| body.is_some_and(|body| blockers.solids[body as usize].is_some());
        let sides = blockers.polygons.iter().zip(&blockers.body).filter(|(_, body)| !is_solid(body));
        let sides = sides.map(|(polygon, _)| Hider::Side(polygon.clone()));
        let bodies = blockers.solids.iter().flatten().map(|solid| Hider::Body(solid.clone()));
        Self { hiders: bodies.chain(sides).collect(), touch }
    }

    /// No polygons.
    pub fn nothing() -> Self {
        Self { hiders: Vec::new(), touch: 0.0 }
    }

    /// Appends the inward normals of the planes of what hides something of the half space over a point, and for each which
    /// of them; false if everything is hidden, in a body or under it.
    pub fn shadows(
        &self,
        point: DVec3,
        normal: DVec3,
        planes: &mut Vec<DVec3>,
        shadows: &mut Vec<Range<usize>>,
    ) -> bool {
        for hider in &self.hiders {
            // What is below the horizon hides nothing, nor does the face that the point is on.
            if !hider.vertices().iter().any(|v| (*v - point).dot(normal) > self.touch) {
                continue;
            }
            let start = planes.len();
            match hider {
                Hider::Body(solid) => match solid.in_front(point, self.touch) {
                    0 if self.is_on(solid, point, normal) => continue,
                    0 => return false,
                    in_front => {
                        let outline = solid
                            .ridges
                            .iter()
                            .filter_map(|ridge| ridge.on_outline(|k| in_front >> k & 1 == 1));
                        planes.extend(outline.map(|[from, to]| (to - point).cross(from - point)));
                    }
                },
                Hider::Side(polygon) => {
                    let height = polygon.height_of(point);
                    if height.abs() <= self.touch {
                        continue;
                    }
                    let v = polygon.vertices();
                    let edges = (0..v.len()).map(|k| (v[k], v[(k + 1) % v.len()]));
                    planes.extend(edges.map(|(from, to)| (to - point).cross(from - point) * height.signum()));
                }
            }
            shadows.push(start..planes.len());
        }
        true
    }

    /// Whether a point is on a side of a body whose front is the point's: rounded digits may put corners of the body over it.
    fn is_on(&self, solid: &Solid, point: DVec3, normal: DVec3) -> bool {
        let mut planes = solid.planes.iter();
        planes.any(|plane| plane.height_of(point).abs() <= self.touch && plane.normal.dot(normal) > 0.0)
    }
}

impl Hider {
    fn vertices(&self) -> &[DVec3] {
        match self {
            Self::Body(solid) => &solid.vertices,
            Self::Side(polygon) => polygon.vertices(),
        }
    }
}
