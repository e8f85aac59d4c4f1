//! `fredholm radiosity --operator hierarchical`: very many patches, and runs that are interrupted.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, text};
use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

const LINKED: &str = "radiosity --operator hierarchical --patch-count 1000 --json -";

#[test]
fn links_and_their_error_are_told() {
    let folder = folder("links");
    let output = fredholm(&folder, LINKED);
    let report = json(&output.stdout);
    assert_eq!(
        (report["operator"].as_str(), report["solver"].as_str()),
        (Some("hierarchical"), Some("gmres"))
    );
    let links = &report["links"];
    assert!((0.001..0.03).contains(&links["error"].as_f64().unwrap()), "{links}");
    let (bytes, planned) = (links["bytes"].as_f64().unwrap(), links["planned_bytes"].as_f64().unwrap());
    assert!(bytes > 0.5 * planned && bytes < 1.5 * planned, "{links}");
    for line in ["links", "clusters", "of the light that surfaces reflect"] {
        assert!(text(&output.stderr).contains(line), "no `{line}` in: {}", text(&output.stderr));
    }
    let drawn = folder.join("who.svg");
    let output = fredholm(&folder, &format!("{LINKED} --links who.svg"));
    let links = &json(&output.stdout)["links"]["links"];
    let picture = fs::read_to_string(drawn).unwrap();
    assert!(picture.starts_with("<svg") && picture.contains(&format!("{links} links")), "{links}");
    // What is not said is chosen: a matrix for few patches, links for many.
    let few = json(&fredholm(&folder, "radiosity --patch-count 300 --json -").stdout);
    assert_eq!((few["operator"].as_str(), few["links"].is_null()), (Some("dense"), true));
    let many =
        json(&fredholm(&folder, "radiosity --patch-count 10000 --factor-accuracy 0.01 --json -").stdout);
    assert_eq!(many["operator"].as_str(), Some("hierarchical"));
}

#[test]
fn much_memory_is_told_where_there_is_no_bar_too() {
    let folder = folder("memory");
    let told = |patches: usize| {
        let words = "radiosity --size 16x16 --operator dense --method nystrom --factor-accuracy 0.1 --json -";
        let output = fredholm(&folder, &format!("{words} --patch-count {patches}"));
        let report = json(&output.stdout);
        let error = text(&output.stderr);
        let note = error.lines().find(|line| line.starts_with("note: ")).map(str::to_owned);
        (report["patches"].as_f64().unwrap(), note, error.find("note: ") < error.find("residual"))
    };
    let (patches, note, is_first) = told(6000);
    // Four bytes an entry.
    let megabytes = (4.0 * patches * patches / f64::from(1 << 20)).floor();
    let expected = format!("note: about {megabytes} MB of memory will be taken");
    assert_eq!((note, is_first), (Some(expected), true));
    assert_eq!(told(1000).1, None);
}

#[test]
fn all_solvers_and_operators_find_the_same_light() {
    let folder = folder("operators");
    let floor = |words: &str| {
        let output = fredholm(
            &folder,
            &format!("radiosity --size 16x16 --factor-accuracy 3e-4 --json - --patch-count {words}"),
        );
        assert!(output.status.success(), "{words}: {}", text(&output.stderr));
        json(&output.stdout)["surfaces"][0]["mean_radiosity"][1].as_f64().unwrap()
    };
    let dense = floor("1000 --operator dense");
    let few = floor("300 --operator dense");
    let linked = floor("1000 --operator hierarchical");
    // One system, whoever solves it; another one on links, whose error is told to be a fifth of a hundredth of all radiosity.
    for (words, expected, tolerance) in [
        ("1000 --operator hierarchical --solver southwell", linked, 1e-4),
        ("1000 --operator hierarchical --solver gauss-seidel", linked, 1e-4),
        ("1000 --operator hierarchical --solver jacobi", linked, 1e-4),
        ("1000 --operator hierarchical", dense, 0.01),
        ("300 --operator on-the-fly --solver gmres", few, 1e-4),
        ("300 --operator on-the-fly --solver southwell", few, 1e-4),
    ] {
        let found = floor(words);
        assert!((found / expected - 1.0).abs() < tolerance, "{words}: {found} for {expected}");
    }
}

