//! Occlusion rays a second beside Embree 3: the same triangles, the same segments, by turns in one run, on one thread and on all.
//!
//! `cargo bench -p radiosity --bench occlusion [-- NAME …]`, a scene's name or a part of it. Embree goes its own way in `embree.c`, a
//! program that is compiled here and asked through pipes: no foreign code runs in ours. It needs `cc` and Debian's `libembree-dev`.
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark prints what it measures")]

#[path = "../tests/rooms/mod.rs"]
mod rooms;
mod scenes;

use glam::DVec3;
use radiosity::patches::{Patches, size_for_count};
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, cornell_box};
use radiosity::visibility::Visibility;
use rayon::prelude::*;
use rooms::Random;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

/// Segments of a set.
const SEGMENTS: usize = 1 << 17;

/// Segments between two patches that follow each other in the coherent set: what a form factor casts at most.
const TOGETHER: usize = 64;

/// Turns, of which medians are told.
const TURNS: usize = 7;

/// What is asked of Embree: the name, rays at a time (0 for streams), and whether its scene is robust.
const KINDS: [(&str, u32, u32); 7] = [
    ("1", 1, 0),
    ("1 robust", 1, 1),
    ("8", 8, 0),
    ("8 robust", 8, 1),
    ("16", 16, 0),
    ("16 robust", 16, 1),
    ("streams", 0, 0),
];

type Segment = [DVec3; 2];

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let folder = tempfile::tempdir().unwrap();
    let program = compiled(folder.path());
    if program.is_none() {
        println!("Embree 3 is not installed, or there is no C compiler: our own numbers alone");
    }
    let threads = rayon::current_num_threads();
    println!(
        "10⁶ segments a second; beside Embree's, ours in parts of it; `differ`: hidden for us alone, for Embree alone"
    );
    for name in ["Cornell box", "hall", "terrain 100k", "terrain 1M", "building"] {
        if asked.is_empty() || asked.iter().any(|word| name.contains(word.as_str())) {
            compare(name, program.as_deref().map(|program| (program, folder.path())), threads);
        }
    }
}

/// The C program, if it can be had.
fn compiled(folder: &Path) -> Option<PathBuf> {
    let program = folder.join("embree");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/embree.c");
    let mut cc = Command::new("cc");
    cc.args(["-O3", "-march=native", "-o"]).arg(&program).arg(source).args(["-lembree3", "-lpthread", "-lm"]);
    let built = cc.stderr(Stdio::null()).status().is_ok_and(|status| status.success());
    built.then_some(program)
}

fn compare(name: &str, embree: Option<(&Path, &Path)>, threads: usize) {
    let scene = scene(name);
    let patches = match name {
        // As many polygons as there are triangles, or a patch would be one of them anyway.
        "terrain 100k" | "terrain 1M" => scene.polygons(),
        _ => Patches::new(&scene, size_for_count(&scene, 4000)).unwrap().polygons,
    };
    let polygons = if name == "Cornell box" { patches.clone() } else { scene.polygons() };
    let start = Instant::now();
    let visibility = Visibility::new(&polygons);
    let built = start.elapsed().as_secs_f64();
    let hiding: Vec<[DVec3; 3]> = hiding(&polygons).flat_map(Polygon::triangles).collect();
    println!("\n{name}: {} triangles that can hide something, built in {built:.2} s", hiding.len());
    for (kind, segments) in [("incoherent", apart(&patches)), ("coherent", together(&patches))] {
        let mut other = embree.map(|(program, folder)| Embree::new(program, folder, &hiding, &segments));
        for threads in [1, threads] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            measured(kind, &pool, &visibility, &segments, other.as_mut());
        }
    }
}

fn scene(name: &str) -> Scene<fredholm::value::Rgb> {
    match name {
        "hall" => scenes::boxes(),
        "terrain 100k" => scenes::terrain(100_000),
        "terrain 1M" => scenes::terrain(1_000_000),
        "building" => scenes::building(7, 1),
        _ => cornell_box(),
    }
}

