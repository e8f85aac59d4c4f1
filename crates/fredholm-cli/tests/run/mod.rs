//! Runs the command in a folder of its own.

#![allow(dead_code, reason = "each test file uses some of it")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder for a test.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// `fredholm` with these words, separated by spaces.
pub fn fredholm(folder: &Path, words: &str) -> Output {
    fredholm_with(folder, &words.split_whitespace().collect::<Vec<_>>())
}

/// `fredholm` with these words, which may have spaces in them.
pub fn fredholm_with(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fredholm"));
    command.args(words).current_dir(folder).output().unwrap()
}

/// What was written, as JSON.
pub fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).unwrap()
}

/// What stands in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// What was written, as text.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The words of a command, its exit code, and words of its message.
pub type Case = (&'static str, i32, &'static [&'static str]);

/// Every case is refused as it says, without a panic and without a file left behind; returns what was written of each.
pub fn refuse(folder: &Path, cases: &[Case], run: impl Fn(&str) -> Output) -> Vec<String> {
    let before = names(folder);
    let refused = |&(words, code, expected): &Case| {
        let output = run(words);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "`{words}`: {message}{}", text(&output.stdout));
        assert!(!message.contains("panicked"), "`{words}`: {message}");
        assert!(message.starts_with("error: "), "`{words}`: {message}");
        for part in expected {
            assert!(message.contains(part), "`{words}`: no `{part}` in: {message}");
        }
        assert_eq!(names(folder), before, "`{words}` left files");
        message
    };
    cases.iter().map(refused).collect()
}
