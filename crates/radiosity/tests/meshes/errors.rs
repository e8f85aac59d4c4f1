//! Every mesh file that is refused is refused at the right place, in words that say what is wrong and what to do.

use crate::read;
use crate::write::{binary_stl, cube, ply, triangulated};

/// A file's bytes, where the error lies, what its message holds.
type Case<'a> = (Vec<u8>, &'a str, &'a [&'a str]);

fn check(group: &str, name: &str, cases: &[Case<'_>]) {
    for (index, (bytes, place, words)) in cases.iter().enumerate() {
        let case = format!("{group}{index}");
        let message = match read(&case, name, bytes) {
            Ok(_) => panic!("{case} was accepted"),
            Err(error) => error.to_string().replace(&format!("{}/", crate::folder(&case).display()), ""),
        };
        assert!(message.starts_with(&format!("{place}: ")), "{case} not at {place}: {message}");
        for words in *words {
            assert!(message.contains(words), "{case}, no `{words}` in: {message}");
        }
    }
}

const FACET: &str =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

#[test]
fn ascii_stl() {
    let case = |text: &str| format!("solid a\n{text}").into_bytes();
    let changed = |from: &str, to: &str| case(&format!("{}endsolid\n", FACET.replacen(from, to, 1)));
    check(
        "stl",
        "a.stl",
        &[
            (case("endsolid a"), "a.stl", &["no faces", "export"]),
            (case(""), "a.stl:1", &["ends inside a `solid`", "cut off"]),
            (case("facet\nouter loop\nvertex 1 0 0"), "a.stl:4", &["ends inside a `outer loop`"]),
            (changed("vertex 1 0 0", "vertex 1 0"), "a.stl:5", &["`vertex 1 0`", "three coordinates"]),
            (changed("vertex 1 0 0", "vertex 1 0 x"), "a.stl:5", &["`x` is not a number"]),
            (changed("vertex 1 0 0", "vertex 1 0 nan"), "a.stl:5", &["NaN is not a finite number"]),
            (changed("vertex 1 0 0", "vertex 1 0 1e999"), "a.stl:5", &["inf is not a finite number"]),
            (changed("vertex 1 0 0\n", ""), "a.stl:2", &["3 `vertex` lines", "has 2"]),
            (
                changed("vertex 1 0 0", "vertex 1 0 0\nvertex 1 1 0"),
                "a.stl:2",
                &["3 `vertex` lines", "has 4"],
            ),
            (changed("endloop\n", ""), "a.stl:7", &["`endfacet` stands where", "`endloop` is expected"]),
            (changed("outer loop\n", ""), "a.stl:3", &["`vertex` stands where `outer loop`"]),
            (changed("facet", "fact"), "a.stl:2", &["`fact` stands where `facet` or `endsolid`"]),
            (changed("vertex 1 0 0", "vertex 1e200 0 0"), "a.stl:2", &["across", "check the unit"]),
            (b"solid K\xfcche\nendsolid".to_vec(), "a.stl:1", &["not UTF-8"]),
        ],
    );
}

#[test]
fn binary_stl_files() {
    let whole = binary_stl(&triangulated(&cube()), "solid");
    let changed = |at: usize, bytes: &[u8]| {
        let mut changed = whole.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        changed
    };
    let big_count = changed(80, &12_u32.to_be_bytes());
    check(
        "binary",
        "a.stl",
        &[
            (Vec::new(), "a.stl", &["no STL file", "0 bytes", "84"]),
            (b"PK\x03\x04".to_vec(), "a.stl", &["no STL file", "4 bytes"]),
            (whole[..84].to_vec(), "a.stl", &["count in this header, 12, has 684 bytes", "has 84", "cut"]),
            (whole[..683].to_vec(), "a.stl", &["has 684 bytes, this file has 683"]),
            ([&whole[..], b"xx"].concat(), "a.stl", &["has 684 bytes, this file has 686"]),
            (big_count, "a.stl", &["201326592", "10066329684"]),
            (changed(84 + 50 + 12, &f32::NAN.to_le_bytes()), "a.stl, byte 134", &["NaN is not a finite"]),
            (changed(84 + 20, &f32::INFINITY.to_le_bytes()), "a.stl, byte 84", &["inf is not a finite"]),
            (binary_stl(&crate::write::Mesh { vertices: vec![], faces: vec![] }, ""), "a.stl", &["no faces"]),
        ],
    );
}

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
                      property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const VERTICES: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

#[test]
fn ply_headers() {
    let changed =
        |from: &str, to: &str| format!("{}{VERTICES}4 0 1 2 3\n", HEADER.replacen(from, to, 1)).into_bytes();
    check(
        "header",
        "a.ply",
        &[
            (Vec::new(), "a.ply:1", &["no end", "`end_header`"]),
            (b"\x00\x01\x02".to_vec(), "a.ply:1", &["first line is not `ply`"]),
            (changed("ply", "plz"), "a.ply:1", &["first line is not `ply`"]),
            (HEADER.replace("end_header\n", "").into_bytes(), "a.ply:8", &["no end"]),
            (changed("ascii", "utf8"), "a.ply:2", &["`utf8` is unknown", "binary_big_endian"]),
            (changed("ascii 1.0", "ascii 2.0"), "a.ply:2", &["`format ascii 2.0`", "expected"]),
            (changed("format ascii 1.0\n", ""), "a.ply:8", &["no format"]),
            (changed("vertex 4", "vertex -4"), "a.ply:3", &["`-4`", "how many of `vertex`"]),
            (changed("vertex 4", "vertex 4e0"), "a.ply:3", &["`4e0`", "whole number"]),
            (changed("vertex 4\n", "vertex\n"), "a.ply:3", &["`element vertex`", "expected"]),
            (changed("float x", "half x"), "a.ply:4", &["`half` are unknown", "`float`"]),
            (changed("uchar int", "float int"), "a.ply:8", &["length of a list is a whole number"]),
            (changed("element vertex 4\n", ""), "a.ply:3", &["before the first `element`"]),
            (changed("float y", "float Y"), "a.ply:3", &["no numbers `x`, `y` and `z`"]),
            (changed("vertex_indices", "corners"), "a.ply:7", &["no list `vertex_indices`"]),
            (changed("end_header", "element more 9\nend_header"), "a.ply:10", &["`more` has no properties"]),
            (changed("face 1\n", "faces 1\n"), "a.ply", &["no faces"]),
        ],
    );
}

#[test]
fn ply_bodies() {
    let body = |text: &str| format!("{HEADER}{text}").into_bytes();
    let face = |text: &str| body(&format!("{VERTICES}{text}\n"));
    let whole = ply(&cube(), "binary_little_endian");
    let body_at = whole.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let other_order = String::from_utf8_lossy(&whole[..body_at]).replace("little", "big").into_bytes();
    let camera = format!("a.ply, byte {body_at}");
    let first_face = body_at + 5 + 8 * 17;
    let face_at = format!("a.ply, byte {first_face}");
    // `big` is three letters shorter than `little`.
    let face_in_other_order = format!("a.ply, byte {}", first_face - 3);
    let changed = |at: usize, bytes: &[u8]| {
        let mut changed = whole.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        changed
    };
    check(
        "body",
        "a.ply",
        &[
            (body("0 0 0\n1 0 0\n"), "a.ply:11", &["ends here, in the element `vertex` number 3 of 4"]),
            (body("0 0 0\n1 0\n"), "a.ply:11", &["a `vertex` ends before its z"]),
            (body("0 0 0\n1 0 0 7\n"), "a.ply:11", &["`7` follows the last number of a `vertex`"]),
            (body("0 0 zero\n"), "a.ply:10", &["`zero` is not a number"]),
            (body("0 0 nan\n"), "a.ply:10", &["NaN is not a finite number"]),
            (body("0 0 \u{fc}\n"), "a.ply:10", &["`\u{fc}` is not a number"]),
            (face("4 0 1 2 4"), "a.ply:14", &["vertex 4 does not exist", "4 vertices, counted from 0"]),
            (face("4 0 1 2 -1"), "a.ply:14", &["vertex -1 does not exist"]),
            (face("4 0 1 2 1.5"), "a.ply:14", &["vertex 1.5 does not exist"]),
            (face("4 0 1 2"), "a.ply:14", &["a `face` ends before its vertex_indices"]),
            (face("-4 0 1 2"), "a.ply:14", &["-4 is no length of a list"]),
            (face("2 0 1"), "a.ply:14", &["at least 3 corners"]),
            (face("4 0 1 2 1"), "a.ply:14", &["corners 2 and 4", "same point"]),
            (face("4 0 2 1 3"), "a.ply:14", &["crosses or touches itself"]),
            (whole[..body_at].to_vec(), &camera, &["element `camera` number 1 of 1", "cut off"]),
            (whole[..first_face + 8].to_vec(), &face_at, &["element `face` number 1 of 6"]),
            (
                [&other_order[..], &whole[body_at..]].concat(),
                &face_in_other_order,
                &["vertex 33554432 does not exist"],
            ),
            (changed(first_face + 1, &9_i32.to_le_bytes()), &face_at, &["vertex 9 does not exist"]),
            (changed(first_face, &[255]), &face_at, &["ends here, in the element `face` number 1"]),
        ],
    );
}

const VS3: &str = "F 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 1 1 0\nV 4 0 1 0\nV 5 1 1 1\n";

#[test]
fn vs3() {
    let case = |rest: &str| format!("{VS3}{rest}\n").into_bytes();
    let whole = |text: &str| text.as_bytes().to_vec();
    let two = "S 1 1 2 3 4 0 0 .5 a\n";
    let then = |rest: &str| case(&format!("{two}{rest}"));
    check(
        "vs3-",
        "a.vs3",
        &[
            (whole(""), "a.vs3", &["no faces"]),
            (whole("F 2\n"), "a.vs3:1", &["`F 2` is not read", "`F 3` and `F 3a`"]),
            (whole("f 1\n"), "a.vs3:1", &["`F 1`"]),
            (whole("F\n"), "a.vs3:1", &["`F `"]),
            (whole("F 3\nV 1 0 0\n"), "a.vs3:2", &["3 numbers", "`V # x y z`"]),
            (whole("F 3\nV 1 0 0 0 0\n"), "a.vs3:2", &["5 numbers"]),
            (whole("F 3\nV 1 0 0 inf\n"), "a.vs3:2", &["inf is not a finite number"]),
            (whole("F 3\nV one 0 0 0\n"), "a.vs3:2", &["`one` is not a whole number"]),
            (whole("F 3\nV 0 0 0 0\n"), "a.vs3:2", &["numbered 0", "begin with 1"]),
            (case("V 3 0 0 0"), "a.vs3:7", &["a vertex 3 above"]),
            (case("S 1 1 2 3"), "a.vs3:7", &["4 numbers here", "v1 v2 v3 v4"]),
            (case("S 1 1 2 3 4"), "a.vs3:7", &["surface 1 ends early", "base cmb emit name"]),
            (case("S 1 1 2 3 4 0 0"), "a.vs3:7", &["surface 1 ends early"]),
            (case("S 0 1 2 3 4 0 0 .5 a"), "a.vs3:7", &["numbered 0"]),
            (
                case("S 1 1 2 3 9 0 0 .5 a"),
                "a.vs3:7",
                &["vertex 9, which does not exist", "5 vertices", "`V 9"],
            ),
            (case("S 1 1 2 3 5 0 0 .5 a"), "a.vs3:7", &["not planar"]),
            (case("S 1 1 2 3 1 0 0 .5 a"), "a.vs3:7", &["corners 1 and 4"]),
            (case("S 1 1 2 3 4 0 0 1.5 a"), "a.vs3:7", &["emittance of surface 1 is 1.5", "between 0 and 1"]),
            (case("S 1 1 2 3 4 0 0 nan a"), "a.vs3:7", &["emittance of surface 1 is nan"]),
            (case("M 1 1 2 3 4 0 0 .5 a"), "a.vs3:7", &["masking surface 1 has no base"]),
            (then("M 2 1 2 3 0 1 0 .5 a"), "a.vs3:8", &["masking surface 2 does not face its base 1"]),
            (then("M 2 3 2 1 0 1 1 .5 a"), "a.vs3:8", &["2 and 1 cannot be combined"]),
            (then("O 2 1 2 3 0\nM 3 3 2 1 0 2 0 .5 a"), "a.vs3:9", &["base 2, which does not radiate"]),
            (case("N 1 1 2 3 4 0 0 .5 a"), "a.vs3:7", &["null surface 1 has no base"]),
            (then("S 1 1 2 3 4 0 0 .5 a"), "a.vs3:8", &["a surface 1 above"]),
            (then("S 2 1 2 3 0 7 0 .5 a"), "a.vs3:8", &["the base of surface 2 is 7", "no such surface"]),
            (then("S 2 1 2 3 0 2 0 .5 a"), "a.vs3:8", &["surface 2 cannot have the base 2", "lower number"]),
            (
                then("S 2 1 2 5 0 1 0 .5 a"),
                "a.vs3:8",
                &["surface 2 lies 1.000e0 m off the plane of its base 1"],
            ),
            (then("S 2 3 2 1 0 1 0 .5 a"), "a.vs3:8", &["does not face where its base 1 does", "reverse"]),
            (
                then("N 2 1 2 3 0 1 0 .5 a"),
                "a.vs3:8",
                &["null surface 2 does not face its base 1", "reverse"],
            ),
            (
                then("V 6 2 1 0\nS 2 1 2 6 0 1 0 .5 a"),
                "a.vs3:9",
                &["surface 2 is not within its base 1", "overlaps"],
            ),
            (
                then("S 2 1 2 3 0 1 0 .5 a\nS 3 2 3 4 0 1 0 .5 a"),
                "a.vs3:9",
                &["surface 3 is not within its base 1"],
            ),
            (then("S 2 1 2 3 4 1 0 .5 a"), "a.vs3:7", &["nothing is left of surface 1"]),
            (then("S 2 1 2 3 4 0 9 .5 a"), "a.vs3:8", &["the `cmb` of surface 2 is 9"]),
            (then("S 2 1 2 5 0 0 2 .5 a"), "a.vs3:8", &["combined with 2, which is combined itself"]),
            (
                then("S 2 1 2 5 0 0 1 .5 a\nS 3 2 3 5 0 0 2 .5 a"),
                "a.vs3:9",
                &["combined with 2, which is combined itself", "with one surface"],
            ),
            (then("O 2 1 2 5 0\nS 3 2 3 5 0 0 2 .5 a"), "a.vs3:9", &["3 and 2 cannot be combined"]),
            (then("C row=2"), "a.vs3:8", &["`row=2`", "1 radiate"]),
            (then("C col=1"), "a.vs3:8", &["give the `row`"]),
            (then("C eps=0"), "a.vs3:8", &["`eps=0` is not a positive number"]),
            (then("C encl=yes"), "a.vs3:8", &["`encl=yes` is not a whole number"]),
            (then("C out=3"), "a.vs3:8", &["`out=3`", "0, 1 and 2"]),
            (then("C eps"), "a.vs3:8", &["`eps` has no value"]),
            (whole("F 3a\nS 1 X 0 0 .5 a"), "a.vs3:2", &["`X` is no shape", "R (rectangle)"]),
            (whole("F 3a\nS 1"), "a.vs3:2", &["1 words here"]),
            (
                whole("F 3a\nS 1 R 0 0 .5 a\n0 0 0 0 90 1"),
                "a.vs3:2",
                &["ends before all numbers of surface 1"],
            ),
            (
                whole("F 3a\nS 1 R 0 0 .5 a\n0 0 0 0 90 1\nS 2 R 0 0 .5 a"),
                "a.vs3:4",
                &["`S` stands where surface 1 needs numbers, 7 in all"],
            ),
            (whole("F 3a\nS 1 R 0 0 .5 a\n0 0 0 0 90 1 1 1"), "a.vs3:3", &["8 numbers; its shape takes 7"]),
            (whole("F 3a\nS 1 R 0 0 .5 a\n0 0 0 0 90 1 0"), "a.vs3:2", &["same point"]),
            (b"T K\xfcche\n".to_vec(), "a.vs3:1", &["not UTF-8"]),
        ],
    );
}
