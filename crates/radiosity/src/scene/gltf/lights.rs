//! What a node carries beside meshes: a light, I (W/sr or cd) or H (W/m² or lx) along −z, or the camera, which looks along −z
//! with y upwards.

use super::name_of;
use crate::scene::error::{Place, Problem};
use crate::scene::mesh::Mesh;
use crate::scene::{Camera, Distribution, Light, PointLight, Spot, Sun, check};
use ::gltf::Node;
use ::gltf::camera::Projection;
use ::gltf::khr_lights_punctual::{self as punctual, Kind};
use fredholm::value::{Rgb, Spectrum};
use glam::{DMat4, DVec3};
use std::f64::consts::FRAC_PI_2;

/// Takes the light and the camera of a node that stands `here`.
pub(super) fn take(node: &Node<'_>, here: DMat4, mesh: &mut Mesh) -> Result<(), Problem> {
    if let Some(light) = node.light() {
        if light.range().is_some() {
            let message = format!(
                "the range of the light of {} is passed over: light goes on until something stops it",
                name_of(node)
            );
            mesh.warn(Place::file(&mesh.file), message);
        }
        let light = taken(&light, here);
        check::light(mesh.lights.len() + 1, &light)?;
        mesh.lights.push(light);
    }
    let Some(camera) = node.camera() else { return Ok(()) };
    let file = Place::file(&mesh.file);
    let axis = |axis| axis_of(here, axis);
    match camera.projection() {
        Projection::Perspective(lens) if mesh.camera.is_none() => {
            let position = here.transform_point3(DVec3::ZERO);
            let camera = Camera {
                position,
                target: position + axis(DVec3::NEG_Z),
                up: axis(DVec3::Y),
                vertical_angle: f64::from(lens.yfov()),
            };
            camera.check()?;
            mesh.camera = Some(camera);
        }
        Projection::Perspective(_) => {
            mesh.warn(file, format!("{} has a second camera, which is passed over", name_of(node)));
        }
        Projection::Orthographic(_) => {
            mesh.warn(
                file,
                format!("{} has a camera without perspective, which is passed over", name_of(node)),
            );
        }
    }
    Ok(())
}

fn axis_of(here: DMat4, axis: DVec3) -> DVec3 {
    here.transform_vector3(axis).normalize_or_zero()
}

/// A light where its node is.
fn taken(light: &punctual::Light<'_>, here: DMat4) -> Light<Rgb> {
    let amount = Spectrum(light.color().map(|channel| f64::from(channel) * f64::from(light.intensity())));
    let point = |distribution| {
        let position = here.transform_point3(DVec3::ZERO);
        Light::Point(PointLight { position, intensity: amount, distribution })
    };
    let direction = axis_of(here, DVec3::NEG_Z);
    match light.kind() {
        Kind::Point => point(Distribution::Uniform),
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            let [inner, outer] = [inner_cone_angle, outer_cone_angle].map(f64::from);
            // A right angle is a little more than that in single precision.
            point(Distribution::Spot(Spot {
                direction,
                inner,
                outer: outer.min(FRAC_PI_2.max(outer - ROUNDED)),
            }))
        }
        Kind::Directional => Light::Sun(Sun { direction, irradiance: amount }),
    }
}

/// What single precision may add to an angle.
const ROUNDED: f64 = 1e-6;
