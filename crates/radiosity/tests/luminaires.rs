//! Photometric files: known answers, the same luminaire by every way of writing it, and files that are damaged.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod common;

use common::*;
use glam::DVec3;
use radiosity::kernel::SurfacePoint;
use radiosity::lights::{irradiance, mean_irradiances, nearest_lit};
use radiosity::patches::Patches;
use radiosity::scene::{Distribution, Light, Loaded, PointLight, Scene, Web, load};
use radiosity::visibility::Visibility;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::PathBuf;

/// An IES file of these planes, each an angle and the intensities at `gammas`.
fn ies(gammas: &[f64], planes: &[(f64, Vec<f64>)]) -> String {
    let list = |numbers: &mut dyn Iterator<Item = f64>| {
        numbers.fold(String::new(), |mut text, number| {
            write!(text, "{number} ").unwrap();
            text
        })
    };
    let (rows, count) = (gammas.len(), planes.len());
    let candela: Vec<String> = planes.iter().map(|(_, values)| list(&mut values.iter().copied())).collect();
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] none\nTILT=NONE\n1 1000 1 {rows} {count} 1 2 -0.2 -0.2 0\n1 1 10\n{}\n{}\n{}\n",
        list(&mut gammas.iter().copied()),
        list(&mut planes.iter().map(|(c, _)| *c)),
        candela.join("\n")
    )
}

/// The same as EULUMDAT; `symmetry` with the number of all planes, of which these are those that it has.
fn ldt(gammas: &[f64], planes: &[(f64, Vec<f64>)], (symmetry, around): (u32, usize)) -> String {
    let mut text = String::from("Fabrik für Lampen\n1\n");
    let rows = gammas.len();
    write!(text, "{symmetry}\n{around}\n{}\n{rows}\n0\nr\nn\n1\nf\nd\n", 360.0 / around as f64).unwrap();
    // Sizes in mm, to line 21; DFF, output ratio, conversion, tilt, one set of lamps.
    text += "200\n0\n0\n200\n0\n0\n0\n0\n0\n100\n80\n1.0\n0\n1\n1\nLED\n1000\n3000\n80\n10\n";
    text += &"0.5\n".repeat(10);
    for k in 0..around {
        writeln!(text, "{}", 360.0 * k as f64 / around as f64).unwrap();
    }
    for number in gammas.iter().chain(planes.iter().flat_map(|(_, values)| values)) {
        writeln!(text, "{number}").unwrap();
    }
    text
}

const FLOOR: &str = "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\no floor\nusemtl grey\nf 1 2 3 4\n";

fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("luminaires").join(test);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A photometric scene of a floor and a luminaire with these entries.
fn scene(test: &str, file: &str, text: &[u8], entries: &str) -> Result<Loaded, String> {
    let folder = folder(test);
    std::fs::write(folder.join("a.obj"), FLOOR).unwrap();
    std::fs::write(folder.join(file), text).unwrap();
    let toml = format!(
        "units = 'photometric'\nunit = 'm'\nmeshes = ['a.obj']\n[[luminaire]]\nfile = '{file}'\nposition = [0, 0, 2]\n{entries}\n[materials.grey]\nreflectance = 0.5\n"
    );
    std::fs::write(folder.join("a.toml"), toml).unwrap();
    load(&folder.join("a.toml"))
        .map_err(|error| error.to_string().replace(&format!("{}/", folder.display()), ""))
}

fn light(loaded: &Loaded) -> (PointLight<f64>, Scene<f64>) {
    let scene = loaded.grey();
    let Light::Point(light) = &scene.lights[0] else { panic!("{:?}", scene.lights) };
    (light.clone(), scene)
}

fn web(loaded: &Loaded) -> Web {
    let Distribution::Measured(aimed) = light(loaded).0.distribution else { panic!("no luminaire") };
    (*aimed.web).clone()
}

