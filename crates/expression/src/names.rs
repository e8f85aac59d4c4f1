//! The names that a formula may use, and the nearest to one that it may not.

use crate::difference::Difference;
use crate::functions::{constant, function, functions};

/// Variables and parameters, as the caller names them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Names<'a> {
    pub variables: &'a [&'a str],
    pub parameters: &'a [(String, f64)],
    pub difference: Option<Difference>,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Named {
    Variable(usize),
    Number(f64),
    /// √−1.
    Imaginary,
    /// A variable and a parameter.
    Both,
    Nothing,
}

impl Names<'_> {
    /// Variables and parameters come before constants: a caller may have an `e` of his own.
    pub fn find(&self, name: &str) -> Named {
        let variable = self.variables.iter().position(|variable| *variable == name);
        let parameter = self.parameters.iter().find(|(parameter, _)| parameter == name);
        match (variable, parameter) {
            (Some(_), Some(_)) => Named::Both,
            (Some(column), None) => Named::Variable(column),
            (None, Some((_, value))) => Named::Number(*value),
            (None, None) if name == "i" => Named::Imaginary,
            (None, None) => constant(name).map_or(Named::Nothing, Named::Number),
        }
    }

    /// The known name nearest to `name`.
    pub fn nearest(&self, name: &str) -> Option<String> {
        let known = self.values().map(str::to_string);
        nearest(name, known.collect::<Vec<_>>().iter().map(String::as_str))
    }

    /// The names of values, for a message.
    pub fn listed(&self) -> String {
        self.values().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
    }

    fn values(&self) -> impl Iterator<Item = &str> {
        let constants = ["pi", "e", "i"];
        let given =
            self.variables.iter().copied().chain(self.parameters.iter().map(|(name, _)| name.as_str()));
        given.chain(constants)
    }
}

/// What other languages call it.
const SYNONYMS: [(&str, &str); 16] = [
    ("arcsin", "asin"),
    ("arccos", "acos"),
    ("arctan", "atan"),
    ("arctan2", "atan2"),
    ("arcsinh", "asinh"),
    ("arccosh", "acosh"),
    ("arctanh", "atanh"),
    ("tg", "tan"),
    ("fabs", "abs"),
    ("sgn", "sign"),
    ("pow", "x^y"),
    ("where", "if"),
    ("polylog", "li2"),
    ("dilog", "li2"),
    ("gammaln", "lgamma"),
    ("rem", "mod"),
];

/// The function nearest to `name`.
pub(crate) fn nearest_function(name: &str) -> Option<String> {
    let lower = name.to_lowercase();
    if let Some((_, ours)) = SYNONYMS.iter().find(|(theirs, _)| *theirs == lower) {
        return Some((*ours).to_string());
    }
    if let Some(function) = function(&lower) {
        return Some(function.name().to_string());
    }
    nearest(name, functions().iter().filter_map(|(signature, _)| signature.split('(').next()))
}

/// The nearest of `known`: at most a third of the letters may be wrong, and one always.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let allowed = (name.chars().count() / 3).max(1);
    let lower = name.to_lowercase();
    known
        .map(|known| (strsim::damerau_levenshtein(&lower, &known.to_lowercase()), known))
        // one letter of one is nothing in common
        .filter(|(distance, known)| *distance <= allowed && *distance < known.chars().count().max(1))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, known)| known.to_string())
}
