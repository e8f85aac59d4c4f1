//! How a run ends that has written all its files, and what the shell is told of it.

use std::process::ExitCode;

/// How a run ended that has written all its files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The answer is as good as was asked.
    Converged,
    /// It is not.
    NotConverged,
    /// The equation has no solution, or more than one where one was asked for.
    NoAnswer,
    /// It was interrupted, and what was found is kept.
    Interrupted,
}

impl From<Ending> for ExitCode {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Converged => Self::SUCCESS,
            Ending::NotConverged => Self::from(3),
            Ending::NoAnswer => Self::from(4),
            // 128 + SIGINT, as shells have it.
            Ending::Interrupted => Self::from(130),
        }
    }
}
