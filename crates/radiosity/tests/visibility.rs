//! Visibility against brute force, scale, watertightness, and the certificates against sampled segments.

mod rooms;

use glam::DVec3;
use radiosity::polygon::Polygon;
use radiosity::visibility::Visibility;
use rooms::Random;

/// Where the segment from s to t meets a polygon's triangles, as a parameter, and how far that is from an edge or
/// an end (in barycentric coordinates and parameters): Möller and Trumbore, in f64.
fn brute_cut(polygon: &Polygon, s: DVec3, t: DVec3) -> Option<(f64, f64)> {
    if polygon.height_of(s).abs().max(polygon.height_of(t).abs()) < 1e-9 {
        return None;
    }
    let cuts = polygon.triangles().filter_map(|[a, b, c]| {
        let (e, f, d, from) = (b - a, c - a, t - s, s - a);
        let determinant = e.dot(d.cross(f));
        let u = from.dot(d.cross(f)) / determinant;
        let v = d.dot(from.cross(e)) / determinant;
        let at = f.dot(from.cross(e)) / determinant;
        let depth = u.min(v).min(1.0 - u - v).min(at).min(1.0 - at);
        (depth > -1e-7).then_some((at, depth))
    });
    cuts.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// 300 triangles of all sizes, in a box that contains them and all segments.
fn confetti(random: &mut Random) -> Vec<Polygon> {
    let around =
        rooms::cube(3.0, 1).iter().map(|wall| scaled(wall, 1.0, DVec3::splat(-1.5))).collect::<Vec<_>>();
    (0..300)
        .map(|k| {
            let size = [0.02, 0.1, 0.5][k % 3];
            let a = random.vector();
            Polygon::triangle(a, a + size * random.vector(), a + size * random.vector())
        })
        .chain(around)
        .collect()
}

/// Both ends anywhere, or on polygons.
fn segment(polygons: &[Polygon], random: &mut Random, k: usize) -> (DVec3, DVec3) {
    let mut end = |on: bool| if on { random.on_any(polygons) } else { random.vector() };
    (end(k & 1 == 0), end(k & 2 == 0))
}

#[test]
fn blockers_are_those_of_brute_force() {
    let mut random = Random(1);
    let (mut blocked, mut clear) = (0, 0);
    for scene in 0..20 {
        let polygons = confetti(&mut random);
        let visibility = Visibility::new(&polygons);
        for k in 0..2000 {
            let (s, t) = segment(&polygons, &mut random, k);
            let cuts: Vec<_> = polygons.iter().map(|p| brute_cut(p, s, t)).collect();
            match visibility.blocker(s, t) {
                Some(id) => {
                    blocked += 1;
                    assert!(
                        cuts[id as usize].is_some(),
                        "scene {scene}: {id} is not on the way from {s} to {t}"
                    );
                }
                None => {
                    clear += 1;
                    let missed = cuts.iter().position(|c| c.is_some_and(|(_, depth)| depth > 1e-7));
                    assert_eq!(missed, None, "scene {scene}: from {s} to {t}");
                }
            }
        }
    }
    assert!(blocked > 10_000 && clear > 5_000, "{blocked} blocked, {clear} clear");
}

#[test]
fn the_nearest_hit_is_that_of_brute_force() {
    let mut random = Random(2);
    let mut hits = 0;
    for _ in 0..20 {
        let polygons = confetti(&mut random);
        let visibility = Visibility::new(&polygons);
        for k in 0..2000 {
            let (origin, target) = segment(&polygons, &mut random, k);
            let direction = (target - origin).normalize();
            let far = origin + 10.0 * direction;
            let certain = polygons
                .iter()
                .filter_map(|p| brute_cut(p, origin, far))
                .filter(|&(_, depth)| depth > 1e-7)
                .map(|(at, _)| 10.0 * at)
                .fold(f64::INFINITY, f64::min);
            let hit = visibility.nearest(origin, direction);
            let distance = hit.map_or(f64::INFINITY, |h| h.distance);
            assert!(
                distance <= certain + 1e-9,
                "{distance} instead of {certain} from {origin} along {direction}"
            );
            if let Some(hit) = hit {
                hits += 1;
                let (at, _) = brute_cut(&polygons[hit.polygon as usize], origin, far).unwrap();
                assert!((10.0 * at - hit.distance).abs() < 1e-9 * 10.0);
            }
        }
    }
    assert!(hits > 10_000, "{hits}");
}

fn scaled(polygon: &Polygon, scale: f64, shift: DVec3) -> Polygon {
    let v: Vec<DVec3> = polygon.vertices().iter().map(|&v| scale * v + shift).collect();
    if v.len() == 3 {
        Polygon::triangle(v[0], v[1], v[2])
    } else {
        Polygon::quadrilateral(v[0], v[1], v[2], v[3])
    }
}

#[test]
fn the_scale_and_the_place_of_a_scene_change_no_answer() {
    let polygons = rooms::cornell();
    let visibility = Visibility::new(&polygons);
    let pairs = rooms::facing_pairs(&polygons, 4, 2000);
    for (scale, shift) in [(1e-3, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, DVec3::new(500.0, -200.0, 300.0))] {
        let other: Vec<Polygon> = polygons.iter().map(|p| scaled(p, scale, shift)).collect();
        let other = Visibility::new(&other);
        let mut random = Random(3);
        for k in 0..20_000 {
            let (s, t) = segment(&polygons, &mut random, 4 * k);
            let (s2, t2) = (scale * s + shift, scale * t + shift);
            assert_eq!(visibility.unoccluded(s, t), other.unoccluded(s2, t2), "{scale}: from {s} to {t}");
            let d = random.direction();
            let (hit, hit2) = (visibility.nearest(s, d), other.nearest(s2, d));
            match (hit, hit2) {
                (Some(a), Some(b)) => assert!((a.distance * scale - b.distance).abs() < 1e-9 * scale),
                (a, b) => assert_eq!(a, b),
            }
        }
        for (a, b) in &pairs {
            let (a2, b2) = (scaled(a, scale, shift), scaled(b, scale, shift));
            assert_eq!(visibility.certainly_clear(a, b), other.certainly_clear(&a2, &b2));
        }
    }
}

#[test]
fn the_walls_of_a_cube_hide_nothing() {
    for n in [1, 3, 20] {
        let walls = rooms::cube(3.0, n);
        let visibility = Visibility::new(&walls);
        let mut random = Random(4);
        // Multiples of 1/4 put many points on edges and corners of the cube, and of its tiles when n = 20.
        let mut place = |k: usize| {
            let polygon = &walls[random.below(walls.len())];
            let (u, v) = (random.number(), random.number());
            if k.is_multiple_of(3) {
                polygon.point((4.0 * u).round() / 4.0, (4.0 * v).round() / 4.0)
            } else {
                polygon.point(u, v)
            }
        };
        for k in 0..100_000 {
            let (s, t) = (place(k), place(k / 2));
            assert_eq!(visibility.blocker(s, t), None, "from {s} to {t}");
        }
        assert!(visibility.certainly_clear(&walls[0], &walls[walls.len() - 1]));
        let hit = visibility.nearest(DVec3::splat(1.5), DVec3::X).unwrap();
        assert!((hit.distance - 1.5).abs() < 1e-12);
    }
}

#[test]
fn no_light_leaks_out_of_a_closed_surface() {
    let centre = DVec3::new(0.1, -0.2, 0.3);
    let mut box_walls: Vec<Polygon> = rooms::cube(2.0, 7);
    let mut shell = rooms::ball(centre, 1.0, 24, 48);
    for polygons in [&mut box_walls, &mut shell] {
        let aims: Vec<DVec3> = polygons
            .iter()
            .flat_map(|p| {
                let v = p.vertices();
                (0..v.len()).flat_map(|k| {
                    [v[k], v[k].lerp(v[(k + 1) % v.len()], 0.3), v[k].midpoint(v[(k + 2) % v.len()])]
                })
            })
            .collect();
        // A larger room around it makes occluders of all its walls.
        polygons.extend(rooms::cube(20.0, 1).iter().map(|wall| scaled(wall, 1.0, DVec3::splat(-10.0))));
        let visibility = Visibility::new(polygons);
        let mut random = Random(5);
        for aim in aims {
            let inside = if polygons.len() < 400 { DVec3::ONE } else { centre } + 0.2 * random.vector();
            let direction = (aim - inside).normalize();
            assert!(!visibility.unoccluded(inside, inside + 6.0 * direction), "from {inside} past {aim}");
            let hit = visibility.nearest(inside, direction).unwrap();
            assert!(hit.distance < 3.0);
        }
    }
}

#[test]
fn what_a_segment_ends_on_or_runs_in_does_not_block_it() {
    let n = 71;
    let at = |i: usize, j: usize| DVec3::new(i as f64 / n as f64, j as f64 / n as f64, 0.0);
    let mut polygons: Vec<Polygon> = (0..n * n)
        .flat_map(|k| {
            let (i, j) = (k % n, k / n);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [Polygon::triangle(a, b, c), Polygon::triangle(a, c, d)]
        })
        .collect();
    assert!(polygons.len() > 10_000);
    let squares = polygons.len();
    // Something on both sides makes the square an occluder; it is turned so that nothing is exact.
    for z in [-1.0, 1.0] {
        polygons.push(Polygon::triangle(DVec3::Z * z, DVec3::new(1e-3, 0.0, z), DVec3::new(0.0, 1e-3, z)));
    }
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.7);
    let turned: Vec<Polygon> = polygons
        .iter()
        .map(|p| Polygon::triangle(turn * p.vertices()[0], turn * p.vertices()[1], turn * p.vertices()[2]))
        .collect();
    let visibility = Visibility::new(&turned);
    let mut random = Random(6);
    for k in 0..50_000 {
        let corner = k % 2 == 0;
        let p = &turned[random.below(squares)];
        let s = if corner { p.vertices()[k % 3] } else { random.on(p) };
        let grazing = 10_f64.powf(-9.0 * random.number());
        let above = random.on_any(&turned[..squares]) + grazing * (turn * DVec3::Z);
        assert!(visibility.unoccluded(s, above), "from {s} to {above}");
        assert!(visibility.unoccluded(above, s));
        assert!(visibility.unoccluded(s, random.on_any(&turned[..squares])));
        let below = s - 0.5 * (turn * DVec3::Z);
        if grazing > 1e-6 {
            assert!(!visibility.unoccluded(above, below) || above.distance(s) > 1.4);
        }
    }
}

