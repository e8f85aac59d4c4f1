//! ‖û − u‖ from the residual E + ρ (D + ∫ K û) − û, looked at in points that are neither middles nor corners of patches.

use super::field::Field;
use crate::hierarchical::{Light, Plan, told};
use crate::polygon::Polygon;
use crate::reconstruct::{Lit, Rotation, scattered};
use fredholm::operator::hierarchical::Cluster;
use fredholm::value::Value;
use glam::DVec3;

/// What the error of a field is made of: in the mean square over all surfaces, relative to the light that they reflect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Error {
    /// What links are wrong by.
    pub links: f64,
    /// What light is not linear by between middles and corners, and the rays in half-shadows.
    pub mesh: f64,
    /// Of the iteration, which was stopped.
    pub iteration: f64,
}

/// How large the part of a patch is that stands for a point of it, as a part of its sides.
const POINT: f64 = 0.125;

impl Error {
    /// Of a field that was found with links that may bring a `part`, and what patches send.
    pub fn new<V: Value>(
        field: &Field<'_, V>,
        plan: &Plan<'_, V>,
        (sent, light, part): (&[V], &Light, f64),
        residual: f64,
    ) -> Self {
        let patches = field.patches();
        let (norm, rho) = (field.scale(), patches.mean_reflectance());
        if norm == 0.0 {
            return Self::default();
        }
        let leaves = plan.spread();
        let whole = |leaf: &Cluster| (*leaf, patches.polygons[plan.patch(*leaf)].clone());
        let points = |(k, leaf): (usize, &Cluster)| (*leaf, small(&patches.polygons[plan.patch(*leaf)], k));
        let arriving = |at: &[(Cluster, Polygon)]| plan.arriving(sent, light, part, at);

        let at = arriving(&leaves.iter().map(whole).collect::<Vec<_>>());
        let of_links = |(leaf, arriving): (&Cluster, V)| {
            let patch = plan.patch(*leaf);
            patches.reflectance[patch] * (arriving - field.arriving[patch])
        };
        let links: Vec<V> = leaves.iter().zip(at).map(of_links).collect();

        let points: Vec<(Cluster, Polygon)> = leaves.iter().enumerate().map(points).collect();
        let at = arriving(&points);
        let faces = patches.face_of_each();
        let of_all = |(k, ((leaf, small), arriving)): (usize, (&(Cluster, Polygon), V))| {
            let patch = plan.patch(*leaf);
            let (face, x) = (faces[patch], small.centroid());
            let anew = if field.direct.is_buried(face, x) {
                V::splat(0.0)
            } else {
                field.direct.at(face, x, Rotation::of(k)) + arriving
            };
            patches.reflectance[patch] * (anew - field.irradiance_at(face, x, Rotation::of(faces.len() + k)))
        };
        let all: Vec<V> = points.iter().zip(at).enumerate().map(of_all).collect();

        let [links, all] = [links, all].map(|residuals| told(&residuals, rho) / norm);
        Self {
            links,
            mesh: (all - links).max(0.0),
            iteration: residual / norm / (1.0 - rho).max(f64::EPSILON),
        }
    }
}

/// A small part of a patch, somewhere.
fn small(patch: &Polygon, k: usize) -> Polygon {
    let (s, t) = scattered(k);
    let middle = patch.centroid().lerp(patch.point(s, t), 1.0 - POINT);
    let corners: Vec<DVec3> =
        patch.vertices().iter().map(|v| middle + (*v - patch.centroid()) * POINT).collect();
    match corners[..] {
        [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
        _ => Polygon::triangle(corners[0], corners[1], corners[2]),
    }
}
