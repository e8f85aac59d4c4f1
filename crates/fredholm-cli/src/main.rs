//! The command `fredholm`: integral equations, and the light in a building as one of them.

mod args;
mod bake;
mod compare;
mod ending;
mod json;
mod output;
mod outputs;
mod plot;
mod problem;
mod quadrature;
mod radiosity;
mod solve;
mod spectrum;
mod terminal;
mod text;
mod view;
mod viewfactors;

use crate::args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let ended = match Cli::parse().command {
        Command::Solve(args) => solve::command(&args),
        Command::Compare(args) => compare::command(&args),
        Command::Spectrum(args) => spectrum::command(&args),
        Command::Radiosity(args) => radiosity::command(&args),
        Command::Bake(args) => bake::command(&args),
        Command::View(args) => view::command(&args),
        Command::Viewfactors(args) => viewfactors::command(&args),
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
