//! What a node carries beside meshes: a point light I (W/sr or cd), or the camera, which looks along −z with y upwards.

use super::name_of;
use crate::scene::error::{Place, Problem};
use crate::scene::mesh::Mesh;
use crate::scene::{Camera, PointLight};
use ::gltf::Node;
use ::gltf::camera::Projection;
use ::gltf::khr_lights_punctual::{Kind, Light};
use fredholm::value::Spectrum;
use glam::{DMat4, DVec3};

/// Takes the light and the camera of a node that stands `here`.
pub(super) fn take(node: &Node<'_>, here: DMat4, mesh: &mut Mesh) -> Result<(), Problem> {
    let file = Place::file(&mesh.file);
    if let Some(light) = node.light() {
        match other(&light) {
            None => {
                let intensity = light.color().map(|channel| f64::from(channel) * f64::from(light.intensity()));
                let position = here.transform_point3(DVec3::ZERO);
                mesh.lights.push(PointLight { position, intensity: Spectrum(intensity), direction: None });
            }
            Some(kind) => mesh.warn(file.clone(), format!(
                "{} is a {kind} light, of which nothing is known here: its light is left out. A point light (`point`) or a \
                 surface that emits would be taken",
                name_of(node)
            )),
        }
    }
    let Some(camera) = node.camera() else { return Ok(()) };
    match camera.projection() {
        Projection::Perspective(lens) if mesh.camera.is_none() => {
            let axis = |axis: DVec3| here.transform_vector3(axis).normalize_or_zero();
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

/// What a light is called that is no point.
fn other(light: &Light<'_>) -> Option<&'static str> {
    match light.kind() {
        Kind::Point => None,
        Kind::Spot { .. } => Some("spot"),
        Kind::Directional => Some("directional"),
    }
}
