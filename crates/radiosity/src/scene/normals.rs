//! n_k of the corners of a face → n_k of the vertices of its polygons; what is wrong with some is told, and they stay flat.

use super::error::Spot;
use crate::polygon::{NormalFault, Polygon};
use glam::DVec3;

/// The polygons that a face with these corners was cut in, with the normals of its corners, `None` where a file gives none;
/// and why it stays flat, where some are given and it does.
pub(super) fn curved(
    polygons: Vec<Polygon>,
    corners: &[DVec3],
    normals: &[Option<DVec3>],
) -> (Vec<Polygon>, Option<NormalFault>) {
    if normals.iter().all(Option::is_none) {
        return (polygons, None);
    }
    let Some(normals) = normals.iter().copied().collect::<Option<Vec<DVec3>>>() else {
        return (polygons, Some(NormalFault::Missing));
    };
    // No two corners of a face are in one place.
    let normal_at = |vertex: &DVec3| {
        let corner = corners.iter().position(|corner| corner == vertex)?;
        normals.get(corner).copied()
    };
    let bent = |polygon: &Polygon| {
        let normals: Option<Vec<DVec3>> = polygon.vertices().iter().map(normal_at).collect();
        polygon.clone().with_normals(&normals.ok_or(NormalFault::Missing)?)
    };
    match polygons.iter().map(bent).collect() {
        Ok(curved) => (curved, None),
        Err(fault) => (polygons, Some(fault)),
    }
}

/// Faces that stay flat although their corners have normals, by what is wrong with these.
#[derive(Default)]
pub(super) struct LeftFlat(Vec<(NormalFault, usize, Spot)>);

impl LeftFlat {
    pub fn add(&mut self, fault: NormalFault, spot: Spot) {
        match self.0.iter_mut().find(|(known, ..)| *known == fault) {
            Some((_, count, _)) => *count += 1,
            None => self.0.push((fault, 1, spot)),
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.iter().map(|(_, count, _)| count).sum()
    }

    /// A sentence for each fault, and where the first face with it stands.
    pub fn told(&self) -> impl Iterator<Item = (Spot, String)> {
        self.0.iter().map(|&(fault, count, spot)| {
            let (what, first) = if count == 1 { ("face is", "") } else { ("faces are", ", the first") };
            let message = format!(
                "{count} {what} drawn flat{first} here: {fault}; mend the mesh's normals, or leave them out"
            );
            (spot, message)
        })
    }
}