/// The illuminance at a point.
fn at(loaded: &Loaded, position: DVec3, normal: DVec3) -> f64 {
    let (light, scene) = light(loaded);
    irradiance(&[light.into()], &Visibility::new(&scene.polygons()), &SurfacePoint { position, normal })
}

fn steps(step: f64, last: f64) -> Vec<f64> {
    (0..=(last / step).round() as usize).map(|k| k as f64 * step).collect()
}

fn lambertian(gammas: &[f64]) -> Vec<f64> {
    gammas.iter().map(|gamma| 300.0 * gamma.to_radians().cos().max(0.0)).collect()
}

#[test]
fn a_lambertian_luminaire_lights_a_floor_by_the_fourth_power_of_the_cosine() {
    let gammas = steps(1.0, 90.0);
    let values = lambertian(&gammas);
    let files = [
        ("a.ies", ies(&gammas, &[(0.0, values.clone())])),
        ("a.ldt", ldt(&gammas, &[(0.0, values)], (1, 1))),
    ];
    for (file, text) in files {
        let loaded = scene("lambertian", file, text.as_bytes(), "").unwrap();
        for gamma in [0.0_f64, 1.0, 17.0, 45.0, 60.0] {
            let angle = gamma.to_radians();
            // In any plane, on the lines of the grid: to rounding.
            for c in [0.0_f64, 1.0, 2.5, 4.0] {
                let x = p(c.cos(), c.sin(), 0.0) * (2.0 * angle.tan());
                let expected = 300.0 * angle.cos().powi(4) / 4.0;
                assert!((at(&loaded, x, DVec3::Z) / expected - 1.0).abs() < 1e-9, "{file} at {gamma}");
            }
        }
        // π I₀, but for what is linear between degrees.
        let flux = web(&loaded).flux();
        assert!((flux / (300.0 * PI) - 1.0).abs() < 1e-4, "{flux}");
        assert_eq!(web(&loaded).lamps, Some(1000.0));
        // Of the means of patches too: all that goes down arrives on a large floor, but for what is past its edge.
        let (light, mut wide) = light(&loaded);
        wide.surfaces[0].polygons =
            vec![parallelogram(p(-200.0, -200.0, 0.0), 400.0 * DVec3::X, 400.0 * DVec3::Y)];
        let patches = Patches::new(&wide, 50.0).unwrap();
        let lit = mean_irradiances(&patches, &Visibility::new(&wide.polygons()));
        let all: f64 = lit.iter().zip(&patches.areas).map(|(h, area)| h * area).sum();
        let all_of_it = light.intensity * light.distribution.flux_of_unit();
        assert!((all / all_of_it - 1.0).abs() < 1e-3, "{all} of {all_of_it}");
    }
    let told =
        scene("lambertian", "a.ldt", ldt(&gammas, &[(0.0, lambertian(&gammas))], (1, 1)).as_bytes(), "")
            .unwrap();
    assert_eq!((web(&told).stated, web(&told).size), (Some(800.0), 0.2));
}

#[test]
fn an_even_file_is_a_point_light() {
    let text = ies(&[0.0, 180.0], &[(0.0, vec![40.0, 40.0])]);
    let loaded = scene("even", "a.ies", text.as_bytes(), "aim = [0.3, -0.5, 0.2]\nturn = 12").unwrap();
    let point = PointLight::uniform(p(0.0, 0.0, 2.0), 40.0);
    let visibility = Visibility::new(&loaded.scene.polygons());
    for position in [DVec3::ZERO, p(1.0, 2.0, 0.0), p(-4.0, 0.5, 0.0)] {
        let expected =
            irradiance(&[point.clone().into()], &visibility, &SurfacePoint { position, normal: DVec3::Z });
        assert!((at(&loaded, position, DVec3::Z) / expected - 1.0).abs() < 1e-14);
    }
    let flux = web(&loaded).flux();
    assert!((flux / (160.0 * PI) - 1.0).abs() < 1e-14, "{flux}");
}

