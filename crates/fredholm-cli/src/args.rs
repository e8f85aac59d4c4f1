//! What may be said on the command line.

use crate::bake::args::{Bake, EXAMPLES as BAKE_EXAMPLES};
use crate::compare::args::{Compare, EXAMPLES as COMPARE_EXAMPLES};
use crate::problem::args::FORMULAS;
use crate::radiosity::args::{EXAMPLES as RADIOSITY_EXAMPLES, Radiosity};
use crate::solve::args::{EXAMPLES as SOLVE_EXAMPLES, Solve};
use crate::spectrum::args::{EXAMPLES as SPECTRUM_EXAMPLES, Spectrum};
use crate::view::args::{EXAMPLES as VIEW_EXAMPLES, View};
use crate::viewfactors::args::{EXAMPLES as VIEW_FACTORS_EXAMPLES, ViewFactors};
use clap::{Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Fredholm integral equations of the second kind, φ = f + ρ ∫ K φ: solved, with the error of the answer.
#[derive(Debug, Parser)]
#[command(name = "fredholm", version, max_term_width = 100)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The equations.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve φ = f + ∫ K φ on an interval or in the plane, with the error
    #[command(after_help = format!("{FORMULAS}\n\n{SOLVE_EXAMPLES}"), allow_negative_numbers = true)]
    Solve(Box<Solve>),
    /// Compare all methods on one equation, over growing n
    #[command(after_help = format!("{FORMULAS}\n\n{COMPARE_EXAMPLES}"), allow_negative_numbers = true)]
    Compare(Box<Compare>),
    /// Find eigenvalues and eigenfunctions, ∫ K φ = λ φ
    #[command(after_help = format!("{FORMULAS}\n\n{SPECTRUM_EXAMPLES}"), allow_negative_numbers = true)]
    Spectrum(Box<Spectrum>),
    /// Solve the diffuse light of a scene, B = E + ρ ∫ K B, and draw it
    #[command(after_help = RADIOSITY_EXAMPLES, allow_negative_numbers = true)]
    Radiosity(Box<Radiosity>),
    /// Bake the light of a scene into a binary glTF, to an accuracy
    #[command(after_help = BAKE_EXAMPLES)]
    Bake(Box<Bake>),
    /// Watch the light of a scene converge, in a browser
    #[command(after_help = VIEW_EXAMPLES)]
    View(Box<View>),
    /// Compute the view factors between the faces of a mesh, each with its error
    #[command(after_help = VIEW_FACTORS_EXAMPLES, allow_negative_numbers = true)]
    Viewfactors(Box<ViewFactors>),
    /// Print a quadrature rule, its order and its error constant; or integrate a formula
    #[command(after_help = crate::quadrature::args::EXAMPLES)]
    Quadrature(Box<crate::quadrature::args::Quadrature>),
}

/// The name of a choice, as it is typed.
pub fn name(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// A part of the whole, as a percentage.
pub fn percent(text: &str) -> Result<f64, String> {
    radiosity::scene::percent(text)
        .ok_or_else(|| "write a percentage such as 1%, above 0 and below 100".to_owned())
}

/// A positive finite number.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "give a positive finite number".to_owned())
}

/// A whole number, 1 or more.
pub fn at_least_one(text: &str) -> Result<usize, String> {
    number(1, usize::MAX)(text)
}

/// A whole number from `least` to `most`.
pub fn number(least: usize, most: usize) -> impl Fn(&str) -> Result<usize, String> + Clone {
    move |text| {
        let range = if most == usize::MAX { "1 or more".to_owned() } else { format!("{least} to {most}") };
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| format!("give a whole number, {range}"))
    }
}

/// A path whose name has one of these extensions.
pub fn with_extension(text: &str, allowed: &[&str]) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is = |extension: &&&str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension));
    match allowed.iter().find(is) {
        Some(_) => Ok(path),
        None => Err(format!("the name must end in .{}", allowed.join(" or ."))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn numbers_that_mean_nothing_are_refused() {
        assert_eq!(positive("1e-3"), Ok(1e-3));
        for bad in ["0", "-1", "nan", "inf", "1e999", "x"] {
            assert!(positive(bad).is_err(), "{bad}");
        }
        assert!(at_least_one("0").is_err() && number(1, 8)("9").is_err());
    }
}
