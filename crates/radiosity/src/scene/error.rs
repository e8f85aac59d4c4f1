//! What can be wrong with a scene: where, what, and what to do about it.

use std::fmt;
use std::io;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene that cannot be used: `room.obj:12: vertex 9 does not exist: …`.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct Error {
    /// Where.
    pub place: Place,
    /// What, and what to do.
    pub problem: Problem,
}

/// What does not stop a scene but should be known: `part.stl: 3 faces without area are left out: …`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where.
    pub place: Place,
    /// What, in a sentence.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// A file, and a line or a byte of it where one can be named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, by the path under which it was opened; shared, since each face of a mesh has its place.
    pub file: Arc<Path>,
    /// The line of a text file, counted from 1.
    pub line: Option<usize>,
    /// The byte of a binary file, counted from 0.
    pub byte: Option<usize>,
    /// The triangle of a file that has them in no order of lines or bytes, counted from 1.
    pub triangle: Option<NonZeroUsize>,
}

/// A place in a file that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spot {
    Line(usize),
    Byte(usize),
    Triangle(usize),
}

impl Place {
    pub(super) fn file(file: &Path) -> Self {
        Self { file: file.into(), line: None, byte: None, triangle: None }
    }

    pub(super) fn line(file: &Path, line: usize) -> Self {
        Self { line: Some(line), ..Self::file(file) }
    }

    pub(super) fn spot(file: &Arc<Path>, spot: Spot) -> Self {
        let (line, byte, triangle) = match spot {
            Spot::Line(line) => (Some(line), None, None),
            Spot::Byte(byte) => (None, Some(byte), None),
            Spot::Triangle(triangle) => (None, None, NonZeroUsize::new(triangle)),
        };
        Self { file: Arc::clone(file), line, byte, triangle }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match (self.line, self.byte, self.triangle) {
            (Some(line), ..) => write!(f, ":{line}"),
            (None, Some(byte), _) => write!(f, ", byte {byte}"),
            (None, None, Some(triangle)) => write!(f, ", triangle {triangle}"),
            (None, None, None) => Ok(()),
        }
    }
}

