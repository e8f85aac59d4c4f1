//! Triangles of a primitive, (i, j, k) of its vertices, as the faces of a surface or, where textures paint them, of several.

use super::bytes::Data;
use super::material::{Paint, Vertex};
use super::{Reader, accessor, malformed};
use crate::scene::error::{Error, Place, Problem, Spot};
use crate::scene::mesh::{Group, MaterialName};
use ::gltf::mesh::Mode;
use ::gltf::{Mesh, Node, Primitive, Semantic};
use glam::{DMat3, DMat4, DVec3};
use std::collections::HashMap;

impl Reader<'_> {
    pub(super) fn take_primitive(
        &mut self,
        node: &Node<'_>,
        of: &Mesh<'_>,
        primitive: &Primitive<'_>,
        here: DMat4,
    ) -> Result<(), Error> {
        let name =
            node.name().or_else(|| of.name()).map_or_else(|| format!("node-{}", node.index()), str::to_owned);
        let owner = format!("primitive {} of mesh {}", primitive.index(), of.index());
        let file = self.file();
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.mesh
                .warn(file, format!("{owner} has no triangles but points or lines, which are passed over"));
            return Ok(());
        }
        if primitive.morph_targets().len() > 0 {
            self.mesh.warn(file.clone(), format!("{owner} has morph targets, which are passed over"));
        }
        let at = |problem: Problem| problem.at(file.clone());
        let paint = self.paints.of(&primitive.material());
        let vertices = Vertices::read(self.data, primitive, &paint, &owner).map_err(at)?;
        let triangles = vertices.triangles(primitive.mode(), &owner).map_err(at)?;
        self.add(&name, &paint, &vertices, &triangles, here)
    }

    fn add(
        &mut self,
        name: &str,
        paint: &Paint,
        vertices: &Vertices,
        triangles: &[[usize; 3]],
        here: DMat4,
    ) -> Result<(), Error> {
        let placed: Vec<DVec3> = vertices.positions.iter().map(|v| here.transform_point3(*v)).collect();
        let across = DMat3::from_mat4(here).inverse().transpose();
        let normals: Vec<DVec3> = vertices.normals.iter().map(|n| across * *n).collect();
        let mirrors = here.determinant() < 0.0;
        let material =
            paint.name.as_ref().map(|name| MaterialName { name: name.clone(), place: self.file() });
        let varies = paint.varies(vertices.colours.is_some());
        if !varies {
            paint.used_as_it_is();
        }
        let mut groups = HashMap::new();
        for &[i, j, k] in triangles {
            let corners = if mirrors { [i, k, j] } else { [i, j, k] };
            self.triangles += 1;
            let spot = Spot::Triangle(self.triangles);
            let painted = if varies {
                let at = |problem: Problem| problem.at(Place::spot(&self.mesh.file, spot));
                Some(paint.of_triangle(&corners.map(|k| vertices.vertex(k)), &self.mesh.file).map_err(at)?)
            } else {
                None
            };
            let key = painted.as_ref().map(|(key, _)| *key);
            let count = groups.len();
            let group = *groups.entry(key).or_insert_with(|| {
                let name = if count == 0 { name.to_owned() } else { format!("{name}~{}", count + 1) };
                let mut group = Group::new(Some(name), material.clone());
                group.paint = painted.map(|(_, paint)| paint);
                self.mesh.groups.push(group);
                self.mesh.groups.len() - 1
            });
            let normals = corners.map(|k| normals.get(k).copied());
            self.mesh.push_exported_to(group, &corners.map(|k| placed[k]), &normals, spot)?;
        }
        Ok(())
    }
}

/// The vertices of a primitive, and the numbers of those that its triangles have in turn.
pub(super) struct Vertices {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    colours: Option<Vec<[f64; 3]>>,
    /// Of each texture that paints.
    places: [Option<Vec<[f64; 2]>>; 3],
    indices: Vec<usize>,
}