#[test]
fn the_lamp_shadows_the_ceiling_above_it() {
    let polygons = rooms::cornell();
    let visibility = Visibility::new(&polygons);
    let (floor, ceiling, lamp) = (&polygons[0], &polygons[1], 6);
    let above = polygons[lamp].centroid() + DVec3::Y * ceiling.height_of(polygons[lamp].centroid());
    assert!(ceiling.height_of(above).abs() < 1e-12);
    assert_eq!(visibility.blocker(above, floor.centroid()), Some(6));
    assert!(visibility.unoccluded(polygons[lamp].centroid(), polygons[0].point(0.95, 0.95)));
}

#[test]
fn what_is_no_segment_and_no_scene_is_answered() {
    let polygons = rooms::cornell();
    for visibility in [Visibility::new(&polygons), Visibility::new(&[]), Visibility::new(&polygons[6..7])] {
        for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::new(0.2, f64::NAN, 0.2), DVec3::splat(f64::MAX)] {
            visibility.blocker(bad, DVec3::splat(0.3));
            visibility.blocker(DVec3::splat(0.3), bad);
            visibility.nearest(bad, DVec3::X);
            visibility.nearest(DVec3::ZERO, bad);
        }
        assert!(visibility.unoccluded(DVec3::splat(0.2), DVec3::splat(0.2)));
        assert_eq!(visibility.nearest(DVec3::splat(0.2), DVec3::ZERO), None);
    }
    let same = vec![Polygon::triangle(DVec3::ZERO, DVec3::X, DVec3::Y); 5000];
    assert!(Visibility::new(&same).nearest(DVec3::new(0.2, 0.2, 1.0), -DVec3::Z).is_some());
    let speck = vec![Polygon::triangle(DVec3::ONE, DVec3::ONE, DVec3::ONE); 9];
    assert!(Visibility::new(&speck).unoccluded(DVec3::ZERO, DVec3::splat(2.0)));
}

