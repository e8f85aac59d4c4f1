//! Text files as statements, each with the line on which it begins.

use super::error::{Error, Place, Problem};
use std::borrow::Cow;
use std::path::Path;

/// The text of a file; `named_at` is where its name stands, to be shown when it cannot be read.
pub(super) fn read(file: &Path, named_at: &Place) -> Result<String, Error> {
    decode(file, bytes(file, named_at)?)
}

/// The bytes of a file that may not be text.
pub(super) fn bytes(file: &Path, named_at: &Place) -> Result<Vec<u8>, Error> {
    std::fs::read(file)
        .map_err(|reason| Problem::Unreadable { file: file.to_owned(), reason }.at(named_at.clone()))
}

pub(super) fn decode(file: &Path, bytes: Vec<u8>) -> Result<String, Error> {
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text)),
        Err(error) => {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            Err(Problem::NotUtf8
                .at(Place::line(file, 1 + valid.iter().filter(|&&byte| byte == b'\n').count())))
        }
    }
}

/// The name of a file without folder and kind.
pub(super) fn stem(file: &Path) -> String {
    file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// A keyword and what follows it.
pub(super) struct Statement<'a> {
    /// The line on which it begins, counted from 1.
    pub line: usize,
    body: Cow<'a, str>,
}

impl Statement<'_> {
    /// The keyword, empty on a blank line, and the rest without space around it.
    pub fn split(&self) -> (&str, &str) {
        let body = self.body.trim();
        let (keyword, rest) = body.split_once(char::is_whitespace).unwrap_or((body, ""));
        (keyword, rest.trim_start())
    }
}

/// The lines of a text without comments and continuations, each a statement.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Statement<'_>> {
    text.lines().zip(1..).map(|(body, line)| Statement { line, body: Cow::Borrowed(body) })
}

/// The statements of an OBJ or MTL text, without comments; a `\` at the end of a line continues it.
pub(super) fn statements(text: &str) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = text.lines().zip(1..);
    std::iter::from_fn(move || {
        let (first, line) = lines.next()?;
        let mut body = Cow::Borrowed(without_comment(first));
        while let Some(head) = body.strip_suffix('\\') {
            let next = lines.next().map_or("", |(next, _)| without_comment(next));
            body = Cow::Owned(format!("{head} {next}"));
        }
        Some(Statement { line, body })
    })
}

/// The line up to a `#` that begins a word: `Material#25` is a name that some exporters write.
fn without_comment(line: &str) -> &str {
    let begins_word = |at: usize| line[..at].chars().next_back().is_none_or(char::is_whitespace);
    let end = line.match_indices('#').map(|(at, _)| at).find(|&at| begins_word(at)).unwrap_or(line.len());
    line[..end].trim_end()
}

/// A number; infinities and NaN are numbers here.
pub(super) fn number(word: &str) -> Result<f64, Problem> {
    word.parse()
        .map_err(|_| Problem::Malformed(format!("`{word}` is not a number; expected one like 2.5 or 1e-3")))
}

/// A coordinate: a number that is finite.
pub(super) fn coordinate(word: &str) -> Result<f64, Problem> {
    number(word).and_then(finite)
}

pub(super) fn finite(value: f64) -> Result<f64, Problem> {
    if value.is_finite() { Ok(value) } else { Err(Problem::NotFinite(value)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(text: &str) -> Vec<(usize, String, String)> {
        statements(text)
            .map(|s| (s.line, s.split().0.to_owned(), s.split().1.to_owned()))
            .filter(|(_, keyword, _)| !keyword.is_empty())
            .collect()
    }

    #[test]
    fn a_statement_knows_its_first_line() {
        let text = "# head\r\n\r\nf 1 \\\r\n  2\\\r\n3\r\n\tv  0 1 2  # tail\r\n";
        let expected = [(3, "f", "1    2 3"), (6, "v", "0 1 2")];
        let expected = expected.map(|(line, k, r)| (line, k.to_owned(), r.to_owned()));
        assert_eq!(parts(text), expected);
    }

    #[test]
    fn a_comment_continues_nothing_and_a_name_may_hold_its_sign() {
        let text = "# C:\\meshes\\\nusemtl Wall#2 b\no";
        assert_eq!(parts(text)[0], (2, "usemtl".to_owned(), "Wall#2 b".to_owned()));
        assert_eq!(parts(text)[1], (3, "o".to_owned(), String::new()));
    }

    #[test]
    fn a_text_that_ends_in_a_continuation_ends() {
        assert_eq!(parts("f 1 2 \\"), [(1, "f".to_owned(), "1 2".to_owned())]);
    }
}
