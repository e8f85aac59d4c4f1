//! The command `fredholm`: integral equations, and the light in a building as one of them.

mod args;
mod domain;
mod frames;
mod memory;
mod output;
mod outputs;
mod picture;
mod progress;
mod quadrature;
mod radiosity;
mod report;
mod settings;
mod table;
mod terminal;
mod timing;

use crate::args::{Cli, Command};
use crate::radiosity::Ending;
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let ended = match Cli::parse().command {
        Command::Radiosity(args) => radiosity::command(&args),
        Command::Quadrature(args) => quadrature::command(&args),
    };
    match ended {
        Ok(Ending::Converged) => ExitCode::SUCCESS,
        Ok(Ending::NotConverged) => ExitCode::from(3),
        Err(error) => {
            // Nobody is left to be told when this fails too.
            let _ = terminal::complain(&error);
            ExitCode::FAILURE
        }
    }
}