/// Planes that differ all around, and their intensities between 50 and 150 cd.
fn odd(planes: &[f64], gammas: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let value = |c: f64, gamma: f64| {
        100.0 + 30.0 * (c.to_radians() + 0.4).sin() * gamma.to_radians().sin() + 20.0 * (gamma / 50.0).cos()
    };
    planes.iter().map(|c| (*c, gammas.iter().map(|gamma| value(*c, *gamma)).collect())).collect()
}

#[test]
fn a_turned_luminaire_is_the_turned_room() {
    let gammas = steps(15.0, 180.0);
    let text = ies(&gammas, &odd(&steps(30.0, 330.0), &gammas));
    let hanging = scene("turned", "a.ies", text.as_bytes(), "").unwrap();
    let points = [p(1.0, 0.3, 0.0), p(-0.4, 1.5, 0.5), p(0.2, -1.0, 0.0)];
    let normals = [DVec3::Z, p(0.3, -0.6, 0.9).normalize(), p(0.0, 0.5, 0.5).normalize()];
    // C grows counter-clockwise seen from above, from the east.
    let east = at(&hanging, p(1.0, 0.0, 0.0), DVec3::Z);
    assert!(
        (east / (web(&hanging).at(0.0, 0.5_f64.atan().to_degrees()) * 2.0 / 5_f64.powf(1.5)) - 1.0).abs()
            < 1e-12
    );
    let north = at(&hanging, p(0.0, 1.0, 0.0), DVec3::Z);
    assert!(
        (north / (web(&hanging).at(90.0, 0.5_f64.atan().to_degrees()) * 2.0 / 5_f64.powf(1.5)) - 1.0).abs()
            < 1e-12
    );

    let about = |axis: DVec3, angle: f64, v: DVec3| glam::DQuat::from_axis_angle(axis, angle) * v;
    let centre = p(0.0, 0.0, 2.0);
    // Turned by 40 degrees, then tilted by 90 about x, down to north.
    for (entries, turns) in [
        ("turn = 40", [(DVec3::Z, 40.0_f64), (DVec3::Z, 0.0)]),
        ("aim = [0, 3, 0]", [(DVec3::X, 90.0), (DVec3::X, 0.0)]),
        ("turn = 40\naim = [0, 1, 0]", [(DVec3::Z, 40.0), (DVec3::X, 90.0)]),
        ("aim = [0, 0, 1]", [(DVec3::X, 180.0), (DVec3::X, 0.0)]),
    ] {
        let turned = scene("turned", "a.ies", text.as_bytes(), entries).unwrap();
        let turn = |v: DVec3| turns.iter().fold(v, |v, (axis, angle)| about(*axis, angle.to_radians(), v));
        for (x, n) in points.iter().zip(normals) {
            let expected = {
                // The floor is left out: it would have to turn as well.
                let (light, _) = light(&hanging);
                irradiance(&[light.into()], &Visibility::new(&[]), &SurfacePoint { position: *x, normal: n })
            };
            let (light, _) = light(&turned);
            let there = SurfacePoint { position: centre + turn(*x - centre), normal: turn(n) };
            let found = irradiance(&[light.into()], &Visibility::new(&[]), &there);
            assert!((found - expected).abs() < 1e-12 && expected > 1.0, "{entries}: {found} {expected}");
        }
    }
}

