//! The kernel's class by its name.

use crate::problem::{Said, constant};
use fredholm::equation::Class;
use std::str::FromStr;

/// A class as it is typed: `smooth`, `algebraic:-1/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassName(pub Class);

impl FromStr for ClassName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self(match text {
            "smooth" => Class::Smooth,
            "periodic" => Class::Periodic,
            "peaked" => Class::Peaked,
            "kink" => Class::Kink,
            "jump" => Class::Jump,
            "logarithmic" | "log" => Class::Logarithmic,
            _ => Class::Algebraic { exponent: exponent(text)? },
        }))
    }
}

fn exponent(text: &str) -> Result<f64, String> {
    let Some(exponent) = text.strip_prefix("algebraic:") else {
        return Err(
            "write smooth, periodic, peaked, kink, jump, logarithmic or algebraic:EXPONENT".to_owned()
        );
    };
    let value = constant(&Said { text: exponent.to_owned(), place: "the exponent".to_owned() }, &[]);
    match value.map_err(|error| error.to_string())? {
        value if value > -1.0 && value.is_finite() && value.fract() != 0.0 => Ok(value),
        _ => Err("the exponent is above -1, and no whole number".to_owned()),
    }
}

/// The name of a class, as it is typed.
pub fn name(class: Class) -> String {
    match class {
        Class::Smooth => "smooth".to_owned(),
        Class::Periodic => "periodic".to_owned(),
        Class::Peaked => "peaked".to_owned(),
        Class::Kink => "kink".to_owned(),
        Class::Jump => "jump".to_owned(),
        Class::Logarithmic => "logarithmic".to_owned(),
        Class::Algebraic { exponent } => {
            // One that is found is known to six digits, of which nobody needs all.
            format!("algebraic:{}", (1e4 * exponent).round() / 1e4)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_class_has_a_name() {
        for text in ["smooth", "periodic", "peaked", "kink", "jump", "logarithmic", "algebraic:-0.5"] {
            assert_eq!(text.parse().map(|ClassName(class)| name(class)), Ok(text.to_owned()));
        }
        assert_eq!("algebraic:1/2".parse(), Ok(ClassName(Class::Algebraic { exponent: 0.5 })));
        for bad in ["", "soft", "algebraic", "algebraic:-1", "algebraic:2", "algebraic:x"] {
            assert!(bad.parse::<ClassName>().is_err(), "{bad}");
        }
    }
}
