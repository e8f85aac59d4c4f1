//! What any mesh file comes to: groups of faces and the materials that it names; and surfaces made of them.

use super::cut::cut;
use super::error::{Error, Place, Problem, Spot, Warning, listed};
use super::face::{self, Face};
use super::material::Material;
use super::normals::{self, LeftFlat};
use super::vs3::Control;
use super::{Camera, Light, Surface};
use crate::polygon::Polygon;
use fredholm::value::Rgb;
use glam::DVec3;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A mesh in metres, as its reader leaves it.
pub(super) struct Mesh {
    pub file: Arc<Path>,
    /// What the file calls itself.
    pub title: Option<String>,
    pub groups: Vec<Group>,
    pub materials: BTreeMap<String, Material>,
    pub warnings: Vec<Warning>,
    pub control: Option<Control>,
    /// Lights and a camera that the file has beside its faces.
    pub lights: Vec<Light<Rgb>>,
    pub camera: Option<Camera>,
    /// Faces whose corners were turned round, since their node mirrors.
    pub turned_round: usize,
    left_out: LeftOut,
    left_flat: LeftFlat,
    drawn_flat: usize,
}

/// Faces with one name and one material.
pub(super) struct Group {
    pub name: Option<String>,
    pub material: Option<MaterialName>,
    /// What holds in place of the material of that name, where faces of one material differ.
    pub paint: Option<Material>,
    pub polygons: Vec<Polygon>,
    /// For each face the number of polygons up to its end, and where it stands.
    faces: Vec<(usize, Spot)>,
    pub is_obstruction: bool,
    /// Another group, by its number in the mesh, upon a part of which this lies; both are of one face.
    pub masks: Option<usize>,
    /// Another group, by its number in the mesh; both are of one face.
    pub combined_with: Option<usize>,
}

/// Faces without area.
#[derive(Default)]
struct LeftOut {
    count: usize,
    first: Option<Spot>,
}

impl Mesh {
    pub fn new(file: &Path) -> Self {
        let (title, groups, materials, warnings, control) = Default::default();
        let (lights, camera, turned_round, left_out, left_flat) = Default::default();
        Self {
            file: file.into(),
            title,
            groups,
            materials,
            warnings,
            control,
            lights,
            camera,
            turned_round,
            left_out,
            left_flat,
            drawn_flat: 0,
        }
    }

    /// Begins a group of a format without materials: a scene file can give it one by the group's name.
    pub fn begin(&mut self, name: &str) {
        let material = MaterialName { name: name.to_owned(), place: Place::file(&self.file) };
        self.materials.entry(name.to_owned()).or_default();
        self.groups.push(Group::new(None, Some(material)));
    }

    /// Adds a face of a file that only programs write, to the last group. Such files are full of triangles without
    /// area, which neither emit nor hide anything: they are counted and left out. `normals` are those of its corners.
    pub fn push_exported(
        &mut self,
        corners: &[DVec3],
        normals: &[Option<DVec3>],
        spot: Spot,
    ) -> Result<(), Error> {
        match self.groups.len().checked_sub(1) {
            Some(last) => self.push_exported_to(last, corners, normals, spot),
            None => Ok(()),
        }
    }

    /// The same to the group of a number.
    pub fn push_exported_to(
        &mut self,
        group: usize,
        corners: &[DVec3],
        normals: &[Option<DVec3>],
        spot: Spot,
    ) -> Result<(), Error> {
        match cut(corners) {
            Ok(polygons) => self.push(group, polygons, (corners, normals), spot),
            Err(problem) if is_without_area(&problem, corners.len()) => {
                self.left_out.count += 1;
                self.left_out.first.get_or_insert(spot);
            }
            Err(problem) => return Err(problem.at(self.place(spot))),
        }
        Ok(())
    }

    /// Adds a face to the group of a number, in the polygons that it was cut in, which get the normals of its corners.
    pub fn push(
        &mut self,
        group: usize,
        polygons: Vec<Polygon>,
        (corners, normals): (&[DVec3], &[Option<DVec3>]),
        spot: Spot,
    ) {
        let (polygons, fault) = normals::curved(polygons, corners, normals);
        if let Some(fault) = fault {
            self.left_flat.add(fault, spot);
        }
        self.groups[group].push(polygons, spot);
    }

    pub fn place(&self, spot: Spot) -> Place {
        Place::spot(&self.file, spot)
    }

    /// What was done to the mesh on the way.
    pub fn clean_up(&self) -> CleanUp {
        CleanUp {
            faces_without_area_left_out: self.left_out.count,
            faces_turned_round: self.turned_round,
            faces_drawn_flat: self.drawn_flat,
        }
    }