#[test]
fn every_symmetry_is_the_luminaire_written_in_full() {
    let gammas = steps(15.0, 180.0);
    let full = steps(30.0, 330.0);
    // What is the same in the mirrors of a symmetry.
    let folded = |c: f64, about: &str| match about {
        "c0" => c.min(360.0 - c),
        "c90" => {
            if (90.0..=270.0).contains(&c) {
                c
            } else {
                (180.0 - c).rem_euclid(360.0)
            }
        }
        _ => {
            let c = c.min(360.0 - c);
            c.min(180.0 - c)
        }
    };
    let values = |about: &'static str, planes: &[f64]| -> Vec<(f64, Vec<f64>)> {
        planes.iter().map(|c| (*c, odd(&[folded(*c, about)], &gammas).remove(0).1)).collect()
    };
    let close = |mut planes: Vec<(f64, Vec<f64>)>| {
        let first = planes[0].1.clone();
        planes.push((360.0, first));
        planes
    };
    for (about, ies_planes, ldt_planes, symmetry) in [
        ("c0", steps(30.0, 180.0), steps(30.0, 180.0), 2),
        (
            "c90",
            steps(30.0, 180.0).iter().map(|c| c + 90.0).collect(),
            vec![270.0, 300.0, 330.0, 0.0, 30.0, 60.0, 90.0],
            3,
        ),
        ("both", steps(30.0, 90.0), steps(30.0, 90.0), 4),
    ] {
        let whole = values(about, &full);
        let files = [
            ("whole.ies", ies(&gammas, &whole)),
            ("closed.ies", ies(&gammas, &close(whole.clone()))),
            ("part.ies", ies(&gammas, &values(about, &ies_planes))),
            ("whole.ldt", ldt(&gammas, &whole, (0, 12))),
            ("part.ldt", ldt(&gammas, &values(about, &ldt_planes), (symmetry, 12))),
        ];
        let webs =
            files.map(|(name, text)| (name, web(&scene("symmetry", name, text.as_bytes(), "").unwrap())));
        for (name, web) in &webs {
            for (c, gamma) in
                [(0.0, 40.0), (33.0, 77.0), (100.0, 90.0), (211.0, 130.0), (299.0, 15.0), (350.0, 60.0)]
            {
                let (found, expected) = (web.at(c, gamma), webs[0].1.at(c, gamma));
                assert!(
                    (found - expected).abs() < 1e-10,
                    "{about} {name} at {c}, {gamma}: {found} {expected}"
                );
            }
            assert!((web.flux() / webs[0].1.flux() - 1.0).abs() < 1e-12, "{about} {name}");
        }
    }
}

#[test]
fn what_a_file_multiplies_is_multiplied() {
    let even = |text: &str| web(&scene("factors", "a.ies", text.as_bytes(), "").unwrap()).largest();
    let text = ies(&[0.0, 180.0], &[(0.0, vec![40.0, 40.0])]);
    let changed =
        text.replace("1 1000 1 2 1 1 2", "2 1000 3 2 1 1 1").replace("\n1 1 10\n", "\n0.5 0.25 10\n");
    // Since 2002 the second factor is for what is to come.
    assert_eq!(even(&changed), 60.0);
    assert_eq!(even(&changed.replace("IESNA:LM-63-2002", "IESNA91")), 15.0);
    // The oldest files begin with anything.
    assert_eq!(even(&changed.replace("IESNA:LM-63-2002", "Our best lamp")), 15.0);
    let loaded = scene("factors", "a.ies", changed.as_bytes(), "").unwrap();
    assert!((web(&loaded).size - 0.2 * 0.3048).abs() < 1e-15 && web(&loaded).lamps == Some(2000.0));
    let tilted = text.replace("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 0.9");
    let loaded = scene("factors", "a.ies", tilted.as_bytes(), "").unwrap();
    assert!(
        web(&loaded).largest() == 40.0 && loaded.warnings[0].to_string().contains("a.ies: the lamp's light")
    );
    let (one, conversion) = (ldt(&[0.0, 180.0], &[(0.0, vec![40.0, 40.0])], (1, 1)), "\n80\n1.0\n");
    let loaded = scene("factors", "a.ldt", one.replace(conversion, "\n80\n0,5\n").as_bytes(), "").unwrap();
    assert_eq!(web(&loaded).largest(), 20.0);
}