/// What is wrong, whatever the door by which the scene came in.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// A file is missing or may not be read.
    #[error("cannot read `{}`: {reason}; check its name and kind", file.display())]
    Unreadable {
        /// The file that was asked for.
        file: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// No reader for files of this kind.
    #[error(
        "files of the kind `{0}` are not read; scenes are read from .toml and from meshes, and these from .obj, \
         .gltf, .glb, .stl, .ply and .vs3"
    )]
    UnknownFormat(String),
    /// A text file in another encoding, or no text at all.
    #[error("this is not UTF-8 text; save the file as UTF-8 (plain ASCII will do)")]
    NotUtf8,
    /// A statement that cannot be understood; the sentence says what was expected.
    #[error("{0}")]
    Malformed(String),
    /// A vertex index that names no vertex.
    #[error(
        "vertex {index} does not exist: {count} vertices stand above, counted from 1 (or backwards from -1)"
    )]
    Index {
        /// The index in the file.
        index: i64,
        /// How many vertices there are.
        count: usize,
    },
    /// NaN or infinity among the coordinates, or a number too large for a `f64`.
    #[error("the coordinate {0} is not a finite number; repair or re-export the mesh")]
    NotFinite(f64),
    /// A face that is a point or a line.
    #[error("a face needs at least 3 corners, this one has {0}; remove it")]
    TooFewCorners(usize),
    /// A face that would take hours to cut.
    #[error("a face may have {most} corners, this one has {count}; cut it in smaller ones")]
    TooManyCorners {
        /// How many it has.
        count: usize,
        /// How many it may have.
        most: usize,
    },
    /// A face of a size whose square or square root of a product no `f64` holds.
    #[error(
        "the face is {0:e} m across; lengths from 1e-60 m to 1e60 m can be computed with: check the unit"
    )]
    Size(f64),
    /// A face that visits a vertex twice.
    #[error(
        "corners {first} and {second} of the face are the same point; remove one, or cut the face in two there"
    )]
    RepeatedCorner {
        /// The first of the two, counted from 1.
        first: usize,
        /// The second.
        second: usize,
    },
    /// A face without area.
    #[error("the face has no area to speak of: its {0} corners lie on one line; remove it")]
    Degenerate(usize),
    /// A face whose corners lie on no common plane.
    #[error(
        "the face is not planar: a corner is {metres:.3e} m off the plane of the others, {relative:.1e} of the \
         face's size where {tolerated:.0e} is tolerated; triangulate the mesh"
    )]
    NotPlanar {
        /// The largest distance of a corner from the plane, in metres.
        metres: f64,
        /// The same, divided by the largest distance between two corners.
        relative: f64,
        /// What `relative` may be.
        tolerated: f64,
    },
    /// A face whose outline crosses or touches itself.
    #[error(
        "the outline of the face crosses or touches itself: the edges that start at corners {first} and {second} \
         meet; reorder its corners, or cut the face in two"
    )]
    SelfIntersecting {
        /// The corner where the first edge starts, counted from 1.
        first: usize,
        /// The corner where the second edge starts.
        second: usize,
    },
    /// A reflectance with which light would not die out.
    #[error(
        "the reflectance of {owner} is {value} in channel {channel}; it must be at least 0 and less than 1, \
         since a surface returns less light than it gets; give it that of bright paint, 0.85, there or under [materials] \
         in a scene file (.toml)"
    )]
    Reflectance {
        /// The material or the surface.
        owner: String,
        /// The channel, counted from 1.
        channel: usize,
        /// What it is.
        value: f64,
    },
    /// A surface that would swallow light or emit infinitely much.
    #[error(
        "the emission of {owner} is {value} W/m² in channel {channel}; it must be finite and not negative"
    )]
    Emission {
        /// The material or the surface.
        owner: String,
        /// The channel, counted from 1.
        channel: usize,
        /// What it is, as an exitance.
        value: f64,
    },
    /// A light that is nowhere, shines nowhere, or takes light away.
    #[error("light {number}: {what}")]
    Light {
        /// Which one, counted from 1.
        number: usize,
        /// What is wrong, and what to do.
        what: String,
    },
    /// A face of a material that nothing defines.
    #[error(
        "no material is called `{name}`; {known}. Define it in the .mtl file or under [materials] in the .toml"
    )]
    UnknownMaterial {
        /// The name.
        name: String,
        /// What there is instead, as a sentence.
        known: String,
    },
    /// A material that the scene file defines for nothing: most likely a slip of the pen.
    #[error("no face is of the material `{name}`; {known}. Correct the name or remove the entry")]
    UnusedMaterial {
        /// The name.
        name: String,
        /// What there is instead, as a sentence.
        known: String,
    },
    /// A scene without faces.
    #[error("the scene has no faces; export the mesh with its faces, or name other meshes")]
    NoFaces,
    /// A scene in which it is night.
    #[error(
        "no surface emits light and no light shines, so the solution is zero; give a material a `radiance` (.toml) or a `Ke` (.mtl), or \
         name this mesh in a scene file (.toml) under `meshes`, with its `unit` and a [sky], a [sun], a [[light]] or a [[luminaire]]"
    )]
    NoLight,
    /// A surface that exchanges no heat as it is described.
    #[error(transparent)]
    Thermal(#[from] crate::thermal::ThermalError),
    /// A camera at infinity.
    #[error("the camera's position, target and up must be finite numbers")]
    CameraNotFinite,
    /// A camera that looks at itself.
    #[error("the camera looks nowhere: its direction is zero; give a target other than its position")]
    CameraDirection,
    /// A camera that cannot tell what is up.
    #[error("the camera's up is zero or parallel to its line of sight; give another up")]
    CameraUp,
    /// An angle of view that no pinhole has.
    #[error("the camera's vertical angle of view is {0} degrees; it must lie between 0 and 180, 40 is usual")]
    CameraAngle(f64),
}

impl Problem {
    pub(super) fn at(self, place: Place) -> Error {
        Error { place, problem: self }
    }
}

/// "there are `a` and `b`", for messages about a name that is not among these.
pub(super) fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => "there are none".to_owned(),
        [only] => format!("there is only {only}"),
        [most @ .., last] => format!("there are {} and {last}", most.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_listed_as_a_sentence() {
        assert_eq!(listed([].into_iter()), "there are none");
        assert_eq!(listed(["a"].into_iter()), "there is only `a`");
        assert_eq!(listed(["a", "b", "c"].into_iter()), "there are `a`, `b` and `c`");
    }

    #[test]
    fn a_message_begins_with_file_and_line() {
        let error = Problem::TooFewCorners(2).at(Place::line(Path::new("room.obj"), 12));
        assert!(error.to_string().starts_with("room.obj:12: a face needs"));
    }
}
