//! `--checkpoint` and `--resume`: what was found before an interrupt, and going on with it.

use super::args::Radiosity;
use crate::ending::Ending;
use crate::output::{Output, clear_on_interrupt, end_on_interrupt, stop_on_interrupt};
use crate::terminal::warn;
use anyhow::{Context, Result, bail};
use radiosity::hierarchical::Kept;
use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a run may be stopped by and go on from.
#[derive(Debug)]
pub struct Checkpoint {
    output: Option<Output>,
    stopped: Option<&'static AtomicBool>,
}

impl Checkpoint {
    /// Listens for interrupts from now on, and makes sure that the file can be written and replaces nothing but a checkpoint.
    pub fn prepare(args: &Radiosity) -> Result<Self> {
        let Some(path) = &args.checkpoint else {
            clear_on_interrupt()?;
            return Ok(Self { output: None, stopped: None });
        };
        if path.is_file() && !Kept::is_in(&mut open(path)?)? {
            bail!(
                "{}: there is a file of this name that is no checkpoint: give --checkpoint another",
                path.display()
            );
        }
        Ok(Self { output: Some(Output::prepare(path)?), stopped: Some(stop_on_interrupt()?) })
    }

    /// Nothing is kept from now on: an interrupt ends the run.
    pub fn close(&self) {
        end_on_interrupt();
    }

    /// What says whether to stop.
    pub fn stop(&self) -> Stop {
        Stop(self.stopped)
    }

    /// Keeps what was found.
    pub fn keep(self, kept: &Kept, patches: usize) -> Result<Ending> {
        let Some(output) = self.output else { return Ok(Ending::Interrupted) };
        let found = kept.patches();
        if found == 0 {
            warn(&"interrupted before there were any links: nothing is kept")?;
            return Ok(Ending::Interrupted);
        }
        let path = output.write(|out| kept.write(out))?;
        let file = path.display();
        warn(&format!(
            "interrupted: {found} of {patches} patches have their links, kept in {file}; go on with --resume {file}"
        ))?;
        Ok(Ending::Interrupted)
    }
}

/// Whether there was an interrupt.
#[derive(Clone, Copy, Debug)]
pub struct Stop(Option<&'static AtomicBool>);

impl Stop {
    /// Whether there was one.
    pub fn is_asked(self) -> bool {
        self.0.is_some_and(|stopped| stopped.load(Ordering::Relaxed))
    }
}

/// A file to go on from.
pub fn open(path: &Path) -> Result<File> {
    File::open(path).with_context(|| format!("cannot read {}", path.display()))
}