/// How many of 200 segments between two polygons are unoccluded, those in the plane of one left out.
fn clear_samples(visibility: &Visibility, a: &Polygon, b: &Polygon, random: &mut Random) -> (usize, usize) {
    let mut counts = (0, 0);
    for k in 0..200 {
        // Not the very edge: segments along the hull's boundary may touch what the certificate leaves out.
        let edge = |x: f64| if k % 4 == 0 { x.round().clamp(1e-5, 1.0 - 1e-5) } else { x };
        let mut on = |p: &Polygon| p.point(edge(random.number()), edge(random.number()));
        let (s, t) = (on(a), on(b));
        if a.height_of(t) > 1e-9 && b.height_of(s) > 1e-9 {
            counts.1 += 1;
            counts.0 += usize::from(visibility.unoccluded(s, t));
        }
    }
    counts
}

#[test]
fn a_certificate_of_clearness_is_true_and_often_found() {
    let mut random = Random(8);
    for (polygons, n, share) in [(rooms::cornell(), 4, 0.9), (rooms::furnished(1), 2, 0.5)] {
        let visibility = Visibility::new(&polygons);
        let (mut certain, mut visible) = (0, 0);
        for (a, b) in rooms::facing_pairs(&polygons, n, 4000) {
            let (clear, all) = clear_samples(&visibility, &a, &b, &mut random);
            let certified = visibility.certainly_clear(&a, &b);
            if certified {
                assert_eq!(clear, all, "{a:?} to {b:?}");
            }
            if clear == all && all > 0 {
                visible += 1;
                certain += usize::from(certified);
            }
        }
        println!("{certain} of {visible} seen wholly are certified");
        assert!(certain as f64 > share * visible as f64, "{certain} of {visible}");
    }
}

