//! Faces through one another, and in one place.

use super::boxes::{Bounds, Boxes};
use super::{Defect, Findings, Mesh};
use crate::polygon::Polygon;
use glam::DVec3;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Of a mesh put into itself every face may cross many: so many pairs say enough, and are found soon.
const ENOUGH: usize = 1000;

/// Finds the pairs of faces that cross or overlap; the first are those with the lowest numbers.
pub(super) fn find(mesh: &Mesh<'_>, findings: &mut Findings<'_>) {
    let bounds = mesh.polygons.iter().map(|polygon| Bounds::of(polygon.vertices(), 0.0)).collect();
    let boxes = Boxes::new(bounds);
    let mut pairs = BTreeSet::new();
    let ended = boxes.pairs(|i, j| {
        let (a, b) = (mesh.face_of[i], mesh.face_of[j]);
        if a != b && mesh.twin[a] != mesh.twin[b] {
            let kind = meet(&mesh.polygons[i], &mesh.polygons[j], mesh.tolerance);
            pairs.extend(kind.map(|kind| ([a.min(b), a.max(b)], kind as usize)));
        }
        if pairs.len() >= ENOUGH { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    for kind in [Defect::Overlapping, Defect::Crossing] {
        let of_kind = pairs.iter().filter(|&&(_, other)| other == kind as usize);
        of_kind.for_each(|(pair, _)| findings.add(kind, pair));
        if ended.is_break() {
            findings.end_counting(kind);
        }
    }
}

/// How two convex polygons meet, if by more than an edge or a corner.
fn meet(a: &Polygon, b: &Polygon, tolerance: f64) -> Option<Defect> {
    let (a_over_b, b_over_a) = (heights(a, b), heights(b, a));
    let is_flat = |[low, high]: [f64; 2]| low >= -tolerance && high <= tolerance;
    if is_flat(a_over_b) && is_flat(b_over_a) {
        let agree = a.normal().dot(b.normal()) > 0.0;
        return (agree && overlap(a, b, tolerance)).then_some(Defect::Overlapping);
    }
    let is_through = |[low, high]: [f64; 2]| low < -tolerance && high > tolerance;
    if !(is_through(a_over_b) && is_through(b_over_a)) {
        return None;
    }
    let line = a.normal().cross(b.normal()).try_normalize()?;
    let ([a0, a1], [b0, b1]) = (chord(a, b, line)?, chord(b, a, line)?);
    (a1.min(b1) - a0.max(b0) > tolerance).then_some(Defect::Crossing)
}

/// The least and the greatest height of the corners of a polygon over the plane of another.
fn heights(polygon: &Polygon, other: &Polygon) -> [f64; 2] {
    let heights = polygon.vertices().iter().map(|&corner| other.height_of(corner));
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)])
}

/// Where a polygon goes through the plane of another, along their common line.
fn chord(polygon: &Polygon, other: &Polygon, line: DVec3) -> Option<[f64; 2]> {
    let corners = polygon.vertices();
    let ends = (0..corners.len()).filter_map(|k| {
        let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
        let (h, h_next) = (other.height_of(p), other.height_of(q));
        ((h <= 0.0) != (h_next <= 0.0)).then(|| p.lerp(q, h / (h - h_next)).dot(line))
    });
    let [low, high] =
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| [low.min(t), high.max(t)]);
    (low <= high).then_some([low, high])
}

/// Whether no edge of two polygons in one plane has them on either side of it.
fn overlap(a: &Polygon, b: &Polygon, tolerance: f64) -> bool {
    let divides = |a: &Polygon, b: &Polygon| {
        let corners = a.vertices();
        (0..corners.len()).any(|k| {
            let along = corners[(k + 1) % corners.len()] - corners[k];
            let inward = a.normal().cross(along).normalize_or_zero();
            b.vertices().iter().all(|&corner| inward.dot(corner - corners[k]) <= tolerance)
        })
    };
    !divides(a, b) && !divides(b, a)
}
