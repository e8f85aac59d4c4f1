//! Numbers become references: surfaces find their vertices, their bases and what they are combined with.

use super::Vertices;
use super::entry::{Entry, Kind, malformed};
use super::hole::Region;
use crate::polygon::Polygon;
use crate::scene::cut::cut;
use crate::scene::error::{Error, Problem, Spot};
use crate::scene::material::{Located, Material};
use crate::scene::mesh::{Group, MaterialName, Mesh, unique};
use fredholm::value::{Rgb, Value};
use std::collections::{BTreeMap, BTreeSet};

/// How far a subsurface may be off the plane of its base, as a fraction of the base's size: the rounding of
/// coordinates with six digits, with a digit to spare.
const COPLANAR: f64 = 1e-5;

/// The cosine of the angle by which a subsurface may be turned: that of View3D.
const PARALLEL: f64 = 0.999;

/// Where View3D puts an emittance of 0, whose reflections would never die out.
const LEAST_EMITTANCE: f64 = 0.001;

/// Adds the surfaces, sorted by number, to the mesh: a group each.
pub(super) fn link(
    entries: &[Entry],
    vertices: &Vertices,
    metres: f64,
    mesh: &mut Mesh,
) -> Result<(), Error> {
    let (by_number, shapes, parts) = Default::default();
    let mut links = Links { entries, by_number, shapes, parts };
    let at =
        |index: usize, mesh: &Mesh, problem: Problem| problem.at(mesh.place(Spot::Line(entries[index].line)));
    for (index, entry) in entries.iter().enumerate() {
        let shape = entry.corners(vertices, metres).and_then(|corners| cut(&corners));
        links.shapes.push(shape.map_err(|problem| at(index, mesh, problem))?);
        links.number(index).map_err(|problem| at(index, mesh, problem))?;
    }
    // All bases before any is cut: what lies off its base would else be told as not within it.
    for index in 0..entries.len() {
        links.check_base(index).map_err(|problem| at(index, mesh, problem))?;
        if let Some(base) = links.base(index) {
            links.parts.entry(base).or_default().push(index);
        }
    }
    let mut taken = BTreeSet::new();
    for (index, entry) in entries.iter().enumerate() {
        let combined = links.combined(index).map_err(|problem| at(index, mesh, problem))?;
        let polygons = links.without_parts(index).map_err(|(part, problem)| at(part, mesh, problem))?;
        let masked = links.base(index).filter(|_| entry.kind == Kind::Mask);
        add(entry, [combined, masked], polygons, unique(entry.name.clone(), &mut taken), mesh);
    }
    Ok(())
}

/// Adds a surface: a group of one face, of a material of its own.
fn add(
    entry: &Entry,
    [combined, masked]: [Option<usize>; 2],
    polygons: Vec<Polygon>,
    name: String,
    mesh: &mut Mesh,
) {
    let spot = Spot::Line(entry.line);
    mesh.materials.insert(name.clone(), material(entry, mesh));
    let mut group = Group::new(None, Some(MaterialName { name, place: mesh.place(spot) }));
    group.is_obstruction = entry.kind != Kind::Radiating;
    group.masks = masked;
    group.combined_with = combined;
    group.push(polygons, spot);
    mesh.groups.push(group);
    warn_of_white(entry, mesh);
}

/// ρ = 1 − ε; what only blocks is black.
fn material(entry: &Entry, mesh: &Mesh) -> Material {
    let reflectance = match entry.kind {
        Kind::Radiating | Kind::Mask => 1.0 - entry.emittance.max(LEAST_EMITTANCE),
        _ => 0.0,
    };
    let place = mesh.place(Spot::Line(entry.line));
    Material { reflectance: Some(Located { value: Rgb::splat(reflectance), place }), ..Material::default() }
}

fn warn_of_white(entry: &Entry, mesh: &mut Mesh) {
    if matches!(entry.kind, Kind::Radiating | Kind::Mask) && entry.emittance < LEAST_EMITTANCE {
        let (number, emittance) = (entry.number, entry.emittance);
        let message = format!(
            "the emittance {emittance} of surface {number} is replaced by {LEAST_EMITTANCE}, as View3D does"
        );
        mesh.warn(mesh.place(Spot::Line(entry.line)), message);
    }
}

struct Links<'a> {
    entries: &'a [Entry],
    by_number: BTreeMap<i64, usize>,
    /// The polygons of each, whole.
    shapes: Vec<Vec<Polygon>>,
    /// The subsurfaces of each base.
    parts: BTreeMap<usize, Vec<usize>>,
}

