//! L(x) = (E + ρ H)/π at every pixel, with the irradiance H found anew there: direct light exactly, indirect light
//! by a final gather.

use crate::kernel::SurfacePoint;
use crate::lights;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::reconstruct::{Gather, Lamps, Rotation, Site, on_surface};
use crate::render::colour::Colour;
use crate::render::fragments::{Fragment, Fragments};
use crate::render::picture::Picture;
use crate::render::smooth::{Lit, Planes, smooth};
use crate::render::view::{Rays, View};
use crate::scene::{Scene, Surface};
use crate::visibility::Visibility;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

/// The picture of a solved scene: soft shadows from its lamps, indirect light without the seams of patches.
///
/// `radiosity` is B in W/m², one per patch. `progress` is told how many rows are lit, from whatever thread lit
/// the last; the digits of the picture do not depend on the threads.
pub fn final_picture<V: Colour>(
    view: &View,
    scene: &Scene<V>,
    patches: &Patches<V>,
    visibility: &Visibility,
    radiosity: &[V],
    progress: &(dyn Fn(usize) + Sync),
) -> Picture {
    let polygons = scene.polygons();
    let rays = Rays::new(&view.camera, view.width, view.height);
    let shape = (rays, view.width, view.height, view.samples);
    let fragments = Fragments::new(shape, &polygons, visibility, |polygon, _| polygon);
    let lighting = Lighting::new(view, scene, patches, visibility, radiosity, &polygons);
    let lit = by_rows(&fragments, |pixel, fragment| lighting.of(fragment, pixel), progress);
    let indirect = smooth(&fragments, &Planes::new(scene), &lit);
    let beyond = fragments.beyond(|direction| lights::beyond(&scene.lights, direction).to_rgb());
    fragments.resolve(|k| lit[k].direct + indirect[k], &beyond)
}

/// `light` of every fragment, in order.
fn by_rows(
    fragments: &Fragments,
    light: impl Fn(usize, &Fragment) -> Lit + Sync,
    progress: &(dyn Fn(usize) + Sync),
) -> Vec<Lit> {
    let done = AtomicUsize::new(0);
    let row = |y: usize| {
        let pixels = y * fragments.width..(y + 1) * fragments.width;
        let lit: Vec<Lit> = pixels
            .flat_map(|p| fragments.all[fragments.of_pixel(p)].iter().map(move |f| (p, f)))
            .map(|(pixel, fragment)| light(pixel, fragment))
            .collect();
        progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        lit
    };
    (0..fragments.height).into_par_iter().map(row).collect::<Vec<_>>().concat()
}

/// All that the light at a point depends on.
struct Lighting<'a, V> {
    gather: Gather<'a, V>,
    surfaces: Vec<&'a Surface<V>>,
}

/// How far a point is lifted off its surface, relative to the size of the scene: more than the rounding of where
/// a ray ends, less than the crack under anything that stands on a floor.
const LIFT: f64 = 1e-7;

impl<'a, V: Colour> Lighting<'a, V> {
    fn new(
        view: &View,
        scene: &'a Scene<V>,
        patches: &'a Patches<V>,
        visibility: &'a Visibility,
        radiosity: &[V],
        polygons: &'a [Polygon],
    ) -> Self {
        let lamps = Lamps::new(scene, visibility);
        let radiosity = match &lamps {
            Some(_) => radiosity.iter().zip(&patches.emission).map(|(b, e)| *b - *e).collect(),
            None => radiosity.to_vec(),
        };
        let lift = LIFT * extent(polygons);
        Self {
            gather: Gather { polygons, patches, visibility, radiosity, lamps, lift, rays: view.gather },
            surfaces: scene.surfaces.iter().flat_map(|s| s.polygons.iter().map(move |_| s)).collect(),
        }
    }

    /// What the fragment of a pixel sends to the camera, as radiance.
    fn of(&self, fragment: &Fragment, pixel: usize) -> Lit {
        let surface = self.surfaces[fragment.shown as usize];
        let Gather { polygons, visibility, lift, .. } = self.gather;
        let SurfacePoint { position, normal } =
            on_surface(&polygons[fragment.shown as usize], fragment.point, visibility, lift);
        let site = Site { point: position, normal, rotation: Rotation::of(pixel) };
        let direct = self.gather.direct(&site);
        let gathered = self.gather.at(&site);
        let radiance = |exitance: V| exitance.to_rgb() * (1.0 / PI);
        Lit {
            direct: radiance(surface.emission + surface.reflectance * direct),
            indirect: radiance(surface.reflectance * gathered.irradiance),
            openness: gathered.openness,
            normal,
        }
    }
}

