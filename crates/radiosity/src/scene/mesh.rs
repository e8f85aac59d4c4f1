//! What any mesh file comes to: groups of polygons and the materials that it names; and surfaces made of them.

use super::Surface;
use super::error::{Error, Place, Problem, listed};
use super::material::Material;
use crate::polygon::Polygon;
use fredholm::value::Rgb;
use std::collections::{BTreeMap, BTreeSet};

/// A mesh in metres, as its reader leaves it.
#[derive(Default)]
pub(super) struct Mesh {
    pub groups: Vec<Group>,
    pub materials: BTreeMap<String, Material>,
}

/// Polygons with one name and one material.
pub(super) struct Group {
    pub name: Option<String>,
    pub material: Option<MaterialName>,
    pub polygons: Vec<Polygon>,
}

/// The name of a material, and where it is called by it.
#[derive(Clone)]
pub(super) struct MaterialName {
    pub name: String,
    pub place: Place,
}

impl Group {
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

/// The surfaces of all meshes, in order, under names that differ; `overrides` go before the meshes' own materials.
pub(super) fn surfaces(
    meshes: Vec<Mesh>,
    overrides: &BTreeMap<String, Material>,
) -> Result<Vec<Surface<Rgb>>, Error> {
    let mut taken = BTreeSet::new();
    let mut surfaces = Vec::new();
    for mesh in meshes {
        let materials = overridden(mesh.materials, overrides);
        let names = surface_names(&mesh.groups);
        for (group, name) in mesh.groups.into_iter().zip(names) {
            let area = group.polygons.iter().map(Polygon::area).sum();
            let (reflectance, emission) = resolve(group.material.as_ref(), area, &materials)?;
            let name = unique(name, &mut taken);
            surfaces.push(Surface { name, reflectance, emission, polygons: group.polygons });
        }
    }
    Ok(surfaces)
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
fn unique(name: String, taken: &mut BTreeSet<String>) -> String {
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
        Group { name: name.map(str::to_owned), material, polygons: Vec::new() }
    }

    fn mesh(groups: Vec<Group>) -> Mesh {
        let materials = groups.iter().filter_map(Group::material_name);
        Mesh { materials: materials.map(|name| (name.to_owned(), Material::default())).collect(), groups }
    }

    #[test]
    fn names_come_from_groups_then_materials_and_differ() {
        let (box_white, box_red) = (group(Some("box"), Some("white")), group(Some("box"), Some("red")));
        let room = vec![group(Some("floor"), Some("white")), box_white, box_red, group(None, Some("red"))];
        let more = vec![group(Some("floor"), None), group(None, None), group(Some("floor.2"), None)];
        let surfaces = surfaces(vec![mesh(room), mesh(more)], &BTreeMap::new()).unwrap();
        let names: Vec<_> = surfaces.iter().map(|surface| surface.name.as_str()).collect();
        assert_eq!(names, ["floor", "box/white", "box/red", "red", "floor.2", "surface", "floor.2.2"]);
    }
}