impl Vertices {
    fn read(data: &Data, primitive: &Primitive<'_>, paint: &Paint, owner: &str) -> Result<Self, Problem> {
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Err(malformed(format!(
                "{owner} has no positions; export the scene again, without compression"
            )));
        };
        let vectors = |items: Vec<[f64; 3]>| items.into_iter().map(DVec3::from).collect::<Vec<_>>();
        let positions = vectors(accessor::read(data, &positions)?);
        let normals =
            primitive.get(&Semantic::Normals).map(|normals| accessor::read(data, &normals)).transpose()?;
        let colours =
            primitive.get(&Semantic::Colors(0)).map(|colours| match colours.dimensions().multiplicity() {
                4 => Ok(accessor::read::<4>(data, &colours)?
                    .into_iter()
                    .map(|[r, g, b, _]| [r, g, b])
                    .collect()),
                _ => accessor::read::<3>(data, &colours),
            });
        let mut places = [None, None, None];
        for (place, set) in places.iter_mut().zip(paint.sets()) {
            let Some(set) = set else { continue };
            let Some(found) = primitive.get(&Semantic::TexCoords(set)) else {
                return Err(malformed(format!(
                    "{owner} has a texture and no coordinates `TEXCOORD_{set}` for it; export the scene with them"
                )));
            };
            *place = Some(accessor::read(data, &found)?);
        }
        let indices = match primitive.indices() {
            Some(indices) => {
                accessor::read(data, &indices)?.into_iter().map(|[index]: [f64; 1]| index as usize).collect()
            }
            None => (0..positions.len()).collect(),
        };
        let vertices = Self {
            positions,
            normals: vectors(normals.unwrap_or_default()),
            colours: colours.transpose()?,
            places,
            indices,
        };
        vertices.check(owner)?;
        Ok(vertices)
    }

    /// That there is all of each vertex that is named.
    fn check(&self, owner: &str) -> Result<(), Problem> {
        let count = self.positions.len();
        if let Some(index) = self.indices.iter().find(|&&index| index >= count) {
            return Err(malformed(format!(
                "{owner} names vertex {index}, which does not exist: there are {count}, counted from 0"
            )));
        }
        let fewer = |what: &str, number: usize| {
            malformed(format!("{owner} has {number} {what} for {count} vertices; export the scene again"))
        };
        let colours = self.colours.as_ref().map_or(count, Vec::len);
        let places = self.places.iter().flatten().map(Vec::len).min().unwrap_or(count);
        match (self.normals.len(), colours, places) {
            (normals, ..) if normals != 0 && normals < count => Err(fewer("normals", normals)),
            (_, colours, _) if colours < count => Err(fewer("colours", colours)),
            (.., places) if places < count => Err(fewer("texture coordinates", places)),
            _ => Ok(()),
        }
    }

    /// The vertices of each triangle, counter-clockwise.
    fn triangles(&self, mode: Mode, owner: &str) -> Result<Vec<[usize; 3]>, Problem> {
        let indices = &self.indices;
        Ok(match mode {
            // Every other triangle of a strip runs the other way round.
            Mode::TriangleStrip => {
                let turned = |(k, t): (usize, &[usize])| {
                    if k % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] }
                };
                indices.windows(3).enumerate().map(turned).collect()
            }
            Mode::TriangleFan => {
                let centre = indices.first().copied().unwrap_or(0);
                indices.windows(2).skip(1).map(|edge| [edge[0], edge[1], centre]).collect()
            }
            _ if !indices.len().is_multiple_of(3) => {
                return Err(malformed(format!(
                    "{owner} has {} corners, which is no whole number of triangles; export the scene again",
                    indices.len()
                )));
            }
            _ => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        })
    }

    fn vertex(&self, k: usize) -> Vertex {
        Vertex {
            colour: self.colours.as_ref().map_or([1.0; 3], |colours| colours[k]),
            places: [0, 1, 2].map(|t| self.places[t].as_ref().map_or([0.0; 2], |places| places[k])),
        }
    }
}
