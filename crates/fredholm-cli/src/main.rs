//! The command `fredholm`: integral equations, and the light in a building as one of them.

mod args;
mod ending;
mod json;
mod output;
mod quadrature;
mod radiosity;
mod terminal;

use crate::args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let ended = match Cli::parse().command {
        Command::Radiosity(args) => radiosity::command(&args),
        Command::Quadrature(args) => quadrature::command(&args),
    };
    ended.map_or_else(
        |error| {
            // Nobody is left to be told when this fails too.
            let _ = terminal::complain(&error);
            ExitCode::FAILURE
        },
        ExitCode::from,
    )
}