    pub fn warn(&mut self, place: Place, message: String) {
        self.warnings.push(Warning { place, message });
    }

    /// The mesh, once all is read: without groups that have no face, and with a word on what was left out or stays flat.
    pub fn finished(mut self) -> Self {
        self.groups.retain(|group| !group.faces.is_empty());
        let left_flat = std::mem::take(&mut self.left_flat);
        self.drawn_flat = left_flat.count();
        for (spot, message) in left_flat.told() {
            self.warn(self.place(spot), message);
        }
        if let LeftOut { count, first: Some(first) } = self.left_out {
            let (faces, are) = if count == 1 { ("face", "is") } else { ("faces", "are") };
            let message = format!(
                "{count} {faces} without area {are} left out, the first here: its corners are one point or lie on \
                 one line. Nothing is lost unless the mesh should be closed there"
            );
            self.warn(self.place(first), message);
        }
        self
    }
}

/// In a triangle with two corners in one point, or with all on one line. More corners may still have area.
fn is_without_area(problem: &Problem, corners: usize) -> bool {
    match problem {
        Problem::Degenerate(_) => true,
        Problem::RepeatedCorner { .. } => corners == 3,
        _ => false,
    }
}

/// The name of a material, and where it is called by it.
#[derive(Clone)]
pub(super) struct MaterialName {
    pub name: String,
    pub place: Place,
}

impl Group {
    pub fn new(name: Option<String>, material: Option<MaterialName>) -> Self {
        let (paint, polygons, faces, is_obstruction, masks, combined_with) = Default::default();
        Self { name, material, paint, polygons, faces, is_obstruction, masks, combined_with }
    }

    /// Adds a face, in its polygons.
    pub fn push(&mut self, polygons: impl IntoIterator<Item = Polygon>, spot: Spot) {
        self.polygons.extend(polygons);
        self.faces.push((self.polygons.len(), spot));
    }

    /// The polygons of each face, in the group's numbers, and where it stands.
    fn ranges(&self) -> impl Iterator<Item = (Range<usize>, Spot)> {
        let starts = std::iter::once(0).chain(self.faces.iter().map(|&(end, _)| end));
        starts.zip(&self.faces).map(|(start, &(end, spot))| (start..end, spot))
    }

    fn material_name(&self) -> Option<&str> {
        self.material.as_ref().map(|material| material.name.as_str())
    }

    /// The group's own name; with its material behind it where one object is of several.
    fn surface_name(&self, is_shared: bool) -> String {
        match (self.name.as_deref(), self.material_name()) {
            (Some(name), Some(material)) if is_shared => format!("{name}/{material}"),
            (Some(name), _) | (None, Some(name)) => name.to_owned(),
            (None, None) => "surface".to_owned(),
        }
    }
}

/// What readers do to the faces of meshes on the way. No vertex is moved or welded to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CleanUp {
    /// Faces without area, which are left out.
    pub faces_without_area_left_out: usize,
    /// Faces whose corners are turned round, since the transform of their node mirrors.
    pub faces_turned_round: usize,
    /// Faces that are drawn flat, since something is wrong with the normals of their corners.
    pub faces_drawn_flat: usize,
}

impl CleanUp {
    fn add(&mut self, other: Self) {
        self.faces_without_area_left_out += other.faces_without_area_left_out;
        self.faces_turned_round += other.faces_turned_round;
        self.faces_drawn_flat += other.faces_drawn_flat;
    }
}

/// What all meshes of a scene come to.
#[derive(Default)]
pub(super) struct Assembled {
    pub surfaces: Vec<Surface<Rgb>>,
    pub faces: Vec<Face>,
    pub warnings: Vec<Warning>,
    pub clean_up: CleanUp,
}

/// The surfaces of all meshes, in order, under names that differ; `overrides` go before the meshes' own materials.
pub(super) fn assemble(
    meshes: Vec<Mesh>,
    overrides: &BTreeMap<String, Material>,
) -> Result<Assembled, Error> {
    let (mut taken, mut polygons) = (BTreeSet::new(), 0);
    let mut assembled = Assembled::default();
    for mesh in meshes {
        assembled.clean_up.add(mesh.clean_up());
        let materials = overridden(mesh.materials, overrides);
        let names = surface_names(&mesh.groups);
        let first_face = assembled.faces.len();
        for (group, name) in mesh.groups.into_iter().zip(names) {
            let area = group.polygons.iter().map(Polygon::area).sum();
            let (reflectance, emission) = match &group.paint {
                Some(paint) => {
                    let name = group.material_name().unwrap_or_default();
                    let over =
                        overrides.get(name).map_or_else(|| paint.clone(), |over| paint.overridden_by(over));
                    over.resolve(name, area)?
                }
                None => resolve(group.material.as_ref(), area, &materials)?,
            };
            let name = unique(name, &mut taken);
            let surface = assembled.surfaces.len();
            assembled.faces.extend(group.ranges().enumerate().map(|(number, (range, spot))| Face {
                name: face::numbered(&name, number, group.faces.len()),
                surface,
                polygons: polygons + range.start..polygons + range.end,
                place: Some(Place::spot(&mesh.file, spot)),
                is_obstruction: group.is_obstruction,
                masks: group.masks.map(|other| first_face + other),
                combined_with: group.combined_with.map(|other| first_face + other),
            }));
            polygons += group.polygons.len();
            assembled.surfaces.push(Surface { name, reflectance, emission, polygons: group.polygons });
        }
        assembled.warnings.extend(mesh.warnings);
    }
    Ok(assembled)
}