/// The largest coordinate difference between two vertices, in m.
fn extent(polygons: &[Polygon]) -> f64 {
    let vertices = || polygons.iter().flat_map(|p| p.vertices().iter().copied());
    let low = vertices().reduce(glam::DVec3::min).unwrap_or_default();
    vertices().fold(0.0, |extent, v| extent.max((v - low).max_element()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, PointLight};
    use glam::DVec3;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// A cube of edge 2 about the origin, its fronts inside.
    fn room() -> Vec<Polygon> {
        [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .flat_map(|axis| [axis, -axis])
            .map(|n| {
                let (s, t) = n.any_orthonormal_pair();
                // s × t = n: counter-clockwise seen from inside is the other way round.
                Polygon::quadrilateral(n - s - t, n - s + t, n + s + t, n + s - t)
            })
            .collect()
    }

    fn furnace(polygons: Vec<Polygon>) -> Scene<f64> {
        let surface = Surface { name: "wall".into(), reflectance: 0.6, emission: 2.0, polygons };
        Scene { name: "furnace".into(), surfaces: vec![surface], lights: Vec::new(), camera: None }
    }

    fn picture_of(scene: &Scene<f64>, camera: Camera) -> Picture {
        let patches = Patches::new(scene, 0.5).unwrap();
        let polygons = scene.polygons();
        let view = View { camera, width: 16, height: 16, samples: 4, gather: 64 };
        let rows = AtomicUsize::new(0);
        let picture = final_picture(
            &view,
            scene,
            &patches,
            &Visibility::new(&polygons),
            &vec![2.0 / (1.0 - 0.6); patches.len()],
            &|row| {
                rows.fetch_max(row, Ordering::Relaxed);
            },
        );
        assert_eq!(rows.into_inner(), 16);
        picture
    }

    fn camera(position: DVec3) -> Camera {
        Camera { position, target: p(0.1, -0.2, 0.0), up: DVec3::Y, vertical_angle: 1.0 }
    }

    #[test]
    fn in_a_white_furnace_everything_is_equally_bright_from_inside_and_out() {
        let scene = furnace(room());
        for position in [p(0.0, 0.3, 0.9), p(0.6, 1.2, 3.5)] {
            let picture = picture_of(&scene, camera(position));
            let front = |l: &&fredholm::value::Rgb| l.0[0] > 1.0;
            let seen: Vec<_> = picture.pixels.iter().filter(front).collect();
            assert!(seen.len() > 25, "{}", seen.len());
            let expected = 2.0 / (1.0 - 0.6) / PI;
            // From outside, the outline's pixels are partly empty.
            let equal = seen.iter().filter(|l| (l.0[0] / expected - 1.0).abs() < 0.01).count();
            assert!(
                equal * 10 >= seen.len() * if position.z < 1.0 { 10 } else { 6 },
                "{equal} of {}",
                seen.len()
            );
        }
    }

    #[test]
    fn a_point_light_draws_a_sharp_shadow() {
        // A black shade half-way under the light hides |x|, |y| < 1/2 of the floor z = 0.
        let square = |z: f64, half: f64| {
            let corner = |x, y| p(x * half, y * half, z);
            Polygon::quadrilateral(corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.))
        };
        let surface = |name: &str, reflectance, polygon| Surface {
            name: name.into(),
            reflectance,
            emission: 0.0,
            polygons: vec![polygon],
        };
        let surfaces =
            vec![surface("floor", 0.5, square(0.0, 1.0)), surface("shade", 0.0, square(1.0, 0.25))];
        let light = PointLight::uniform(p(0.0, 0.0, 2.0), 8.0);
        let scene = Scene { name: "shadow".into(), surfaces, lights: vec![light.into()], camera: None };
        let (patches, visibility) = (Patches::new(&scene, 0.5).unwrap(), Visibility::new(&scene.polygons()));
        // From aside under the shade, at both sides of the edge of its shadow.
        for (x, lit) in [(0.48, false), (0.52, true)] {
            let camera = Camera {
                position: p(0.9, 0.0, 0.4),
                target: p(x, 0.0, 0.0),
                up: DVec3::Z,
                vertical_angle: 1e-4,
            };
            let view = View { camera, width: 1, height: 1, samples: 1, gather: 16 };
            let picture =
                final_picture(&view, &scene, &patches, &visibility, &vec![0.0; patches.len()], &|_| ());
            let distance: f64 = p(x, 0.0, 2.0).length();
            let expected = if lit { 0.5 / PI * 8.0 * 2.0 / distance.powi(3) } else { 0.0 };
            assert!((picture.pixels[0].0[0] - expected).abs() <= 1e-4 * expected, "{x}: {picture:?}");
        }
    }

    #[test]
    fn many_lamps_make_the_same_furnace() {
        let halves =
            |p: &Polygon| p.triangles().map(|[a, b, c]| Polygon::triangle(a, b, c)).collect::<Vec<_>>();
        let mut polygons = room();
        for _ in 0..3 {
            polygons = polygons.iter().flat_map(halves).flat_map(|t| quarters(&t)).collect();
        }
        let picture = picture_of(&furnace(polygons), camera(p(0.0, 0.3, 0.9)));
        assert!(picture.pixels.iter().all(|l| (l.0[0] * PI / 5.0 - 1.0).abs() < 0.01));
    }

    fn quarters(t: &Polygon) -> Vec<Polygon> {
        let v = t.vertices();
        let (ab, bc, ca) = ((v[0] + v[1]) / 2.0, (v[1] + v[2]) / 2.0, (v[2] + v[0]) / 2.0);
        vec![
            Polygon::triangle(v[0], ab, ca),
            Polygon::triangle(ab, v[1], bc),
            Polygon::triangle(ca, bc, v[2]),
            Polygon::triangle(ab, bc, ca),
        ]
    }
}