impl Links<'_> {
    fn number(&mut self, index: usize) -> Result<(), Problem> {
        let number = self.entries[index].number;
        match self.by_number.insert(number, index) {
            Some(_) => malformed(format!("there is a surface {number} above; give this one another number")),
            None => Ok(()),
        }
    }

    fn named(&self, number: i64, owner: &Entry, role: &str) -> Result<usize, Problem> {
        self.by_number.get(&number).copied().ok_or_else(|| {
            let owner = owner.number;
            Problem::Malformed(format!(
                "the {role} of surface {owner} is {number}, and there is no such surface"
            ))
        })
    }

    /// What the surface is combined with.
    fn combined(&self, index: usize) -> Result<Option<usize>, Problem> {
        let entry = &self.entries[index];
        if entry.combine == 0 || entry.kind == Kind::Obstruction {
            return Ok(None);
        }
        let (number, head) = (entry.number, entry.combine);
        let other = self.named(head, entry, "`cmb`")?;
        if entry.kind != Kind::Radiating || self.entries[other].kind != Kind::Radiating {
            return malformed(format!(
                "surfaces {number} and {head} cannot be combined: both must radiate (`S`)"
            ));
        }
        if other == index || self.entries[other].combine != 0 {
            return malformed(format!(
                "surface {number} is combined with {head}, which is combined itself; combine all with one surface"
            ));
        }
        Ok(Some(other))
    }

    fn base(&self, index: usize) -> Option<usize> {
        let entry = &self.entries[index];
        let has_base = entry.kind != Kind::Obstruction && entry.base != 0;
        has_base.then(|| self.by_number.get(&entry.base).copied())?
    }

    /// That a subsurface lies in the plane of its base and faces as it should. Bases come before their subsurfaces,
    /// so that none is its own.
    fn check_base(&self, index: usize) -> Result<(), Problem> {
        let entry = &self.entries[index];
        let (number, base) = (entry.number, entry.base);
        let role = if entry.kind == Kind::Mask { "masking" } else { "null" };
        if matches!(entry.kind, Kind::Null | Kind::Mask) && base == 0 {
            return malformed(format!(
                "{role} surface {number} has no base; give the surface that it is a part of"
            ));
        }
        if entry.kind == Kind::Obstruction || base == 0 {
            return Ok(());
        }
        let under = self.named(base, entry, "base")?;
        let kind = self.entries[under].kind;
        if entry.kind == Kind::Mask && kind != Kind::Radiating {
            return malformed(format!(
                "masking surface {number} cannot have the base {base}, which does not radiate: give a surface (`S`)"
            ));
        }
        if matches!(kind, Kind::Null | Kind::Mask) || (kind == Kind::Radiating && under >= index) {
            return malformed(format!(
                "surface {number} cannot have the base {base}: a base radiates (`S`) and has a lower number, or is an \
                 obstruction (`O`)"
            ));
        }
        let (shape, ground) = (&self.shapes[index], &self.shapes[under]);
        let size = ground.iter().map(Polygon::diameter).fold(0.0, f64::max);
        let vertices = shape.iter().flat_map(Polygon::vertices);
        let off = vertices.map(|&vertex| ground[0].height_of(vertex).abs()).fold(0.0, f64::max);
        if off > COPLANAR * size {
            return malformed(format!(
                "surface {number} lies {off:.3e} m off the plane of its base {base}; move it"
            ));
        }
        let cosine = shape[0].normal().dot(ground[0].normal());
        match entry.kind {
            Kind::Null | Kind::Mask if cosine > -PARALLEL => malformed(format!(
                "{role} surface {number} does not face its base {base}; reverse the order of its vertices"
            )),
            Kind::Radiating if cosine < PARALLEL => malformed(format!(
                "surface {number} does not face where its base {base} does; reverse the order of its vertices"
            )),
            _ => Ok(()),
        }
    }

    /// The polygons of a surface without its subsurfaces; an error is of one of these.
    fn without_parts(&self, index: usize) -> Result<Vec<Polygon>, (usize, Problem)> {
        let Some(parts) = self.parts.get(&index) else { return Ok(self.shapes[index].clone()) };
        let mut region = Region::new(&self.shapes[index]);
        for &part in parts {
            if !region.cut_out(&self.shapes[part]) {
                let problem = Problem::Malformed(format!(
                    "surface {} is not within its base {}, or overlaps another part of that; correct one of them",
                    self.entries[part].number, self.entries[index].number
                ));
                return Err((part, problem));
            }
        }
        let polygons = region.polygons();
        if polygons.is_empty() {
            let problem = Problem::Malformed(format!(
                "nothing is left of surface {} beside its subsurfaces; remove it, and their bases",
                self.entries[index].number
            ));
            return Err((index, problem));
        }
        Ok(polygons)
    }
}