/// The polygons that have something of the scene on both sides.
fn hiding(polygons: &[Polygon]) -> impl Iterator<Item = &Polygon> {
    let corners: Vec<DVec3> =
        polygons.iter().flat_map(|polygon| polygon.vertices().iter().copied()).collect();
    let size = corners.iter().fold(0.0, |size: f64, v| size.max(v.abs().max_element()));
    polygons.iter().filter(move |polygon| {
        let is_beyond = |side: f64, v: &DVec3| side * polygon.height_of(*v) > 1e-9 * size;
        // Corners from all over the scene tell of most.
        let few = corners.iter().step_by(corners.len().div_ceil(1000));
        let beyond = |side: f64| few.clone().chain(&corners).any(|v| is_beyond(side, v));
        beyond(1.0) && beyond(-1.0)
    })
}

/// Two points of two patches that are in front of each other.
fn segment([a, b]: [&Polygon; 2], random: &mut Random) -> Option<Segment> {
    let (s, t) = (random.on(a), random.on(b));
    ((t - s).dot(a.normal()) > 0.0 && (s - t).dot(b.normal()) > 0.0).then_some([s, t])
}

/// Patches chosen by area.
struct Choice<'a>(&'a [Polygon], Vec<f64>);

impl<'a> Choice<'a> {
    fn new(patches: &'a [Polygon]) -> Self {
        let sums = patches.iter().scan(0.0, |sum, patch| {
            *sum += patch.area();
            Some(*sum)
        });
        Self(patches, sums.collect())
    }

    fn pair(&self, random: &mut Random) -> [&'a Polygon; 2] {
        std::array::from_fn(|_| {
            let at = random.number() * self.1[self.1.len() - 1];
            &self.0[self.1.partition_point(|sum| *sum < at).min(self.0.len() - 1)]
        })
    }
}

/// Segments between any two patches.
fn apart(patches: &[Polygon]) -> Vec<Segment> {
    let (choice, mut random) = (Choice::new(patches), Random(1));
    std::iter::repeat_with(|| segment(choice.pair(&mut random), &mut random))
        .flatten()
        .take(SEGMENTS)
        .collect()
}

/// Segments between the same two patches, one after the other, then between two others.
fn together(patches: &[Polygon]) -> Vec<Segment> {
    let (choice, mut random) = (Choice::new(patches), Random(2));
    let mut found = Vec::with_capacity(SEGMENTS);
    while found.len() < SEGMENTS {
        let pair = choice.pair(&mut random);
        let between: Vec<Segment> =
            (0..2 * TOGETHER).filter_map(|_| segment(pair, &mut random)).take(TOGETHER).collect();
        // Pairs that mostly see each other's backs are left out.
        if between.len() == TOGETHER {
            found.extend(between);
        }
    }
    found
}

/// Embree, with a scene and a set of segments.
struct Embree(Child);