#[test]
fn it_shines_as_the_scene_says() {
    let text = ies(&[0.0, 180.0], &[(0.0, vec![40.0, 40.0])]);
    let of = |entries: &str| light(&scene("dimmed", "a.ies", text.as_bytes(), entries).unwrap()).0.intensity;
    assert_eq!(of(""), 40.0);
    assert_eq!(of("dimming = 0.25"), 10.0);
    assert!((of("flux = 1000") - 1000.0 / (4.0 * PI)).abs() < 1e-10);
    // Near: the floor is 2 m away, and the luminaire 0.2 m large or, in feet and so many of them, 3 m.
    let loaded = scene("dimmed", "a.ies", text.as_bytes(), "").unwrap();
    let (light, scene) = light(&loaded);
    assert_eq!(nearest_lit(&light, &scene), Some(2.0));
    assert_eq!(nearest_lit(&PointLight::uniform(DVec3::Z, 1.0), &scene), None);
}

#[test]
fn what_is_wrong_is_told_at_its_line() {
    let good = ies(&[0.0, 90.0], &[(0.0, vec![40.0, 40.0])]);
    let good_ldt = ldt(&[0.0, 90.0], &[(0.0, vec![40.0, 40.0])], (1, 1));
    let ies_case = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        ("a.ies", good.replacen(from, to, 1), "")
    };
    let ldt_case = |line: usize, to: &str| {
        let mut lines: Vec<&str> = good_ldt.lines().collect();
        lines[line - 1] = to;
        ("a.ldt", lines.join("\n"), "")
    };
    let cases = [
        (ies_case("TILT=NONE", "TILT NONE"), "a.ies:9: there is no line `TILT=`"),
        (
            ies_case("1 1000 1 2 1 1", "1 1000 1 2 1 2"),
            "a.ies:5: photometry of type B (2) is not read; type C",
        ),
        (ies_case("1 1000 1 2 1 1", "1 1000 1 2 1 3"), "a.ies:5: photometry of type A (3)"),
        (ies_case("1 1000 1 2 1 1", "1 1000 1 2.5 1 1"), "a.ies:5: the number of vertical angles is 2.5"),
        (ies_case("1 1000 1 2 1 1", "1 1000 1 1e9 1 1"), "a.ies:5: the number of vertical angles"),
        (ies_case("1 1000 1 2 1 1 2", "1 1000 1 2 1 1 3"), "a.ies:5: the unit of length is 3"),
        (ies_case("1 1000 1", "1 1000 -1"), "a.ies:5: the multiplier is -1"),
        (ies_case("1 1 10", "1 x 10"), "a.ies:6: `x` is no number; expected the ballast-lamp factor"),
        (ies_case("0 90 ", "90 0 "), "a.ies:7: the vertical angle 0 follows 90; angles must grow"),
        (ies_case("0 90 ", "0 190 "), "a.ies:7: the vertical angle 190 is not from 0 to 180"),
        (ies_case("\n0 \n", "\n12 \n"), "a.ies:8: the horizontal angles go from 12 to 12"),
        (ies_case("40 40", "40 -40"), "a.ies:9: the intensity is -40"),
        (ies_case("40 40", "40 inf"), "a.ies:9: `inf` is no number"),
        (ies_case("40 40", "40"), "a.ies:9: the file ends where an intensity in cd is expected"),
        (ies_case("40 40", "0 0"), "a.ies: the luminaire gives no light"),
        (ldt_case(3, "5"), "a.ldt:3: the symmetry is 5"),
        (ldt_case(4, "0"), "a.ldt:4: the number of C-planes is 0"),
        (ldt_case(6, "many"), "a.ldt:6: `many` is no number; expected the number of intensities"),
        (ldt_case(26, "3"), "a.ldt:"),
        (
            ("a.ldt", good_ldt.lines().take(44).collect::<Vec<_>>().join("\n"), ""),
            "a.ldt:44: the file ends after line 44",
        ),
        (("a.txt", good.clone(), ""), "a.toml:5: files of the kind `txt` are no luminaires"),
        (("a.ies", good.clone(), "aim = [0, 0, 0]"), "a.toml:7: the aim of the luminaire has no length"),
        (("a.ies", good.clone(), "turn = nan"), "a.toml:7: the turn"),
        (("a.ies", good.clone(), "dimming = -1"), "a.toml:7: the dimming"),
        (("a.ies", good.clone(), "dimming = 1\nflux = 1"), "a.toml:7: `flux` and `dimming` both"),
        (("a.ies", good.clone(), "flux = [1, 2, 3]"), "a.toml:7: a photometric scene has one channel"),
        (("a.ies", good.clone(), "flux = -2"), "a.toml:7: the flux of the luminaire is -2"),
        (("a.ies", good.clone(), "colour = 2"), "a.toml:7: unknown field `colour`"),
    ];
    for ((file, text, entries), expected) in cases {
        let message = scene("errors", file, text.as_bytes(), entries).map(|_| ()).unwrap_err();
        assert!(message.starts_with(expected), "{message} for {expected}");
    }
    // Lumens are no watts, but a shape in watts is one.
    let folder = folder("errors");
    std::fs::write(folder.join("a.ies"), &good).unwrap();
    let toml = "unit = 'm'\nmeshes = ['a.obj']\n[[luminaire]]\nfile = 'a.ies'\nposition = [0, 0, 2]\n";
    std::fs::write(folder.join("b.toml"), toml).unwrap();
    let message = load(&folder.join("b.toml")).unwrap_err().to_string();
    assert!(
        message.contains("b.toml:4: a photometric file is in lumens, and the scene in watts"),
        "{message}"
    );
    let grey = "[materials.grey]\nreflectance = 0.5\n";
    std::fs::write(folder.join("b.toml"), format!("{toml}flux = [1, 2, 3]\n{grey}")).unwrap();
    let Light::Point(light) = &load(&folder.join("b.toml")).unwrap().scene.lights[0] else { panic!() };
    assert!((light.intensity.0[2] * light.distribution.flux_of_unit() - 3.0).abs() < 1e-12);
}

