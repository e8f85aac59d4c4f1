//! The glTF reader (2.0, `.gltf` and `.glb`): the triangles of all nodes of a scene, x = M_node v, with materials, lights
//! and a camera.
//!
//! | in the file | here |
//! |---|---|
//! | triangles, strips, fans | faces; points and lines are passed over |
//! | a node's transform | applied, to normals M⁻ᵀ n; one that mirrors turns the corners round, so that fronts stay fronts |
//! | base colour, its texture, vertex colours | reflectance = base (1 − metallic): metal reflects no light diffusely |
//! | emissive factor × texture × strength | the radiance L, so that E = π L: in cd/m² of a photometric scene, else in W/(m² sr) |
//! | a texture | its mean over each triangle; triangles with means that differ by more than a 512th are surfaces of their own |
//! | `KHR_lights_punctual` | points and spots of that intensity, in cd or W/sr, and directional lights as suns, in lx or W/m²; a `range` is passed over |
//! | the first perspective camera | the scene's |
//!
//! Double-sided materials reflect on the front alone, and all of them are opaque; that and all else which is passed over is
//! told. The reader of the JSON is the crate `gltf`; numbers are read here, since of damaged files it panics.

mod accessor;
mod bytes;
mod document;
mod lights;
mod material;
mod primitive;
mod texture;

use super::error::{Error, Place, Problem};
use super::mesh::Mesh;
use super::text;
use ::gltf::scene::Transform;
use ::gltf::{Document, Node};
use bytes::Data;
use glam::{DMat4, DQuat, DVec3};
use material::Paints;
use std::path::Path;

/// What is known of the extensions of the format; of others a word is said.
const KNOWN: [&str; 4] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_texture_transform",
];

/// The mesh of a file whose unit of length is so many `metres`; `named_at` is where the file's name stands.
pub(super) fn read(file: &Path, metres: f64, named_at: &Place) -> Result<Mesh, Error> {
    let bytes = text::bytes(file, named_at)?;
    let mut mesh = Mesh::new(file);
    let at = |problem: Problem| problem.at(Place::file(file));
    let (document, binary) = document::parsed(&bytes).map_err(at)?;
    let data = Data::new(file, &document, binary).map_err(at)?;
    let paints = Paints::new(&document, &data, &mut mesh).map_err(at)?;
    let mut reader = Reader { data: &data, paints, metres, mesh, triangles: 0, mirrored: 0 };
    reader.walk(&document)?;
    Ok(reader.finished(&document))
}

fn malformed(message: String) -> Problem {
    Problem::Malformed(message)
}

/// Goes from node to node.
struct Reader<'a> {
    data: &'a Data,
    paints: Paints,
    metres: f64,
    mesh: Mesh,
    /// Triangles so far: they are what faces are numbered by.
    triangles: usize,
    /// Nodes with a mesh whose transforms mirror.
    mirrored: usize,
}

impl Reader<'_> {
    fn walk(&mut self, document: &Document) -> Result<(), Error> {
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let roots: Vec<Node<'_>> = match scene {
            Some(scene) => scene.nodes().collect(),
            None => document.nodes().collect(),
        };
        let mut waiting: Vec<(Node<'_>, DMat4)> = roots
            .into_iter()
            .rev()
            .map(|node| (node, DMat4::from_scale(DVec3::splat(self.metres))))
            .collect();
        let mut seen = vec![false; document.nodes().len()];
        while let Some((node, above)) = waiting.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                let message = format!("{} is reached in two ways; make the nodes a tree", name_of(&node));
                return Err(malformed(message).at(self.file()));
            }
            let here = above * transform(&node).map_err(|problem| problem.at(self.file()))?;
            self.take(&node, here)?;
            waiting.extend(node.children().map(|child| (child, here)).collect::<Vec<_>>().into_iter().rev());
        }
        Ok(())
    }

    fn take(&mut self, node: &Node<'_>, here: DMat4) -> Result<(), Error> {
        if !here.is_finite() {
            let message = format!("the transform of {} is not finite; export the scene again", name_of(node));
            return Err(malformed(message).at(self.file()));
        }
        if let Some(mesh) = node.mesh() {
            let before = self.triangles;
            let mirrors = here.determinant() < 0.0;
            for primitive in mesh.primitives() {
                self.take_primitive(node, &mesh, &primitive, here)?;
            }
            if mirrors {
                self.mirrored += 1;
                self.mesh.turned_round += self.triangles - before;
            }
        }
        lights::take(node, here, &mut self.mesh).map_err(|problem| problem.at(self.file()))
    }

    fn file(&self) -> Place {
        Place::file(&self.mesh.file)
    }

    /// The mesh, with a word on what was passed over.
    fn finished(mut self, document: &Document) -> Mesh {
        let file = self.file();
        self.paints.tell_white(&mut self.mesh);
        let mut tell = |message: String| self.mesh.warn(file.clone(), message);
        if document.scenes().len() > 1 {
            tell(format!("one of {} scenes is read, the default one", document.scenes().len()));
        }
        let json = document.as_json();
        let unknown = json.extensions_used.iter().filter(|name| !KNOWN.contains(&name.as_str()));
        for name in unknown {
            let name: String = name.chars().filter(|c| !c.is_control()).take(60).collect();
            tell(format!("the extension `{name}` is passed over"));
        }
        if !json.animations.is_empty() || !json.skins.is_empty() {
            tell("animations and skins are passed over: all stands as it is stored".to_owned());
        }
        if self.mirrored > 0 {
            let message = format!(
                "{} mirrored node{}: the corners of their faces are turned round, so that fronts stay fronts",
                self.mirrored,
                if self.mirrored == 1 { "" } else { "s" }
            );
            self.mesh.warn(file, message);
        }
        self.mesh.finished()
    }
}

/// The name of a node as messages have it.
fn name_of(node: &Node<'_>) -> String {
    let name: String = node.name().unwrap_or("").chars().filter(|c| !c.is_control()).take(60).collect();
    if name.is_empty() { format!("node {}", node.index()) } else { format!("the node `{name}`") }
}

/// The transform of a node beside its parent's.
fn transform(node: &Node<'_>) -> Result<DMat4, Problem> {
    match node.transform() {
        Transform::Matrix { matrix } => {
            Ok(DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))))
        }
        Transform::Decomposed { translation, rotation, scale } => {
            let turn = DQuat::from_array(rotation.map(f64::from));
            if turn.length() == 0.0 || !turn.is_finite() {
                return Err(malformed(format!(
                    "the rotation of {} is none; give a unit quaternion",
                    name_of(node)
                )));
            }
            let [scale, translation] = [scale, translation].map(|v| DVec3::from(v.map(f64::from)));
            Ok(DMat4::from_scale_rotation_translation(scale, turn.normalize(), translation))
        }
    }
}