#[test]
fn a_block_that_stands_on_a_patch_does_not_spoil_its_certificate() {
    let polygons = rooms::cornell();
    let visibility = Visibility::new(&polygons);
    // The patch between an edge of the short block's side and the right wall: the block touches it from below up.
    let side = &polygons[9];
    let [a, b] = [side.vertices()[0], side.vertices()[3]];
    let away = 0.05 * side.normal();
    let mut patch = Polygon::quadrilateral(a, b, b + away, a + away);
    if patch.normal().y < 0.0 {
        patch = Polygon::quadrilateral(b, a, a + away, b + away);
    }
    assert!(patch.normal().y > 0.999);
    let in_front: Vec<Polygon> = (0..16)
        .map(|k| rooms::cell(&polygons[1], 4, k % 4, k / 4))
        .filter(|p| p.vertices().iter().all(|&v| side.height_of(v) >= 0.0))
        .collect();
    // The tall block hides two of the five.
    let certain = in_front.iter().filter(|p| visibility.certainly_clear(&patch, p)).count();
    assert_eq!((certain, in_front.len()), (3, 5));
}

#[test]
fn a_certificate_of_blockage_is_true_and_found() {
    let polygons = rooms::cornell();
    let visibility = Visibility::new(&polygons);
    let mut random = Random(9);
    let (mut certain, mut hidden) = (0, 0);
    for (a, b) in rooms::facing_pairs(&polygons, 8, 4000) {
        let mut inner = || (random.on(&a), random.on(&b));
        let blocked = (0..100).filter(|_| {
            let (s, t) = inner();
            !visibility.unoccluded(s, t)
        });
        let blocked = blocked.count();
        let certified = (0..polygons.len()).any(|k| visibility.certainly_blocks(k as u32, &a, &b));
        if certified {
            assert_eq!(blocked, 100, "{a:?} to {b:?}");
        }
        if blocked == 100 {
            hidden += 1;
            certain += usize::from(certified);
        }
    }
    println!("{certain} of {hidden} hidden wholly are certified");
    assert!(certain as f64 > 0.5 * hidden as f64, "{certain} of {hidden}");
}

#[test]
fn many_segments_at_once_have_the_answers_that_each_has() {
    let mut random = Random(11);
    let mut cut = rooms::cornell();
    // A block in many triangles, as patches are.
    cut.extend(rooms::ball(DVec3::new(0.2, 0.3, 0.2), 0.15, 24, 48));
    let (mut hidden, mut asked) = (0, 0);
    for polygons in [cut, rooms::furnished(3), confetti(&mut random)] {
        let visibility = Visibility::new(&polygons);
        for round in 0..600 {
            let pair: [Polygon; 2] = std::array::from_fn(|_| {
                let polygon = &polygons[random.below(polygons.len())];
                rooms::cell(polygon, 4, random.below(4), random.below(4))
            });
            // Beams from cell to cell, fans from one point, and segments with nothing in common; among them some of no length.
            let mut segments: Vec<[DVec3; 2]> = (0..150)
                .map(|k| match round % 3 {
                    0 => [random.on(&pair[0]), random.on(&pair[1])],
                    1 => [
                        pair[0].centroid(),
                        if k < 70 { random.on(&pair[1]) } else { random.on_any(&polygons) },
                    ],
                    _ => [random.on_any(&polygons), random.on_any(&polygons)],
                })
                .collect();
            segments[7][1] = segments[7][0];
            segments.truncate([150, 64, 1, 9][round % 4]);
            let mut together = vec![true; 3];
            visibility.unoccluded_each(&segments, &mut together);
            let each: Vec<bool> = segments.iter().map(|[s, t]| visibility.unoccluded(*s, *t)).collect();
            assert_eq!(together, each, "round {round}");
            hidden += each.iter().filter(|clear| !**clear).count();
            asked += each.len();
        }
    }
    assert!(hidden > asked / 5 && hidden < 4 * asked / 5, "{hidden} of {asked}");
}
