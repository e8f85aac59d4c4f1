//! A solved field for other programs: B and H in every texel of an [`Atlas`] that is laid around the surfaces, or B at the
//! vertices of triangles ([`VertexLight`]).
//!
//! Light comes straight from lamps to each texel by formula, so that shadows are as sharp as texels are; the rest is the
//! field's. Texels beside a polygon have what is at the nearest point of it, and those under what stands on it what is beside
//! that: bilinear filters never mix in what is not lit.

mod atlas;
mod cells;
mod covered;
mod patches;
mod vertices;

pub use atlas::{Atlas, Crowded};
pub use vertices::{MOST_LOOKS, VertexLight, Vertices};

use self::covered::uncovered;
use crate::polygon::Polygon;
use crate::reconstruct::Lit;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Light in every texel of an atlas, row by row from above.
#[derive(Clone, Debug)]
pub struct Lightmap<V> {
    /// Where each polygon is.
    pub atlas: Atlas,
    /// The radiosity B, in W/m² or lm/m²; 0 where nothing is.
    pub radiosity: Vec<V>,
    /// The irradiance H, in W/m² or lx; 0 where nothing is.
    pub irradiance: Vec<V>,
}

/// Texels that one thread looks at: one face may have most of them.
const TOGETHER: usize = 4096;

impl<V: Value> Lightmap<V> {
    /// Looks at the field in every texel. `polygons` are those of the field, in its order; `progress` is told how many of
    /// them are done.
    pub fn new(
        atlas: Atlas,
        field: &dyn Lit<V>,
        polygons: &[Polygon],
        progress: &(dyn Fn(usize) + Sync),
    ) -> Self {
        let done = AtomicUsize::new(0);
        let light = |(k, polygon): (usize, &Polygon)| {
            let texels = atlas.texels(k, polygon);
            let light_of = |texels: &[(usize, DVec3)]| {
                let light = field.seen(&mut texels.iter().map(|(_, point)| (k as u32, *point)));
                let lit = texels.iter().zip(light).map(|((texel, point), light)| {
                    (*texel, (!field.is_covered(k as u32, *point)).then_some(light))
                });
                lit.collect::<Vec<_>>()
            };
            let lit = texels.par_chunks(TOGETHER).flat_map_iter(light_of).collect();
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            uncovered(lit, atlas.size)
        };
        let lit: Vec<_> = polygons.par_iter().enumerate().map(light).collect();
        let dark = vec![V::splat(0.0); atlas.size * atlas.size];
        let (mut radiosity, mut irradiance) = (dark.clone(), dark);
        for (texel, [b, h]) in lit.into_iter().flatten() {
            (radiosity[texel], irradiance[texel]) = (b, h);
        }
        Self { atlas, radiosity, irradiance }
    }
}