#[test]
fn a_run_that_is_interrupted_is_gone_on_with_and_finds_the_same() {
    let folder = folder("checkpoint");
    let words = "radiosity --operator hierarchical --patch-count 3000 --factor-accuracy 3e-4";
    // What a run says that is interrupted so long after it has begun.
    let interrupted = |wait: f64| {
        let mut run = Command::new(env!("CARGO_BIN_EXE_fredholm"));
        let options = ["--threads", "1", "--checkpoint", "half.links"];
        let run = run.current_dir(&folder).args(words.split(' ')).args(options);
        let mut child = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        while names(&folder).is_empty() {
            assert_eq!(child.try_wait().unwrap(), None, "it ended before it could be interrupted");
            sleep(Duration::from_millis(10));
        }
        sleep(Duration::from_secs_f64(wait));
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{told}");
        told
    };
    // At first there is only the sketch, on a slow machine for seconds.
    let mut wait = 0.1;
    let mut told = interrupted(wait);
    while told.contains("before there were any links: nothing is kept") {
        assert_eq!(names(&folder), [""; 0], "{told}");
        wait *= 1.4;
        told = interrupted(wait);
    }
    assert!(told.contains("of 3008 patches have their links, kept in half.links"), "{told}");
    assert_eq!(names(&folder), ["half.links"]);

    let solved = |words: &str| json(&fredholm(&folder, words).stdout)["surfaces"].clone();
    let resumed = solved(&format!("{words} --resume half.links --json -"));
    assert_eq!(resumed, solved(&format!("{words} --json -")));

    let refused = |words: &str, word: &str| {
        let output = fredholm(&folder, words);
        let told = text(&output.stderr);
        assert!(output.status.code() == Some(1) && told.contains(word), "{words}: {told}");
    };
    refused("radiosity --patch-count 1000 --operator hierarchical --resume half.links", "another scene");
    let whole = fs::read(folder.join("half.links")).unwrap();
    fs::write(folder.join("cut.links"), &whole[..whole.len() - 1]).unwrap();
    refused(&format!("{words} --resume cut.links"), "damaged or cut off");
    let mut flipped = whole.clone();
    // A digit of the light that the links were made for.
    flipped[100] ^= 1;
    fs::write(folder.join("flipped.links"), flipped).unwrap();
    refused(&format!("{words} --resume flipped.links"), "damaged or cut off");
    let mut newer = whole;
    newer[8] = 99;
    fs::write(folder.join("newer.links"), newer).unwrap();
    refused(&format!("{words} --resume newer.links"), "version 99");
}

#[test]
fn a_checkpoint_that_is_none_or_another_is_refused() {
    let folder = folder("refused");
    let refused = |file: &str, word: &str| {
        let output = fredholm(&folder, &format!("{LINKED} --resume {file}"));
        let told = text(&output.stderr);
        assert!(output.status.code() == Some(1) && told.contains(word), "{file}: {told}");
    };
    fs::write(folder.join("text.links"), "no links at all").unwrap();
    refused("text.links", "no checkpoint of fredholm");
    fs::write(folder.join("empty.links"), "").unwrap();
    refused("empty.links", "no checkpoint of fredholm");
    refused("missing.links", "missing.links");
    let output = fredholm(&folder, &format!("{LINKED} --checkpoint text.links"));
    let told = text(&output.stderr);
    assert!(output.status.code() == Some(1) && told.contains("text.links: there is a file"), "{told}");
    assert_eq!(fs::read(folder.join("text.links")).unwrap(), b"no links at all");
    let output = fredholm(&folder, "radiosity --operator dense --links a.svg");
    assert!(text(&output.stderr).contains("--links"), "{}", text(&output.stderr));
    let output = fredholm(&folder, "radiosity --operator dense --checkpoint a.links");
    assert!(text(&output.stderr).contains("--operator hierarchical"), "{}", text(&output.stderr));
}