/// Files cut off anywhere, with flipped bits and with other numbers in them: they are refused in one line, or shine.
#[test]
fn damaged_files_are_refused_or_make_sense() {
    let gammas = steps(30.0, 180.0);
    let planes = odd(&steps(30.0, 330.0), &gammas);
    let (mut accepted, mut all) = (0, 0);
    for (file, text) in [("a.ies", ies(&gammas, &planes)), ("a.ldt", ldt(&gammas, &planes, (0, 12)))] {
        let bytes = text.into_bytes();
        let mut broken: Vec<Vec<u8>> = (0..bytes.len()).map(|end| bytes[..end].to_vec()).collect();
        let mut seed = 1_u64;
        let mut below = |end: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % end
        };
        for _ in 0..700 {
            let mut flipped = bytes.clone();
            for _ in 0..1 + below(3) {
                let at = below(flipped.len());
                flipped[at] ^= 1 << below(8);
            }
            broken.push(flipped);
            let mut replaced = bytes.clone();
            let (start, end) = (below(bytes.len()), below(12));
            let end = (start + end).min(bytes.len());
            let other: [&[u8]; 8] = [b"", b"-1", b"1e308", b"99999999999", b"nan", b"0", b"\n", b" 7 "];
            replaced.splice(start..end, other[below(8)].iter().copied());
            broken.push(replaced);
        }
        for text in broken {
            all += 1;
            match scene("damaged", file, &text, "") {
                Ok(loaded) => {
                    let web = web(&loaded);
                    assert!(web.flux().is_finite() && web.flux() >= 0.0 && web.size.is_finite());
                    for (c, gamma) in [(0.0, 0.0), (77.0, 91.0), (359.9, 180.0)] {
                        assert!(web.at(c, gamma).is_finite() && web.at(c, gamma) >= 0.0);
                    }
                    accepted += 1;
                }
                Err(message) => {
                    assert!(message.starts_with(file) || message.starts_with("a.toml"), "{message}");
                    assert!(!message.contains('\n') && message.len() < 300, "{message}");
                }
            }
        }
    }
    assert!(accepted > all / 50 && accepted < 3 * all / 4, "{accepted} of {all}: these damages test nothing");
}
