//! Files broken in thousands of ways, the same ones in every run: a reader refuses them with a word on where, or makes
//! polygons of them that are numbers. It never panics, and takes no memory because a header says so.

use crate::folder;
use crate::write::{cube, every_way, triangulated};
use radiosity::polygon::Polygon;
use radiosity::scene::{examine, load_unlit};
use std::path::Path;

/// Numbers as they come, from a seed.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end.max(1)
    }

    fn pick<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.below(of.len())]
    }
}

/// What is written in place of a number.
const NUMBERS: [&[u8]; 14] = [
    b"4294967295",
    b"18446744073709551615",
    b"99999999999999999999",
    b"-1",
    b"0",
    b"nan",
    b"inf",
    b"1e300",
    b"1e-300",
    b"",
    b"\xff",
    b"0x10",
    b"1.5",
    b"2147483648",
];

/// What is written over four bytes: large counts, NaN, infinity, the least number.
const WORDS: [[u8; 4]; 6] =
    [[255; 4], [0, 0, 0, 128], [0, 0, 192, 127], [0, 0, 128, 127], [1, 0, 0, 0], [255, 255, 255, 127]];

const PIECES: [&[u8]; 8] =
    [b"\n", b" ", b"!", b"\0", b"solid\n", b"endsolid\n", b"end_header\n", b"element face 4294967295\n"];

/// Where words and lines lie, and what is between.
fn spans(bytes: &[u8], is_between: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut spans = Vec::new();
    let mut start = 0;
    for part in bytes.split(|&byte| is_between(byte)) {
        if !part.is_empty() {
            spans.push(start..start + part.len());
        }
        start += part.len() + 1;
    }
    spans
}

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    if bytes.is_empty() {
        return;
    }
    let at = random.below(bytes.len());
    match random.below(10) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at] = random.below(256) as u8,
        2 => bytes.truncate(at),
        3 => {
            let end = (at + random.below(40)).min(bytes.len());
            bytes.drain(at..end);
        }
        4 => {
            let end = (at + random.below(200)).min(bytes.len());
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        5 => {
            let end = (at + 4).min(bytes.len());
            let word = WORDS[random.below(WORDS.len())];
            bytes[at..end].copy_from_slice(&word[..end - at]);
        }
        6 => {
            let end = (at + [2, 4, 8][random.below(3)]).min(bytes.len());
            bytes[at..end].reverse();
        }
        7 => {
            let piece = random.pick(&PIECES);
            bytes.splice(at..at, piece.iter().copied());
        }
        8 => {
            let lines = spans(bytes, |byte| byte == b'\n');
            let (from, to) =
                (lines[random.below(lines.len())].clone(), lines[random.below(lines.len())].clone());
            let line = bytes[from].to_vec();
            bytes.splice(to, line);
        }
        _ => {
            let words = spans(bytes, |byte| byte.is_ascii_whitespace());
            let word = words[random.below(words.len())].clone();
            bytes.splice(word, random.pick(&NUMBERS).iter().copied());
        }
    }
}

/// Loads the file; whether it was accepted.
fn accepts(path: &Path, case: &str) -> bool {
    match load_unlit(path) {
        Ok(loaded) => {
            let polygons = loaded.scene.polygons();
            let is_finite = |polygon: &Polygon| {
                let vertices = polygon.vertices().iter().all(|vertex| vertex.is_finite());
                vertices
                    && polygon.normal().is_normalized()
                    && polygon.area() > 0.0
                    && polygon.area().is_finite()
            };
            assert!(polygons.iter().all(is_finite), "{case}");
            let faces: usize = loaded.faces.iter().map(|face| face.polygons.len()).sum();
            assert_eq!(faces, polygons.len(), "{case}");
            let _ = examine(&loaded.scene, &loaded.faces).to_string();
            true
        }
        Err(error) => {
            let message = error.to_string();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            assert!(message.contains(&name), "{case} does not name its file: {message}");
            assert!(message.len() < 600 && !message.contains('\n'), "{case}: {message}");
            false
        }
    }
}

#[test]
fn broken_files_are_refused_or_make_sense() {
    const FILES: usize = 2000;
    let folder = folder("mutations");
    let extra: &[u8] = b"T t\nC eps=1e-4 row=1\nF 3\nV 1 0 0 0\nV 2 4 0 0\nV 3 4 3 0\nV 4 0 3 0\nV 5 1 1 0\nV 6 2 1 0\n\
        V 7 2 2 0\nV 8 1 2 0\nS 1 1 2 3 4 0 0 .5 wall\nS 2 5 6 7 8 1 0 .5 part\nS 3 1 2 3 0 0 1 .5 more\nO 4 5 6 7 8\n";
    let planes: &[u8] =
        b"F 3a\nS 1 R 0 0 .5 a\n0 0 0 0 90 3 3\nS 2 q 0 1 .5 b\n0 0 0 180 0\n0 0 1 0 1 1 0 1\nE\n";
    let mut files = every_way(&cube());
    files.extend(every_way(&triangulated(&cube())));
    files.extend([
        ("normals.obj", crate::normals::obj().into_bytes()),
        ("normals.ply", crate::normals::ply(true)),
    ]);
    let square = crate::gltf::pictured(
        1.0,
        "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}}",
    );
    files.extend([("square.glb", square.glb()), ("square.gltf", square.embedded())]);
    files.extend([("parts.vs3", extra.to_vec()), ("planes.vs3", planes.to_vec())]);
    let (mut accepted, mut random) = (0, Random(1));
    for (kind, (name, bytes)) in files.iter().enumerate() {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        assert!(accepts(&path, name), "{name} is well");
        for number in 0..FILES {
            let mut broken = bytes.clone();
            for _ in 0..1 + random.below(4) {
                mutate(&mut broken, &mut random);
            }
            // A new file: to write over one makes some file systems wait for the disk.
            std::fs::remove_file(&path).unwrap();
            std::fs::write(&path, &broken).unwrap();
            accepted += usize::from(accepts(&path, &format!("{kind} {name} {number}")));
        }
    }
    let all = files.len() * FILES;
    assert!(accepted > all / 50 && accepted < all / 2, "{accepted} of {all}: these mutations test nothing");
}

/// The memory for what a header counts would be thousands of gigabytes: that this returns is the test.
#[test]
fn a_count_in_a_header_is_no_reason_to_take_memory() {
    let folder = folder("counts");
    let count = usize::MAX;
    let faces = format!("element face {count}\nproperty list uint double vertex_indices\nend_header\n");
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let header = format!(
            "ply\nformat {format} 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
        );
        let elsewhere =
            format!("ply\nformat {format} 1.0\nelement other {count}\nproperty list uint char n\n");
        for head in [&header, &elsewhere] {
            let path = folder.join("a.ply");
            std::fs::write(&path, [format!("{head}{faces}").as_bytes(), &[255; 64]].concat()).unwrap();
            assert!(!accepts(&path, format));
        }
    }
    let path = folder.join("a.stl");
    std::fs::write(&path, [[0_u8; 80].as_slice(), &[255; 64]].concat()).unwrap();
    assert!(!accepts(&path, "stl"));
}