impl Embree {
    fn new(program: &Path, folder: &Path, triangles: &[[DVec3; 3]], segments: &[Segment]) -> Self {
        let mut bytes = Vec::new();
        bytes.extend((triangles.len() as u32).to_le_bytes());
        bytes.extend((segments.len() as u32).to_le_bytes());
        let corners = triangles.iter().flatten();
        for point in corners.chain(segments.iter().flatten()) {
            bytes.extend(point.as_vec3().to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
        let file = folder.join("segments");
        std::fs::write(&file, bytes).unwrap();
        let mut command = Command::new(program);
        Self(command.arg(file).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap())
    }

    /// Seconds of a pass, and which segments are hidden.
    fn pass(&mut self, (kind, robust): (u32, u32), threads: usize, hidden: &mut Vec<u8>) -> f64 {
        writeln!(self.0.stdin.as_mut().unwrap(), "{kind} {robust} {threads}").unwrap();
        let answer = self.0.stdout.as_mut().unwrap();
        let mut seconds = [0; 8];
        answer.read_exact(&mut seconds).unwrap();
        hidden.resize(SEGMENTS, 0);
        answer.read_exact(hidden).unwrap();
        f64::from_le_bytes(seconds)
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        drop(self.0.stdin.take());
        // It ends with its input; there is nobody to tell if it does not.
        let _ = self.0.wait();
    }
}

/// How we are asked: segment by segment, or [`TOGETHER`] at once.
const WAYS: [&str; 2] = ["one by one", "together"];

fn measured(
    kind: &str,
    pool: &rayon::ThreadPool,
    visibility: &Visibility,
    segments: &[Segment],
    mut embree: Option<&mut Embree>,
) {
    let mut ours = [Answers::default(), Answers::default()];
    let mut theirs = vec![Answers::default(); KINDS.len()];
    for _ in 0..TURNS {
        for (together, answers) in [false, true].into_iter().zip(&mut ours) {
            answers.hidden.resize(SEGMENTS, 0);
            answers.seconds.push(pass(pool, visibility, segments, together, &mut answers.hidden));
        }
        if let Some(embree) = embree.as_deref_mut() {
            for ((_, rays, robust), answers) in KINDS.iter().zip(&mut theirs) {
                let seconds = embree.pass((*rays, *robust), pool.current_num_threads(), &mut answers.hidden);
                answers.seconds.push(seconds);
            }
        }
    }
    assert!(ours[0].hidden == ours[1].hidden, "answers do not depend on how they are asked for");
    let part = ours[0].hidden.iter().filter(|hidden| **hidden == 1).count() as f64 / SEGMENTS as f64;
    print!("  {kind}, {} threads, {:.0} % hidden:", pool.current_num_threads(), 100.0 * part);
    let rates = ours.each_ref().map(Answers::rate);
    WAYS.iter().zip(rates).for_each(|(way, rate)| print!("  {way} {rate:.2}"));
    println!();
    for ((name, ..), answers) in KINDS.iter().zip(&theirs).filter(|(_, answers)| !answers.seconds.is_empty())
    {
        let alone = |a: &Answers, b: &Answers| {
            a.hidden.iter().zip(&b.hidden).filter(|(a, b)| **a == 1 && **b == 0).count()
        };
        let [one, together] = rates.map(|rate| rate / answers.rate());
        let (mine, its) = (alone(&ours[0], answers), alone(answers, &ours[0]));
        println!(
            "    Embree {name:10} {:>7.2}  {one:>5.2} {together:>5.2}  differ {mine:>5} {its:>5}",
            answers.rate()
        );
    }
}

/// Seconds of each turn, and which segments are hidden.
#[derive(Clone, Default)]
struct Answers {
    seconds: Vec<f64>,
    hidden: Vec<u8>,
}

impl Answers {
    /// 10⁶ segments a second.
    fn rate(&self) -> f64 {
        let mut seconds = self.seconds.clone();
        seconds.sort_by(f64::total_cmp);
        SEGMENTS as f64 / seconds[seconds.len() / 2] / 1e6
    }
}

/// Seconds that all segments take, from when a thread of the pool has woken: Embree's one thread never sleeps either.
fn pass(
    pool: &rayon::ThreadPool,
    visibility: &Visibility,
    segments: &[Segment],
    together: bool,
    hidden: &mut [u8],
) -> f64 {
    pool.install(|| {
        let start = Instant::now();
        hidden.par_chunks_mut(2048).zip(segments.par_chunks(2048)).for_each(|(hidden, segments)| {
            if together {
                let mut clear = Vec::new();
                visibility.unoccluded_each(segments, &mut clear);
                hidden.iter_mut().zip(clear).for_each(|(hidden, clear)| *hidden = u8::from(!clear));
            } else {
                for (hidden, [s, t]) in hidden.iter_mut().zip(segments) {
                    *hidden = u8::from(!visibility.unoccluded(*s, *t));
                }
            }
        });
        start.elapsed().as_secs_f64()
    })
}
