//! The numbers of a run for programs: `--json FILE`, or `--json -` for the standard output.

use crate::output::Output;
use crate::terminal::{Stream, pour, say};
use anyhow::Result;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Where the JSON goes.
pub enum Json {
    /// To the standard output, alone.
    Terminal,
    /// Into a file.
    File(Output),
}

impl Json {
    /// Makes sure that it can be written there; `-` is the standard output.
    pub fn prepare(path: &Path) -> Result<Self> {
        if path == Path::new("-") { Ok(Self::Terminal) } else { Ok(Self::File(Output::prepare(path)?)) }
    }

    /// The file that it goes to.
    pub fn file(&self) -> Option<PathBuf> {
        match self {
            Self::Terminal => None,
            Self::File(output) => Some(output.path().to_owned()),
        }
    }
}

/// Writes the report as JSON where it is asked for, and the table for people: beside it, if JSON has the standard output.
pub fn tell(json: Option<Json>, report: &impl Serialize, table: &str) -> Result<()> {
    let text = || serde_json::to_string_pretty(report).map(|text| text + "\n");
    let stream = match json {
        None => Stream::Out,
        Some(Json::File(output)) => {
            let text = text()?;
            output.write(|out| out.write_all(text.as_bytes()))?;
            Stream::Out
        }
        Some(Json::Terminal) => {
            say(Stream::Out, &text()?)?;
            Stream::Err
        }
    };
    Ok(say(stream, table)?)
}

/// As [`tell`], for a report with matrices: on one line, and without a copy of it in memory.
pub fn stream(json: Option<Json>, report: &impl Serialize, table: &str) -> Result<()> {
    let write = |out: &mut dyn Write| -> io::Result<()> {
        serde_json::to_writer(&mut *out, report)?;
        out.write_all(b"\n")
    };
    let stream = match json {
        None => Stream::Out,
        Some(Json::File(output)) => {
            output.write(|out| write(out))?;
            Stream::Out
        }
        Some(Json::Terminal) => {
            pour(write)?;
            Stream::Err
        }
    };
    Ok(say(stream, table)?)
}