/// The groups of all meshes, in order, under names that differ.
pub(super) fn named(meshes: Vec<Mesh>) -> Vec<(String, Group)> {
    let mut taken = BTreeSet::new();
    let mut named = Vec::new();
    for mesh in meshes {
        let names = surface_names(&mesh.groups);
        named.extend(
            mesh.groups.into_iter().zip(names).map(|(group, name)| (unique(name, &mut taken), group)),
        );
    }
    named
}

/// That every override is of a material that some face is of.
pub(super) fn check_overrides_are_used<'a>(
    meshes: &[Mesh],
    overrides: impl Iterator<Item = (&'a str, Place)>,
) -> Result<(), Error> {
    let groups = || meshes.iter().flat_map(|mesh| &mesh.groups);
    let used: BTreeSet<&str> = groups().filter_map(Group::material_name).collect();
    for (name, place) in overrides {
        if !used.contains(name) {
            let known = listed(used.iter().copied());
            return Err(Problem::UnusedMaterial { name: name.to_owned(), known }.at(place));
        }
    }
    Ok(())
}

fn overridden(
    mut materials: BTreeMap<String, Material>,
    overrides: &BTreeMap<String, Material>,
) -> BTreeMap<String, Material> {
    for (name, over) in overrides {
        let material = materials.entry(name.clone()).or_default();
        *material = material.overridden_by(over);
    }
    materials
}

fn resolve(
    name: Option<&MaterialName>,
    area: f64,
    materials: &BTreeMap<String, Material>,
) -> Result<(Rgb, Rgb), Error> {
    let Some(MaterialName { name, place }) = name else {
        return Material::default().resolve("none", area);
    };
    match materials.get(name) {
        Some(material) => material.resolve(name, area),
        None => {
            let known = listed(materials.keys().map(String::as_str));
            Err(Problem::UnknownMaterial { name: name.clone(), known }.at(place.clone()))
        }
    }
}

fn surface_names(groups: &[Group]) -> Vec<String> {
    let mut count = BTreeMap::new();
    for group in groups {
        *count.entry(group.name.as_deref()).or_insert(0) += 1;
    }
    groups.iter().map(|group| group.surface_name(count[&group.name.as_deref()] > 1)).collect()
}

/// `name`, or the first of `name.2`, `name.3`, … that is free.
pub(super) fn unique(name: String, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|number| format!("{name}.{number}"));
    let free =
        std::iter::once(name.clone()).chain(numbered).find(|name| !taken.contains(name)).unwrap_or(name);
    taken.insert(free.clone());
    free
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn group(name: Option<&str>, material: Option<&str>) -> Group {
        let place = Place::file(Path::new("a.obj"));
        let material = material.map(|name| MaterialName { name: name.to_owned(), place });
        Group::new(name.map(str::to_owned), material)
    }

    fn mesh(groups: Vec<Group>) -> Mesh {
        let materials = groups.iter().filter_map(Group::material_name);
        let materials = materials.map(|name| (name.to_owned(), Material::default())).collect();
        Mesh { materials, groups, ..Mesh::new(Path::new("a.obj")) }
    }

    #[test]
    fn names_come_from_groups_then_materials_and_differ() {
        let (box_white, box_red) = (group(Some("box"), Some("white")), group(Some("box"), Some("red")));
        let room = vec![group(Some("floor"), Some("white")), box_white, box_red, group(None, Some("red"))];
        let more = vec![group(Some("floor"), None), group(None, None), group(Some("floor.2"), None)];
        let surfaces = assemble(vec![mesh(room), mesh(more)], &BTreeMap::new()).unwrap().surfaces;
        let names: Vec<_> = surfaces.iter().map(|surface| surface.name.as_str()).collect();
        assert_eq!(names, ["floor", "box/white", "box/red", "red", "floor.2", "surface", "floor.2.2"]);
    }
}
