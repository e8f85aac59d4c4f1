//! x′ and n(x′): where the light of a pixel is looked for on a polygon that stands for a piece of a curved surface.
//!
//! H is taken about the normal of the curved surface, and from a point of it, so that a coarse sphere has the shading and the
//! soft edge to its dark side of a round one. What is between is asked of the polygons as they are: no light comes through
//! them, whatever the normals say, and what is below the curve's own horizon counts for nothing.

use crate::kernel::SurfacePoint;
use crate::polygon::Polygon;
use crate::visibility::Visibility;

/// The point of the surface where a point of a polygon lies, `lift` metres off it, and the normal there. On a flat polygon
/// these are its own; so is the point where something stands between the two.
pub(crate) fn on_surface(
    polygon: &Polygon,
    point: glam::DVec3,
    visibility: &Visibility,
    lift: f64,
) -> SurfacePoint {
    let off = polygon.normal() * lift;
    let flat = point + off;
    let (curve, normal) = polygon.on_curve(point);
    let way = curve - point;
    let distance = way.length();
    let position = if distance > 0.0 {
        // Walls that stand round the whole scene are met by this ray alone.
        let hit = visibility.nearest(flat, way / distance);
        if hit.is_none_or(|hit| hit.distance > distance) { curve + off } else { flat }
    } else {
        flat
    };
    SurfacePoint { position, normal }
}
