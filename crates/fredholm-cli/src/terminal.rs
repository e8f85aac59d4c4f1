//! The one place that writes to the terminal; a reader who has gone away is no error.

use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::io::{self, BufWriter, ErrorKind, Write};

/// Where people and programs read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// What was asked for.
    Out,
    /// Everything else.
    Err,
}

/// Writes a text. A broken pipe ends the writing, not the work: `fredholm … | head` still gets its picture.
pub fn say(stream: Stream, text: &str) -> io::Result<()> {
    let written = match stream {
        Stream::Out => write_all(io::stdout().lock(), text),
        Stream::Err => write_all(io::stderr().lock(), text),
    };
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Writes to the standard output what is too long to be a text first. A broken pipe ends it, as in [`say`].
pub fn pour(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Tells what went wrong, in one message.
pub fn complain(error: &anyhow::Error) -> io::Result<()> {
    say(Stream::Err, &format!("error: {error:#}\n"))
}

/// Tells what does not stop the work.
pub fn warn(message: &impl Display) -> io::Result<()> {
    say(Stream::Err, &format!("warning: {message}\n"))
}

fn write_all(mut out: impl Write, text: &str) -> io::Result<()> {
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// A bar on the standard error, when that is a terminal.
pub fn bar(title: &'static str, length: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix:>13} {wide_bar} {percent:>3} % {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style).with_prefix(title)
}
